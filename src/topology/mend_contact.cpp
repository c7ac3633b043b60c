// SPDX-License-Identifier: GPL-3.0-or-later
#include "remesh_state.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace meniscus {
namespace {

/// How well the faces about a vertex of the wetted area lie on the solid.
struct Lie {
  double turned = 0;  ///< twice the area of the faces that do not face the solid, cm^2
  double least = 1;   ///< least facing_solid

  bool is_better_than(const Lie& other) const {
    constexpr double clearly = 0.02;
    return turned < 0.5 * other.turned || (turned <= other.turned && least > other.least + clearly);
  }
};

/// Of the faces about v, those at `other` left out (they go when v joins it; none if null), with v at x.
Lie lie_with_vertex_at(const RemeshState& state, VertexIndex v, VertexIndex other, const Eigen::Vector3d& x) {
  const Ring r = state.ring(v);
  const Eigen::Vector3d n = state.contact_normal(v);
  Lie lie;
  for (int k = 0; k < r.degree; ++k) {
    const VertexIndex p(r.neighbour[k]), q(r.neighbour[k + 1 == r.degree ? 0 : k + 1]);
    if (p == other || q == other) continue;
    const Eigen::Vector3d u = state.point(p) - x, w = state.point(q) - x;
    const double twice_area = -u.cross(w).dot(n);
    const double longest2 = std::max({u.squaredNorm(), w.squaredNorm(), (w - u).squaredNorm()});
    lie.turned += std::max(0.0, -twice_area);
    lie.least = std::min(lie.least, longest2 > 0 ? 0.5 * twice_area / longest2 : -1);
  }
  return lie;
}

bool has_wet_face(const RemeshState& state, VertexIndex v) {
  for (const auto h : CGAL::halfedges_around_target(state.mesh.halfedge(v), state.mesh))
    if (state.is_wet_face(h)) return true;
  return false;
}

/// Faces about v meet each other or others as it is: then no operation can be asked to keep them apart.
bool meets_already(const RemeshState& state, VertexIndex v) { return state.star_would_meet(v, state.point(v)); }

/// A wetted vertex that was overtaken joins the neighbour that leaves the faces lying best, one of
/// the contact line if all else is equal.
bool join_a_neighbour(RemeshState& state, VertexIndex v, const Lie& now) {
  std::optional<HalfedgeIndex> best;
  Lie best_lie = now;
  for (const bool is_line : {true, false})
    for (const auto h : CGAL::halfedges_around_target(state.mesh.halfedge(v), state.mesh)) {
      const auto target = state.mesh.source(h);
      if (state.on_line(target) != is_line) continue;
      const Lie lie = lie_with_vertex_at(state, v, target, state.point(target));
      if (!lie.is_better_than(best_lie) || !is_collapse_ok(state, h)) continue;
      if (state.collapse_would_meet(target, v, state.point(target)) && !meets_already(state, v)) continue;
      best = h;
      best_lie = lie;
    }
  if (!best) return false;
  const auto target = state.mesh.source(*best);
  collapse_to(state, *best, state.point(target), 0);
  return true;
}

void mark_moved(RemeshState& state, VertexIndex v) {
  const Ring r = state.ring(v);
  state.scratch.changed.push_back(v);
  for (int k = 0; k < r.degree; ++k) state.scratch.changed.emplace_back(r.neighbour[k]);
  state.queue_ring(v);
  if (state.scratch.guard)
    for (int k = 0; k < r.degree; ++k) state.scratch.guard->add(r.corner[k] / 3);
  ++state.report.lifts;
}

/// Along the solid to the middle of its ring.
bool move_to_middle(RemeshState& state, VertexIndex v, const Lie& now) {
  const Ring r = state.ring(v);
  const Eigen::Vector3d x = state.point(v), n = state.contact_normal(v);
  Eigen::Vector3d step = Eigen::Vector3d::Zero();
  for (int k = 0; k < r.degree; ++k) step += (state.point(VertexIndex(r.neighbour[k])) - x) / r.degree;
  step -= step.dot(n) * n;
  if (!lie_with_vertex_at(state, v, Mesh::null_vertex(), x + step).is_better_than(now)) return false;
  if (state.star_would_meet(v, x + step) && !meets_already(state, v)) return false;
  state.mesh.point(v) = to_point(x + step);
  mark_moved(state, v);
  return true;
}

bool unfold_at(RemeshState& state, VertexIndex v) {
  if (!state.colliding(v) || state.on_line(v) || !has_wet_face(state, v) || state.is_forbidden(state.point(v)))
    return false;
  const Lie now = lie_with_vertex_at(state, v, Mesh::null_vertex(), state.point(v));
  return join_a_neighbour(state, v, now) || move_to_middle(state, v, now);
}

bool lift_off(RemeshState& state, VertexIndex v) {
  const double height = lift_in_edges * state.options.band.edge_min;
  const Eigen::Vector3d x = state.point(v) + height * state.contact_normal(v);
  if (state.star_would_meet(v, x)) return false;
  state.mesh.point(v) = to_point(x);
  state.drop.contact()[v] = Contact::free;
  state.drop.contact_solid()[v] = -1;
  const Ring r = state.ring(v);
  for (int k = 0; k < r.degree; ++k) state.update_contact(VertexIndex(r.neighbour[k]));
  mark_moved(state, v);
  return true;
}

/// The film's longest edge with air on both sides; null if there is none.
HalfedgeIndex inner_edge(const RemeshState& state, HalfedgeIndex film) {
  HalfedgeIndex longest = Mesh::null_halfedge();
  double longest2 = 0;
  for (const auto h : CGAL::halfedges_around_face(film, state.mesh)) {
    if (state.is_wet_face(state.mesh.opposite(h))) continue;
    const double length2 = (state.point(state.mesh.target(h)) - state.point(state.mesh.source(h))).squaredNorm();
    if (length2 > longest2) {
      longest2 = length2;
      longest = h;
    }
  }
  return longest;
}

/// An air face flat on the wetted area: a vertex without a wet face is no part of the contact line
/// and leaves the solid; else an inner edge gets a vertex above the solid.
bool lift_film(RemeshState& state, HalfedgeIndex film) {
  for (const auto v : CGAL::vertices_around_face(film, state.mesh))
    if (!has_wet_face(state, v)) return lift_off(state, v);
  const auto h = inner_edge(state, film);
  if (h == Mesh::null_halfedge()) return false;
  const auto a = state.mesh.source(h), b = state.mesh.target(h);
  const Eigen::Vector3d n = (state.contact_normal(a) + state.contact_normal(b)).stableNormalized();
  const Eigen::Vector3d middle = 0.5 * (state.point(a) + state.point(b));
  const Eigen::Vector3d lifted = middle + lift_in_edges * state.options.band.edge_min * n;
  if (state.is_forbidden(middle) || state.split_would_meet(h, lifted)) return false;
  split_at(state, h, lifted, Contact::free);
  return true;
}

bool unfold(RemeshState& state, HalfedgeIndex h) {
  for (const auto v : {state.mesh.source(h), state.mesh.target(h), state.apex(h)})
    if (unfold_at(state, v)) return true;
  return false;
}

/// Calls mend(halfedge) for each face of three colliding vertices that faces the solid by less than `bound`.
template <class Mend>
bool for_each_turned_face(RemeshState& state, double bound, Mend mend) {
  bool mended = false;
  const auto faces = static_cast<std::uint32_t>(state.mesh.num_faces());  // those that are made wait
  for (std::uint32_t f = 0; f < faces; ++f) {
    if (state.mesh.is_removed(FaceIndex(f))) continue;
    const auto h = state.mesh.halfedge(FaceIndex(f));
    if (state.is_colliding_face(h) && state.facing_solid(h) < bound) mended |= mend(h);
  }
  return mended;
}

}  // namespace

void mend_contact(RemeshState& state) {
  constexpr int most_rounds = 3;
  constexpr double film = -1e-3;
  // A fold that is taken for a film would tear the wetted area, so folds go first.
  for (int round = 0; round < most_rounds; ++round)
    if (!for_each_turned_face(state, hardly_facing, [&](HalfedgeIndex h) { return unfold(state, h); })) break;
  for (int round = 0; round < most_rounds; ++round)
    if (!for_each_turned_face(state, film, [&](HalfedgeIndex h) { return lift_film(state, h); })) break;
}

}  // namespace meniscus
