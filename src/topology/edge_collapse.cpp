// SPDX-License-Identifier: GPL-3.0-or-later
#include "remesh_state.h"

#include <CGAL/boost/graph/Euler_operations.h>

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

enum class Target { first, second, midpoint, volume_keeping };

struct Choice {
  Refusal refusal = Refusal::none;
  Target target = Target::midpoint;
};

int contact_rank(const RemeshState& state, VertexIndex v) {
  return !state.has_contact ? 0 : static_cast<int>(state.drop.contact()[v]);  // free < wetted < line
}

/// The contact line wins over the wetted area, that over the free surface; along the line, and
/// nowhere else, two of its vertices may become one.
Choice choose_by_contact(const RemeshState& state, HalfedgeIndex h) {
  const int a = contact_rank(state, state.mesh.source(h)), b = contact_rank(state, state.mesh.target(h));
  if (a == 2 && b == 2 && !state.is_contact_line(h)) return {Refusal::contact_line, Target::midpoint};
  if (a == 0 && b == 0) return {Refusal::none, Target::volume_keeping};
  return {Refusal::none, a > b ? Target::first : b > a ? Target::second : Target::midpoint};
}

/// Corners stay, sharp edges collapse along themselves, and win over smooth places.
Choice choose_by_feature(const RemeshState& state, HalfedgeIndex h, const Choice& by_contact) {
  const int a = state.feature_rank(state.mesh.source(h)), b = state.feature_rank(state.mesh.target(h));
  if (a == 0 && b == 0) return by_contact;
  if ((a == 2 && b == 2) || (a > 0 && b > 0 && !state.is_feature(h))) return {Refusal::feature, Target::midpoint};
  const Target target = a > b ? Target::first : b > a ? Target::second : Target::midpoint;
  const bool agrees = by_contact.target == Target::volume_keeping || by_contact.target == target;
  return {agrees ? Refusal::none : Refusal::feature, target};
}

/// The common neighbours of the ends are just the apexes of the edge's faces (link condition).
bool has_other_common_neighbour(const RemeshState& state, VertexIndex a, VertexIndex b) {
  const Ring r = state.ring(a), s = state.ring(b);
  int common = 0;
  for (int k = 0; k < r.degree; ++k)
    common += static_cast<int>(std::count(s.neighbour, s.neighbour + s.degree, r.neighbour[k]));
  return common != 2;
}

Refusal would_break_valence(const RemeshState& state, HalfedgeIndex h) {
  const auto degree = [&](VertexIndex v) { return state.connectivity.degree(v); };
  const int merged = degree(state.mesh.source(h)) + degree(state.mesh.target(h)) - 4;
  const int apex_least = std::min(degree(state.apex(h)), degree(state.apex(state.mesh.opposite(h)))) - 1;
  const bool is_bad = merged < 3 || merged > state.scratch.max_valence || apex_least < 3;
  return is_bad ? Refusal::valence : Refusal::none;
}

/// Calls visit(x, p, q, p's index) for the faces (x, p, q) about v but not about `other`.
template <class Visit>
void for_each_kept_face(const RemeshState& state, VertexIndex v, VertexIndex other, Visit visit) {
  const Ring r = state.ring(v);
  for (int k = 0; k < r.degree; ++k) {
    const VertexIndex p(r.neighbour[k]), q(r.neighbour[k + 1 == r.degree ? 0 : k + 1]);
    if (p != other && q != other) visit(p, q);
  }
}

/// The point x = s N, relative to the edge's midpoint, at which the star encloses what the two stars
/// did: with N = sum p x q over the rim, x.N = a.N_a + b.N_b (Lindstrom and Turk 1998, volume
/// preservation), in the direction of N.
Eigen::Vector3d volume_keeping_point(const RemeshState& state, VertexIndex a, VertexIndex b) {
  const Eigen::Vector3d pa = state.point(a), pb = state.point(b), middle = 0.5 * (pa + pb);
  const auto rim = [&](VertexIndex v, VertexIndex other) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for_each_kept_face(state, v, other, [&](VertexIndex p, VertexIndex q) {
      sum += (state.point(p) - middle).cross(state.point(q) - middle);
    });
    return sum;
  };
  const Eigen::Vector3d na = rim(a, b), nb = rim(b, a), n = na + nb;
  const double n2 = n.squaredNorm();
  if (!(n2 > 0)) return middle;
  const Eigen::Vector3d offset = n * ((pa - middle).dot(na - nb) / n2);
  // A smooth surface asks for a small part of the edge; a tip may ask for so much that it would grow a spike.
  const double norm = offset.norm(), most = 0.1 * (pb - pa).norm();
  return norm <= most ? Eigen::Vector3d(middle + offset) : Eigen::Vector3d(middle + offset * (most / norm));
}

/// Unit normal of the faces at v that are not flat on a solid: there the air surface looks to.
Eigen::Vector3d air_normal(const RemeshState& state, VertexIndex v) {
  if (!state.colliding(v)) return state.normal(v);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto h : CGAL::halfedges_around_target(state.mesh.halfedge(v), state.mesh))
    if (!state.is_colliding_face(h)) sum += state.area_vector(h);
  return sum.stableNormalized();
}

/// A face of three colliding vertices that does not face the solid: a film of no thickness, or one
/// turned over in the wetted area.
bool would_not_face_solid(const Eigen::Vector3d& n_new, const Eigen::Vector3d& solid_normal) {
  return !(n_new.dot(solid_normal) < 0);
}

/// Checks every face about v that stays, with v at x. A face that is folded over already (it looks
/// away from the vertex normal, or from the solid that it lies on) is to unfold: it is held against that.
Refusal would_harm_star(const RemeshState& state, VertexIndex v, VertexIndex other, const Eigen::Vector3d& x,
                        bool becomes_colliding, std::vector<Eigen::Vector3d>& normals) {
  constexpr double thin = 0.05;       // twice the area over the longest side squared: 0.87 for an equilateral triangle
  constexpr double no_thinner = 0.9;  // of what a thin face had: points that all but coincide must become one
  const double bound = std::cos(state.options.max_normal_turn);
  const Eigen::Vector3d x_old = state.point(v), outward = air_normal(state, v);
  Eigen::Vector3d solid_normal = Eigen::Vector3d::Zero();
  if (becomes_colliding) solid_normal = state.contact_normal(state.colliding(v) ? v : other);
  Refusal refusal = Refusal::none;
  for_each_kept_face(state, v, other, [&](VertexIndex vp, VertexIndex vq) {
    if (refusal != Refusal::none) return;
    const Eigen::Vector3d p = state.point(vp), q = state.point(vq);
    const Eigen::Vector3d n_old = (p - x_old).cross(q - x_old), n_new = (p - x).cross(q - x);
    const double old_norm = n_old.norm(), new_norm = n_new.norm(), rim2 = (q - p).squaredNorm();
    const bool becomes_flat = becomes_colliding && state.colliding(vp) && state.colliding(vq);
    const Eigen::Vector3d face_normal =
        becomes_flat ? Eigen::Vector3d(solid_normal + state.contact_normal(vp) + state.contact_normal(vq)) : outward;
    const Eigen::Vector3d normal = becomes_flat && state.colliding(v) ? Eigen::Vector3d(-face_normal) : outward;
    const double xp2 = (p - x).squaredNorm(),
                 old_longest2 = std::max({rim2, (p - x_old).squaredNorm(), (q - x_old).squaredNorm()});
    const double new_longest2 = std::max({rim2, xp2, (q - x).squaredNorm()});
    const bool was_folded = n_old.dot(normal) < 0, was_thin = was_folded || old_norm < thin * old_longest2;
    const double turn = was_folded ? n_new.dot(normal) : n_new.dot(n_old) / old_norm;  // cosine times new_norm
    const double weight = becomes_flat ? state.wetted_weight(x, p, solid_normal, state.contact_normal(vp)) : 1;
    if (becomes_flat && would_not_face_solid(n_new, face_normal))
      refusal = Refusal::contact_line;
    else if (!(turn > bound * new_norm) && !(was_thin && turn >= 0))
      refusal = Refusal::would_invert;
    else if (new_norm < thin * new_longest2 &&
             !(was_thin && new_norm * old_longest2 > no_thinner * old_norm * new_longest2))
      refusal = Refusal::would_be_sliver;
    else if (state.is_long(weight * weight * xp2))
      refusal = Refusal::would_be_long;
    normals.push_back(n_new.normalized());
  });
  return refusal;
}

/// Two of the new faces that share an edge lie nearly on each other, back to back.
bool would_fold(const std::vector<Eigen::Vector3d>& normals) {
  constexpr double folded = -0.97;
  for (std::size_t k = 0; k < normals.size(); ++k)
    if (normals[k].dot(normals[(k + 1) % normals.size()]) < folded) return true;
  return false;
}

Eigen::Vector3d point_of(const RemeshState& state, VertexIndex a, VertexIndex b, Target target) {
  switch (target) {
    case Target::first:
      return state.point(a);
    case Target::second:
      return state.point(b);
    case Target::midpoint:
      return 0.5 * (state.point(a) + state.point(b));
    default:
      return volume_keeping_point(state, a, b);
  }
}

Refusal would_harm(const RemeshState& state, HalfedgeIndex h, Target target) {
  const auto a = state.mesh.source(h), b = state.mesh.target(h);
  const Eigen::Vector3d x = point_of(state, a, b, target);
  if (!state.scratch.forbidden.empty() && state.is_forbidden(x)) return Refusal::near_intersection;
  const bool becomes_colliding = state.colliding(a) || state.colliding(b);
  auto& normals = state.scratch.ring;
  normals.clear();
  auto refusal = would_harm_star(state, a, b, x, becomes_colliding, normals);
  if (refusal == Refusal::none) refusal = would_harm_star(state, b, a, x, becomes_colliding, normals);
  if (refusal == Refusal::none && would_fold(normals)) refusal = Refusal::would_invert;
  if (refusal == Refusal::none && state.collapse_would_meet(a, b, x)) refusal = Refusal::near_intersection;
  return refusal;
}

}  // namespace

Refusal try_collapse(RemeshState& state, HalfedgeIndex h) {
  Mesh& mesh = state.mesh;
  if (!state.is_short(state.squared_length(h))) return Refusal::not_wanted;
  const auto a = mesh.source(h), b = mesh.target(h);
  const Choice choice = choose_by_feature(state, h, choose_by_contact(state, h));
  if (choice.refusal != Refusal::none) return choice.refusal;
  if (has_other_common_neighbour(state, a, b)) return Refusal::link_condition;
  if (would_break_valence(state, h) != Refusal::none) return Refusal::valence;
  if (state.mesh.number_of_faces() <= state.options.min_faces) return Refusal::not_wanted;
  Target target = choice.target;
  Refusal refusal = would_harm(state, h, target);
  // Where the middle will not do, an end may.
  for (const Target end : {Target::first, Target::second})
    if (refusal != Refusal::none && choice.target == Target::volume_keeping &&
        would_harm(state, h, end) == Refusal::none) {
      target = end;
      refusal = Refusal::none;
    }
  if (refusal != Refusal::none) return refusal;
  if (!CGAL::Euler::does_satisfy_link_condition(mesh.edge(h), mesh)) return Refusal::link_condition;
  const double t = target == Target::first ? 0 : target == Target::second ? 1 : 0.5;
  collapse_to(state, h, point_of(state, a, b, target), t);
  return Refusal::none;
}

bool is_collapse_ok(const RemeshState& state, HalfedgeIndex h) {
  const Mesh& mesh = state.mesh;
  return !has_other_common_neighbour(state, mesh.source(h), mesh.target(h)) &&
         would_break_valence(state, h) == Refusal::none && CGAL::Euler::does_satisfy_link_condition(mesh.edge(h), mesh);
}

void collapse_to(RemeshState& state, HalfedgeIndex h, const Eigen::Vector3d& x, double t) {
  Mesh& mesh = state.mesh;
  const auto a = mesh.source(h), b = mesh.target(h);
  if (!state.scratch.attributes.is_bound()) state.scratch.attributes.bind(mesh);
  auto& around = state.scratch.around;
  around.clear();
  for (const auto v : {a, b}) {
    const Ring r = state.ring(v);
    for (int k = 0; k < r.degree; ++k) around.emplace_back(r.neighbour[k]);
  }
  std::sort(around.begin(), around.end());
  around.erase(std::unique(around.begin(), around.end()), around.end());
  const FaceIndex left = mesh.face(h), right = mesh.face(mesh.opposite(h));

  const bool becomes_colliding = state.colliding(a) || state.colliding(b);
  const auto kept = CGAL::Euler::collapse_edge(mesh.edge(h), mesh);
  mesh.point(kept) = to_point(x);
  state.scratch.attributes.interpolate(kept, a, b, t);
  if (becomes_colliding) state.drop.contact_normals().col(kept).stableNormalize();
  state.connectivity.remove_face(left);
  state.connectivity.remove_face(right);
  for (const auto v : around) state.update(v);
  if (state.has_contact)
    for (const auto v : around)
      if (!mesh.is_removed(v)) state.update_contact(v);
  state.queue_ring(kept);
  ++state.report.collapses;
}

}  // namespace meniscus
