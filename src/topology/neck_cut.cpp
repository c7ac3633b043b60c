// SPDX-License-Identifier: GPL-3.0-or-later
#include "cut_cycle.h"
#include "merge_parts.h"
#include "remesh_state.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace meniscus {
namespace {

// How far each side's copy moves, in lengths of the cycle's shortest edge. With 0.1, 15 of 1,000 random
// runs met themselves after later collapses; with 0.25 none did.
constexpr double apart = 0.25;
constexpr double sharpest_cap = -0.8;  // cosine between a cap's normal and a face beside it

/// The cycle a -> b -> e on the halfedge a -> b.
std::array<HalfedgeIndex, 3> three_cycle(const RemeshState& state, HalfedgeIndex h, VertexIndex e) {
  const auto& mesh = state.mesh;
  return {h, mesh.halfedge(mesh.target(h), e), mesh.halfedge(e, mesh.source(h))};
}

/// A cap beside a face that it nearly lies on would enclose nothing: a fold in a sheet, not a neck.
bool would_fold_cap(const RemeshState& state, const std::vector<HalfedgeIndex>& cycle) {
  const Eigen::Vector3d a = state.point(state.mesh.source(cycle[0])), b = state.point(state.mesh.source(cycle[1])),
                        c = state.point(state.mesh.source(cycle[2]));
  const Eigen::Vector3d right_cap = (b - a).cross(c - a).normalized();  // the right side's cap runs a, b, c
  for (const auto h : cycle) {
    if (state.area_vector(h).normalized().dot(-right_cap) < sharpest_cap) return true;
    if (state.area_vector(state.mesh.opposite(h)).normalized().dot(right_cap) < sharpest_cap) return true;
  }
  return false;
}

bool is_flat(const RemeshState& state, const std::vector<HalfedgeIndex>& cycle) {
  double longest2 = 0;
  for (const auto h : cycle)
    longest2 =
        std::max(longest2, (state.point(state.mesh.target(h)) - state.point(state.mesh.source(h))).squaredNorm());
  const Eigen::Vector3d a = state.point(state.mesh.source(cycle[0]));
  const Eigen::Vector3d n =
      (state.point(state.mesh.source(cycle[1])) - a).cross(state.point(state.mesh.source(cycle[2])) - a);
  return !(n.norm() > 0.05 * longest2);
}

/// Where a vertex of a cap goes: toward the mean of its ring, the cap's own vertices left out.
Eigen::Vector3d step_to_own_side(const RemeshState& state, VertexIndex v, const std::array<VertexIndex, 3>& cap,
                                 double length) {
  const Ring r = state.ring(v);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  int count = 0;
  for (int k = 0; k < r.degree; ++k) {
    const VertexIndex w(r.neighbour[k]);
    if (std::find(cap.begin(), cap.end(), w) != cap.end()) continue;
    mean += state.point(w);
    ++count;
  }
  if (count == 0) return Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = mean / count - state.point(v);
  if (state.colliding(v)) {  // colliding vertices stay on their solid
    const Eigen::Vector3d n = state.drop.contact_normals().col(v);
    direction -= direction.dot(n) * n;
  }
  const double norm = direction.norm();
  return norm > 0 ? Eigen::Vector3d(direction * (std::min(length, 0.5 * norm) / norm))
                  : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

/// At most this many faces on one side of a cycle are a spike.
constexpr std::size_t most_spike_faces = 16;

/// Whether a cycle is no neck between two bodies of liquid but goes around a tunnel of air, or cuts off a spike.
bool is_tunnel_or_spike(const Mesh& mesh, const std::array<HalfedgeIndex, 3>& cycle) {
  const auto is_on_cycle = [&](HalfedgeIndex h) {
    return std::any_of(cycle.begin(), cycle.end(), [&](HalfedgeIndex c) { return c == h || mesh.opposite(c) == h; });
  };
  std::vector<bool> is_seen(mesh.num_faces(), false);
  std::vector<FaceIndex> side{mesh.face(cycle[0])};
  is_seen[side[0]] = true;
  for (std::size_t k = 0; k < side.size(); ++k)
    for (const auto h : CGAL::halfedges_around_face(mesh.halfedge(side[k]), mesh)) {
      const auto beyond = mesh.face(mesh.opposite(h));
      if (is_on_cycle(h) || is_seen[beyond]) continue;
      is_seen[beyond] = true;
      side.push_back(beyond);
    }
  if (is_seen[mesh.face(mesh.opposite(cycle[0]))]) return true;
  return std::min(side.size(), mesh.number_of_faces() - side.size()) <= most_spike_faces;
}

/// Near a seam, faces about the vertices of a cap that would meet another sheet if these moved so: they stay.
void stay_if_sheets_meet(RemeshState& state, const std::array<VertexIndex, 3>& cap,
                         const std::array<VertexIndex, 3>& other, Eigen::Vector3d* steps) {
  if (!state.scratch.guard) return;
  auto& faces = state.scratch.new_faces;
  faces.clear();
  const auto moved = [&](std::uint32_t v) {
    const auto at = std::find(cap.begin(), cap.end(), VertexIndex(v));
    const Eigen::Vector3d x = state.point(VertexIndex(v));
    return at == cap.end() ? x : Eigen::Vector3d(x + steps[at - cap.begin()]);
  };
  std::vector<std::uint32_t> around;
  for (const auto v : cap) {
    const Ring r = state.ring(v);
    for (int k = 0; k < r.degree; ++k) around.push_back(r.corner[k] / 3);
  }
  std::sort(around.begin(), around.end());
  around.erase(std::unique(around.begin(), around.end()), around.end());
  for (const auto f : around) {
    const auto& t = state.connectivity.triangles()[f];
    faces.push_back({t, {moved(t[0]), moved(t[1]), moved(t[2])}});
  }
  if (state.would_meet_sheet({cap[0], cap[1], cap[2], other[0], other[1], other[2]}, {}))
    std::fill(steps, steps + 3, Eigen::Vector3d::Zero());
}

void cut(RemeshState& state, const std::vector<HalfedgeIndex>& cycle) {
  Mesh& mesh = state.mesh;
  if (!state.scratch.attributes.is_bound()) state.scratch.attributes.bind(mesh);
  std::array<VertexIndex, 3> left, right;
  double shortest2 = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    left[i] = mesh.source(cycle[i]);
    shortest2 = std::min(shortest2, (state.point(mesh.target(cycle[i])) - state.point(left[i])).squaredNorm());
  }
  const auto made = cut_along_cycle(mesh, cycle);
  std::copy(made.copies.begin(), made.copies.end(), right.begin());
  for (std::size_t i = 0; i < 3; ++i) state.scratch.attributes.copy(right[i], left[i]);
  state.connectivity.grow(mesh);
  for (const auto v : left) state.update(v);
  for (const auto v : right) state.update(v);
  // The rings of the right side's neighbours name the copies now.
  auto& around = state.scratch.around;
  around.clear();
  for (const auto v : right) {
    const Ring r = state.ring(v);
    for (int k = 0; k < r.degree; ++k) around.emplace_back(r.neighbour[k]);
  }
  for (const auto v : around) state.update(v);

  const double length = apart * std::sqrt(shortest2);
  std::array<Eigen::Vector3d, 6> steps;
  for (std::size_t i = 0; i < 3; ++i) {
    steps[i] = step_to_own_side(state, left[i], left, length);
    steps[3 + i] = step_to_own_side(state, right[i], right, length);
  }
  stay_if_sheets_meet(state, left, right, steps.data());
  stay_if_sheets_meet(state, right, left, steps.data() + 3);
  for (std::size_t i = 0; i < 3; ++i) {
    mesh.point(left[i]) = to_point(state.point(left[i]) + steps[i]);
    mesh.point(right[i]) = to_point(state.point(right[i]) + steps[3 + i]);
  }
  for (const auto* side : {&left, &right})
    for (const auto v : *side) {
      state.update_contact(v);
      state.queue_ring(v);
    }
  ++state.report.cuts;
}

}  // namespace

Refusal try_cut(RemeshState& state, HalfedgeIndex h) {
  const Mesh& mesh = state.mesh;
  const auto a = mesh.source(h), b = mesh.target(h);
  if (!state.options.cut_necks || (!state.scratch.forbidden.empty() && state.is_forbidden(state.point(a))))
    return Refusal::link_condition;
  const Ring r = state.ring(a), s = state.ring(b);
  double best = std::numeric_limits<double>::infinity();
  auto& cycle = state.scratch.cycle;
  std::array<HalfedgeIndex, 3> chosen;
  for (int k = 0; k < r.degree; ++k) {
    const VertexIndex e(r.neighbour[k]);
    if (e == state.apex(h) || e == state.apex(mesh.opposite(h))) continue;
    if (std::find(s.neighbour, s.neighbour + s.degree, r.neighbour[k]) == s.neighbour + s.degree) continue;
    if (state.colliding(a) && state.colliding(b) && state.colliding(e)) continue;  // flat on the solid: no neck
    const auto candidate = three_cycle(state, h, e);
    cycle.assign(candidate.begin(), candidate.end());
    const double around = (state.point(e) - state.point(a)).norm() + (state.point(e) - state.point(b)).norm();
    if (around < best && is_cuttable(mesh, cycle) && !is_flat(state, cycle) && !would_fold_cap(state, cycle)) {
      best = around;
      chosen = candidate;
    }
  }
  if (!std::isfinite(best)) return Refusal::link_condition;
  cycle.assign(chosen.begin(), chosen.end());
  const bool is_of_seam = std::any_of(chosen.begin(), chosen.end(), [&](HalfedgeIndex c) {
    return state.drop.seam_watch()[mesh.target(c)] > violent_watched_calls;
  });
  if (is_of_seam && !is_tunnel_or_spike(state.mesh, chosen)) return Refusal::link_condition;  // it is to grow
  cut(state, cycle);
  return Refusal::none;
}

}  // namespace meniscus
