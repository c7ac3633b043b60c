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

/// What a cut will make on one side of a cycle.
struct Side {
  std::array<std::uint32_t, 3> names;    ///< of the cap's vertices
  std::array<Eigen::Vector3d, 3> steps;  ///< how far they move
  std::vector<FaceIndex> faces;          ///< about the cap, sorted
};

/// Where a vertex of a cap goes: toward the mean of its neighbours on its side.
Eigen::Vector3d step_to_own_side(const RemeshState& state, VertexIndex v, const std::vector<VertexIndex>& neighbours,
                                 double length) {
  if (neighbours.empty()) return Eigen::Vector3d::Zero();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto w : neighbours) mean += state.point(w);
  Eigen::Vector3d direction = mean / static_cast<double>(neighbours.size()) - state.point(v);
  if (state.colliding(v)) {  // colliding vertices stay on their solid
    const Eigen::Vector3d n = state.drop.contact_normals().col(v);
    direction -= direction.dot(n) * n;
  }
  const double norm = direction.norm();
  return norm > 0 ? Eigen::Vector3d(direction * (std::min(length, 0.5 * norm) / norm))
                  : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

/// The left side of a cycle.
Side side_of(const RemeshState& state, const std::array<HalfedgeIndex, 3>& cycle, double length) {
  const Mesh& mesh = state.mesh;
  Side side;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto end = mesh.opposite(cycle[i]), in = cycle[(i + 2) % 3];
    std::vector<VertexIndex> neighbours;
    for (auto h = in; h != end; h = mesh.opposite(mesh.next(h))) {
      side.faces.push_back(mesh.face(h));
      if (h != in) neighbours.push_back(mesh.source(h));
    }
    side.names[i] = mesh.source(cycle[i]);
    side.steps[i] = step_to_own_side(state, mesh.source(cycle[i]), neighbours, length);
  }
  std::sort(side.faces.begin(), side.faces.end());
  side.faces.erase(std::unique(side.faces.begin(), side.faces.end()), side.faces.end());
  return side;
}

/// Both sides of a cut: first the left one, which keeps the vertices.
std::array<Side, 2> sides_of(const RemeshState& state, const std::array<HalfedgeIndex, 3>& cycle) {
  const Mesh& mesh = state.mesh;
  double shortest2 = std::numeric_limits<double>::infinity();
  for (const auto h : cycle)
    shortest2 = std::min(shortest2, (state.point(mesh.target(h)) - state.point(mesh.source(h))).squaredNorm());
  const double length = apart * std::sqrt(shortest2);
  const std::array<HalfedgeIndex, 3> backward{mesh.opposite(cycle[2]), mesh.opposite(cycle[1]),
                                              mesh.opposite(cycle[0])};
  Side right = side_of(state, backward, length);  // its corners: 0, 2, 1 of the cycle
  std::swap(right.steps[1], right.steps[2]);
  for (std::uint32_t i = 0; i < 3; ++i) right.names[i] = mesh.num_vertices() + i;
  return {side_of(state, cycle, length), std::move(right)};
}

/// At most this many faces on one side of a cycle are a spike.
constexpr std::size_t most_spike_faces = 16;

/// A cut that would shut in air of more than this share of the drop's volume is none: what is shut in is filled, and
/// the drop would have to give so much of its volume at once.
constexpr double most_shut_in = 0.05;

enum class Cycle { neck, tunnel, spike, mouth };

/// Six times the volume below a face, as seen from a point.
double six_volumes(const RemeshState& state, FaceIndex f, const Eigen::Vector3d& origin) {
  const auto& [a, b, c] = state.connectivity.triangles()[f];
  const auto from_origin = [&](std::uint32_t v) -> Eigen::Vector3d { return state.point(VertexIndex(v)) - origin; };
  return from_origin(a).dot(from_origin(b).cross(from_origin(c)));
}

/// Whether a cycle goes around a neck between two bodies of liquid or a tunnel of air, cuts off a spike, or is the
/// mouth of a hollow.
Cycle kind_of(const RemeshState& state, const std::array<HalfedgeIndex, 3>& cycle) {
  const Mesh& mesh = state.mesh;
  const auto is_on_cycle = [&](HalfedgeIndex h) {
    return std::any_of(cycle.begin(), cycle.end(), [&](HalfedgeIndex c) { return c == h || mesh.opposite(c) == h; });
  };
  const Eigen::Vector3d origin = state.point(mesh.source(cycle[0]));  // on the caps, which then add no volume
  const double volume = 6 * state.drop.volume();
  double volume_of_side = 0;  // both times six
  std::vector<bool> is_seen(mesh.num_faces(), false);
  std::vector<FaceIndex> side{mesh.face(cycle[0])};
  is_seen[side[0]] = true;
  for (std::size_t k = 0; k < side.size(); ++k) {
    volume_of_side += six_volumes(state, side[k], origin);
    for (const auto h : CGAL::halfedges_around_face(mesh.halfedge(side[k]), mesh)) {
      const auto beyond = mesh.face(mesh.opposite(h));
      if (is_on_cycle(h) || is_seen[beyond]) continue;
      is_seen[beyond] = true;
      side.push_back(beyond);
    }
  }
  if (is_seen[mesh.face(mesh.opposite(cycle[0]))]) return Cycle::tunnel;
  if (std::min(volume_of_side, volume - volume_of_side) < -most_shut_in * volume) return Cycle::mouth;
  const std::size_t smaller = std::min(side.size(), mesh.number_of_faces() - side.size());
  return smaller <= most_spike_faces ? Cycle::spike : Cycle::neck;
}

/// Near a seam, what a cut makes would meet itself or another sheet.
bool cut_would_meet(RemeshState& state, const std::array<HalfedgeIndex, 3>& cycle, const std::array<Side, 2>& sides) {
  if (!state.scratch.guard) return false;
  const Mesh& mesh = state.mesh;
  const std::vector<std::uint32_t> corners{mesh.source(cycle[0]), mesh.source(cycle[1]), mesh.source(cycle[2])};
  auto& faces = state.scratch.new_faces;
  faces.clear();
  for (const Side& side : sides) {
    const auto add = [&](const std::vector<std::uint32_t>& vertices) {
      SheetGuard::NewFace face;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto at =
            static_cast<std::size_t>(std::find(corners.begin(), corners.end(), vertices[k]) - corners.begin());
        face.vertices[k] = at == 3 ? vertices[k] : side.names[at];
        face.points[k] = state.point(VertexIndex(vertices[k]));
        if (at < 3) face.points[k] += side.steps[at];
      }
      faces.push_back(face);
    };
    add(corners);
    for (const auto f : side.faces) {
      const auto& [a, b, c] = state.connectivity.triangles()[f];
      add({a, b, c});
    }
  }
  return state.would_meet_sheet(corners, {});
}

/// Shortens the steps of a cut until nothing meets; a spike, which goes away, may also be cut where it is, if its cap
/// meets nothing. False if nothing will do.
bool fit_steps(RemeshState& state, const std::array<HalfedgeIndex, 3>& cycle, Cycle kind, std::array<Side, 2>& sides) {
  if (!cut_would_meet(state, cycle, sides)) return true;
  const auto scale = [&](double factor) {
    for (Side& side : sides)
      for (auto& step : side.steps) step *= factor;
  };
  scale(0.3);
  if (!cut_would_meet(state, cycle, sides)) return true;
  if (kind != Cycle::spike) return false;
  scale(0);
  auto& faces = state.scratch.new_faces;
  faces.resize(1);
  for (std::size_t i = 0; i < 3; ++i) {
    faces[0].vertices[i] = sides[0].names[i];
    faces[0].points[i] = state.point(VertexIndex(sides[0].names[i]));
  }
  return !state.would_meet_sheet({}, {});
}

void cut(RemeshState& state, const std::vector<HalfedgeIndex>& cycle, const std::array<Side, 2>& sides) {
  Mesh& mesh = state.mesh;
  if (!state.scratch.attributes.is_bound()) state.scratch.attributes.bind(mesh);
  std::array<VertexIndex, 3> left, right;
  for (std::size_t i = 0; i < 3; ++i) left[i] = mesh.source(cycle[i]);
  const auto made = cut_along_cycle(mesh, cycle);
  std::copy(made.copies.begin(), made.copies.end(), right.begin());
  for (std::size_t i = 0; i < 3; ++i) state.scratch.attributes.copy(right[i], left[i]);
  for (std::size_t i = 0; i < 3; ++i) {
    mesh.point(left[i]) = to_point(state.point(left[i]) + sides[0].steps[i]);
    mesh.point(right[i]) = to_point(state.point(right[i]) + sides[1].steps[i]);
  }
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

  for (const auto* side : {&left, &right})
    for (const auto v : *side) {
      state.update_contact(v);
      state.queue_ring(v);
    }
  ++state.report.cuts;
}

/// The faces that hang together with one, or none if they are more than `most`.
std::vector<FaceIndex> small_component(const Mesh& mesh, FaceIndex start, std::size_t most) {
  std::vector<FaceIndex> faces{start};
  for (std::size_t k = 0; k < faces.size(); ++k) {
    if (faces.size() > most) return {};
    for (const auto f : CGAL::faces_around_face(mesh.halfedge(faces[k]), mesh))
      if (std::find(faces.begin(), faces.end(), f) == faces.end()) faces.push_back(f);
  }
  return faces;
}

/// A spike that was cut where it is lies against what it was cut from until it is deleted.
void forget_spike(RemeshState& state, const std::array<Side, 2>& sides) {
  if (!state.scratch.guard) return;
  for (const Side& side : sides)
    for (const auto f : small_component(state.mesh, side.faces.front(), most_spike_faces + 1))
      state.scratch.guard->forget(f);
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
  const Cycle kind = kind_of(state, chosen);
  if (kind == Cycle::mouth) return Refusal::link_condition;
  if (is_of_seam && state.scratch.guard && kind == Cycle::neck) return Refusal::link_condition;  // it is to grow
  std::array<Side, 2> sides = sides_of(state, chosen);
  if (!fit_steps(state, chosen, kind, sides)) return Refusal::near_intersection;
  cut(state, cycle, sides);
  if (kind == Cycle::spike) forget_spike(state, sides);
  return Refusal::none;
}

}  // namespace meniscus
