// SPDX-License-Identifier: GPL-3.0-or-later
#include "remesh_state.h"

#include <CGAL/boost/graph/Euler_operations.h>

#include <cmath>

namespace meniscus {
namespace {

bool are_neighbours(const RemeshState& state, VertexIndex a, VertexIndex b) {
  const Ring r = state.ring(a);
  for (int k = 0; k < r.degree; ++k)
    if (r.neighbour[k] == b) return true;
  return false;
}

/// The new edge would join two vertices of the contact line through the air, or bridge wet and air faces.
bool would_disturb_contact_line(const RemeshState& state, HalfedgeIndex h) {
  if (!state.has_contact) return false;
  const Mesh& mesh = state.mesh;
  if (state.is_contact_line(h)) return true;
  const bool is_wet = state.inside_wetted_area(h);
  const auto o = state.apex(h), p = state.apex(mesh.opposite(h));
  if (!is_wet) return state.colliding(o) && state.colliding(p);
  // Both new faces must face the solid, or the edge would no longer lie inside the wetted area.
  const auto faces_solid = [&](VertexIndex v, VertexIndex first, VertexIndex second) {
    const Eigen::Vector3d x = state.point(v);
    const Eigen::Vector3d n = state.contact_normal(v) + state.contact_normal(first) + state.contact_normal(second);
    return (state.point(first) - x).cross(state.point(second) - x).dot(n) < 0;
  };
  return !faces_solid(mesh.source(h), p, o) || !faces_solid(mesh.target(h), o, p);
}

/// The faces are not nearly coplanar, or one of the new ones would point away from them.
bool would_change_shape(const RemeshState& state, HalfedgeIndex h) {
  const Mesh& mesh = state.mesh;
  const Eigen::Vector3d n = state.area_vector(h), m = state.area_vector(mesh.opposite(h));
  const double n_norm = n.norm(), m_norm = m.norm();
  const double coplanar = std::cos(state.options.max_flip_dihedral);
  // A face of next to no area has no direction to keep.
  const double length2 = state.squared_length(h);
  const bool is_thin = std::min(n_norm, m_norm) < 0.05 * length2;
  if (!is_thin && n.dot(m) < coplanar * n_norm * m_norm) return true;
  const Eigen::Vector3d a = state.point(mesh.source(h)), b = state.point(mesh.target(h)),
                        o = state.point(state.apex(h)), p = state.point(state.apex(mesh.opposite(h)));
  const Eigen::Vector3d sum = n + m;
  const Eigen::Vector3d at_a = (p - a).cross(o - a), at_b = (o - b).cross(p - b);
  const auto points_away = [&](const Eigen::Vector3d& n_new) {
    return !(n_new.dot(sum) > coplanar * n_new.norm() * sum.norm()) || n_new.norm() < 1e-3 * (o - p).squaredNorm();
  };
  return points_away(at_a) || points_away(at_b);
}

/// The two faces at the other diagonal meet another sheet.
bool would_meet_sheet(const RemeshState& state, HalfedgeIndex h) {
  if (!state.scratch.guard) return false;
  const Mesh& mesh = state.mesh;
  const auto back = mesh.opposite(h);
  const auto a = mesh.source(h), b = mesh.target(h), o = state.apex(h), p = state.apex(back);
  state.scratch.new_faces = {{{a, p, o}, {state.point(a), state.point(p), state.point(o)}},
                             {{b, o, p}, {state.point(b), state.point(o), state.point(p)}}};
  return state.would_meet_sheet({}, {mesh.face(h), mesh.face(back)});
}

}  // namespace

Refusal try_flip(RemeshState& state, HalfedgeIndex h) {
  Mesh& mesh = state.mesh;
  const auto a = mesh.source(h), b = mesh.target(h), o = state.apex(h), p = state.apex(mesh.opposite(h));
  if (!(cotangent_sum(state, h) < state.options.flip_below)) return Refusal::not_wanted;
  if (o == p || are_neighbours(state, o, p)) return Refusal::link_condition;
  if (state.connectivity.degree(a) < 4 || state.connectivity.degree(b) < 4) return Refusal::valence;
  if (would_disturb_contact_line(state, h)) return Refusal::contact_line;
  if (state.is_feature(h)) return Refusal::feature;
  if (would_change_shape(state, h)) return Refusal::would_invert;
  const double weight =
      state.inside_wetted_area(h)
          ? state.wetted_weight(state.point(o), state.point(p), state.contact_normal(o), state.contact_normal(p))
          : 1;
  const double length2_new = weight * weight * (state.point(o) - state.point(p)).squaredNorm();
  if (state.is_long(length2_new) || state.is_short(length2_new)) return Refusal::would_be_long;
  if (!state.scratch.forbidden.empty() && state.is_forbidden(0.5 * (state.point(a) + state.point(b))))
    return Refusal::near_intersection;
  if (would_meet_sheet(state, h)) return Refusal::near_intersection;

  CGAL::Euler::flip_edge(h, mesh);
  for (const auto v : {a, b, o, p}) state.update(v);
  for (const auto v : {a, b, o, p}) state.update_contact(v);
  // h now runs between o and p; its four neighbours may have become flippable.
  const auto back = mesh.opposite(h);
  for (const auto k : {mesh.next(h), mesh.prev(h), mesh.next(back), mesh.prev(back)}) state.queue_flip(mesh.edge(k));
  ++state.report.flips;
  return Refusal::none;
}

}  // namespace meniscus
