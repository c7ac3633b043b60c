// SPDX-License-Identifier: GPL-3.0-or-later
#include "remesh_state.h"

#include <CGAL/boost/graph/Euler_operations.h>

#include <cmath>

namespace meniscus {
namespace {

constexpr double smooth = 0.766;  // cosine of 40 degrees: between the crease of a box, 45, and an icosahedron, 37

/// The unit normal of the surface's smooth part at a vertex: of the water-air faces on a contact line;
/// zero where there is none, as at an edge or corner.
Eigen::Vector3d smooth_normal(const RemeshState& state, VertexIndex v) {
  const auto none = Eigen::Vector3d::Zero();
  if (state.feature_rank(v) > 0) return none;
  Eigen::Vector3d sum = none;
  const auto around = CGAL::halfedges_around_target(state.mesh.halfedge(v), state.mesh);
  const bool has_wet_faces = state.colliding(v);
  for (const auto h : around)
    if (!has_wet_faces || !state.is_wet_face(h)) sum += state.area_vector(h);
  const double length = sum.norm();
  if (!(length > 0)) return none;
  for (const auto h : around) {
    if (has_wet_faces && state.is_wet_face(h)) continue;
    const Eigen::Vector3d n = state.area_vector(h);
    if (n.dot(sum) < smooth * n.norm() * length) return none;
  }
  return sum / length;
}

/// The midpoint of the cubic that meets both ends at right angles to their normals (as in PN
/// triangles): (a + b)/2 - ((e.n_a) n_a - (e.n_b) n_b)/8 with e = b - a. An end without a normal
/// adds nothing: there the surface leaves straight.
Eigen::Vector3d curved_midpoint(const RemeshState& state, VertexIndex a, VertexIndex b) {
  const Eigen::Vector3d p = state.point(a), q = state.point(b), e = q - p;
  const Eigen::Vector3d na = smooth_normal(state, a), nb = smooth_normal(state, b);
  return 0.5 * (p + q) - (e.dot(na) * na - e.dot(nb) * nb) / 8;
}

/// A free vertex on an edge that touches a solid stays outside of it, and does not lie flat on it.
Eigen::Vector3d off_the_solid(const RemeshState& state, VertexIndex a, VertexIndex b, const Eigen::Vector3d& m) {
  const Eigen::Vector3d middle = 0.5 * (state.point(a) + state.point(b));
  if (state.colliding(a) && state.colliding(b)) {
    const Eigen::Vector3d n = (state.contact_normal(a) + state.contact_normal(b)).stableNormalized();
    const double least = lift_in_edges * state.options.band.edge_min;
    return (m - middle).dot(n) < least ? Eigen::Vector3d(middle + least * n) : m;
  }
  for (const auto v : {a, b})
    if (state.colliding(v) && (m - state.point(v)).dot(state.contact_normal(v)) <= 0) return middle;
  return m;
}

/// Would a new vertex at m turn one of the two halves of the face left of h too far?
bool would_fold_at(const RemeshState& state, HalfedgeIndex h, const Eigen::Vector3d& m) {
  const Eigen::Vector3d a = state.point(state.mesh.source(h)), b = state.point(state.mesh.target(h)),
                        o = state.point(state.apex(h));
  const Eigen::Vector3d n_old = (b - a).cross(o - a);
  const double bound = std::cos(state.options.max_normal_turn);
  const auto turns_too_far = [&](const Eigen::Vector3d& n_new) {
    return !(n_new.dot(n_old) > bound * n_new.norm() * n_old.norm());
  };
  return turns_too_far((m - a).cross(o - a)) || turns_too_far((b - m).cross(o - m));
}

double length2(const RemeshState& state, HalfedgeIndex h) {
  return (state.point(state.mesh.target(h)) - state.point(state.mesh.source(h))).squaredNorm();
}

/// The median from m, the middle of h, in the face left of it is clearly shorter than h, as the band counts lengths.
/// Where all count alike the longest side of a face passes.
bool would_shorten(const RemeshState& state, HalfedgeIndex h, const Eigen::Vector3d& m) {
  constexpr double clearly_shorter = 0.95;
  const double counted2 = state.squared_length(h);
  double weight2 = counted2 / length2(state, h);
  if (state.is_wet_face(h)) {
    const auto a = state.mesh.source(h), b = state.mesh.target(h), o = state.apex(h);
    const Eigen::Vector3d normal = (state.contact_normal(a) + state.contact_normal(b)).stableNormalized();
    const double wetted = state.wetted_weight(m, state.point(o), normal, state.contact_normal(o));
    weight2 = wetted * wetted;
  }
  return weight2 * (state.point(state.apex(h)) - m).squaredNorm() < clearly_shorter * clearly_shorter * counted2;
}

/// A side of the face left of h is longer than h, and is to be split.
bool has_longer_side(const RemeshState& state, HalfedgeIndex h) {
  for (const auto side : {state.mesh.next(h), state.mesh.prev(h)})
    if (length2(state, side) > length2(state, h) && state.is_long(state.squared_length(side))) return true;
  return false;
}

/// The apex of the face left of h lies where the new vertex would.
bool is_taken(const RemeshState& state, HalfedgeIndex h, const Eigen::Vector3d& m) {
  constexpr double apart = 0.05;
  return (state.point(state.apex(h)) - m).squaredNorm() < apart * apart * length2(state, h);
}

/// Whether to split h at m, or to do it in the next round, after a longer side. Weights change with every split: on a
/// fold, where faces have no area, medians as long as the edge would be split in turn, without end.
bool may_split(RemeshState& state, HalfedgeIndex h, const Eigen::Vector3d& m) {
  const auto back = state.mesh.opposite(h);
  if (would_shorten(state, h, m) && would_shorten(state, back, m)) return true;
  if (has_longer_side(state, h) || has_longer_side(state, back)) state.queue(state.mesh.edge(h));
  return false;
}

Contact contact_of_midpoint(const RemeshState& state, HalfedgeIndex h) {
  if (state.inside_wetted_area(h)) return Contact::wetted;
  return state.is_contact_line(h) ? Contact::line : Contact::free;
}

void set_contact(RemeshState& state, VertexIndex v, Contact contact) {
  Drop& drop = state.drop;
  drop.contact()[v] = contact;
  if (is_colliding(contact)) {
    drop.contact_normals().col(v).stableNormalize();
  } else {
    drop.contact_solid()[v] = -1;
  }
}

}  // namespace

Refusal try_split(RemeshState& state, HalfedgeIndex h) {
  Mesh& mesh = state.mesh;
  if (!state.is_long(state.squared_length(h))) return Refusal::not_wanted;
  const auto a = mesh.source(h), b = mesh.target(h);
  const Eigen::Vector3d middle = 0.5 * (state.point(a) + state.point(b));
  if (state.is_forbidden(middle)) return Refusal::near_intersection;
  if (is_taken(state, h, middle) || is_taken(state, mesh.opposite(h), middle)) return Refusal::would_be_sliver;
  if (!may_split(state, h, middle)) return Refusal::not_wanted;

  const Contact contact = contact_of_midpoint(state, h);
  Eigen::Vector3d m = middle;
  if (!is_colliding(contact) && !state.is_feature(h)) {
    m = curved_midpoint(state, a, b);
    if (would_fold_at(state, h, m) || would_fold_at(state, mesh.opposite(h), m)) m = middle;
    m = off_the_solid(state, a, b, m);
    if (m != middle && state.split_would_meet(h, m)) m = middle;
  }
  // On faces folded onto each other without a gap, rounding decides.
  if (m == middle && state.split_would_meet(h, middle)) return Refusal::near_intersection;
  split_at(state, h, m, contact);
  return Refusal::none;
}

VertexIndex split_at(RemeshState& state, HalfedgeIndex h, const Eigen::Vector3d& m, Contact contact) {
  Mesh& mesh = state.mesh;
  const auto a = mesh.source(h), b = mesh.target(h), o = state.apex(h), p = state.apex(mesh.opposite(h));
  if (!state.scratch.attributes.is_bound()) state.scratch.attributes.bind(mesh);
  // The faces left and right become quadrangles by the new vertex, then two triangles each.
  const auto first_half = CGAL::Euler::split_edge(h, mesh);
  const auto v = mesh.target(first_half);
  CGAL::Euler::split_face(first_half, mesh.next(mesh.next(first_half)), mesh);
  const auto back = mesh.opposite(h);
  CGAL::Euler::split_face(back, mesh.next(mesh.next(back)), mesh);
  mesh.point(v) = to_point(m);
  state.scratch.attributes.interpolate(v, a, b, 0.5);
  if (state.has_contact) set_contact(state, v, contact);
  state.connectivity.grow(mesh);
  for (const auto changed : {v, a, b, o, p}) state.update(changed);
  for (const auto near : {a, b, o, p}) state.update_contact(near);
  state.queue_ring(v);
  ++state.report.splits;
  return v;
}

}  // namespace meniscus
