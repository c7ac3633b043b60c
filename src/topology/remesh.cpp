// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/topology/remesh.h"

#include "meniscus/core/chunks.h"
#include "meniscus/core/error.h"
#include "remesh_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

constexpr double poor_angle_tangent = 0.17632698;   // tan(10 degrees)
constexpr double sharp_angle_tangent = 0.57735027;  // tan(30 degrees)

/// The squared sides of a triangle and what follows from them: corner k faces side k.
struct Sides {
  std::array<double, 3> squared;
  double least, greatest, sum;

  Sides(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& r)
      : squared{(r - q).squaredNorm(), (p - r).squaredNorm(), (q - p).squaredNorm()},
        least(std::min({squared[0], squared[1], squared[2]})),
        greatest(std::max({squared[0], squared[1], squared[2]})),
        sum(squared[0] + squared[1] + squared[2]) {}

  bool is_obtuse() const { return sum < 2 * greatest; }
  /// Least angle under 10 degrees.
  bool is_poor() const { return is_least_angle_under(poor_angle_tangent); }
  bool is_sharp() const { return is_least_angle_under(sharp_angle_tangent); }

 private:
  /// tan = 2 A / dot at the corner that faces the least side, and (2 A)^2 = s_0 s_1 - dot^2.
  bool is_least_angle_under(double tangent) const {
    const double dot = 0.5 * (sum - 2 * least), middle = sum - least - greatest;
    return middle * greatest - dot * dot < tangent * tangent * dot * dot;
  }
};

HalfedgeIndex halfedge_from(const Mesh& mesh, FaceIndex f, std::uint32_t source) {
  auto h = mesh.halfedge(f);
  while (std::uint32_t{mesh.source(h)} != source) h = mesh.next(h);
  return h;
}

/// How many faces have an angle under 30 degrees, do not face the solid that they are on, or hardly, lie on it without
/// liquid between, and lie on a solid that bends.
struct Found {
  std::size_t sharp = 0, turned = 0, films = 0, bends = 0;

  Found& operator+=(const Found& other) {
    sharp += other.sharp;
    turned += other.turned;
    films += other.films;
    bends += other.bends;
    return *this;
  }
};

/// cotangent_sum, without a walk over the mesh: its elements are far from the cache.
double cotangent_sum(const RemeshState& state, std::uint32_t u, std::uint32_t v) {
  const Ring ring = state.connectivity.ring(u);
  int k = 0;
  while (ring.neighbour[k] != v) ++k;
  const auto neighbour = [&](int place) { return VertexIndex(ring.neighbour[(place + ring.degree) % ring.degree]); };
  return cotangent_sum(state, VertexIndex(u), VertexIndex(v), neighbour(k + 1), neighbour(k - 1));
}

/// The square of the length from which on an edge may have to be split.
double least_long_edge2(const EdgeBand& band) {
  const double length = band.edge_max / band.refinement;
  return length * length;
}

/// Whether an edge of a wet face needs a look: it is out of the band, or the band's weight there is not plain to see.
/// With no face turned over, both faces of an edge from inside the wetted area are wet.
bool may_need_work(const RemeshState& state, std::uint32_t u, std::uint32_t v, double length2) {
  const Contact* contact = state.drop.contact();
  if (state.has_turned_faces || state.has_bends || (contact[u] != Contact::wetted && contact[v] != Contact::wetted))
    return true;
  const double weighted2 = state.options.band.wetted_weight * state.options.band.wetted_weight * length2;
  return state.is_long(weighted2) || state.is_short(weighted2);
}

/// The same for all edges of a wet face: none needs a look if this is false.
bool may_wet_face_leave_band(const RemeshState& state, const std::array<std::uint32_t, 3>& t, const Sides& sides) {
  const Contact* contact = state.drop.contact();
  const double weight2 = state.options.band.wetted_weight * state.options.band.wetted_weight;
  if (state.is_short(weight2 * sides.least) || state.is_long(weight2 * sides.greatest)) return true;
  const auto is_on_line = [&](std::uint32_t v) { return contact[v] == Contact::line; };
  return state.is_long(sides.greatest) && std::count_if(t.begin(), t.end(), is_on_line) >= 2;
}

/// Queues each edge that needs it once: from the face in which it runs to the larger index.
void inspect_face(RemeshState& state, FaceIndex f, const Sides& sides, bool is_wet) {
  const auto& t = state.connectivity.triangles()[f];
  const double low2 = state.options.band.edge_min * state.options.band.edge_min;
  const double high2 = least_long_edge2(state.options.band);
  if (sides.is_poor())
    for (const auto v : t) state.drop.poor_quality()[v] = 1;
  for (int k = 0; k < 3; ++k) {
    const auto u = t[(k + 1) % 3], v = t[(k + 2) % 3];
    const double length2 = sides.squared[k];
    if (u < v && (is_wet ? may_need_work(state, u, v, length2) : length2 < low2 || length2 > high2))
      state.queue(state.mesh.edge(halfedge_from(state.mesh, f, u)));
    if (sides.sum < 2 * length2 && cotangent_sum(state, u, v) < state.options.flip_below)  // obtuse at corner k
      state.queue_flip(state.mesh.edge(halfedge_from(state.mesh, f, u)));
  }
}

/// Left out of the band, and still so?
void count_left_out(RemeshState& state) {
  auto& refused = state.scratch.refused;
  std::stable_sort(refused.begin(), refused.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  EdgeIndex last = Mesh::null_edge();
  for (const auto& [e, why] : refused) {
    if (e == last || state.mesh.is_removed(e)) continue;
    last = e;
    const auto h = state.mesh.halfedge(e);
    const double length2 = state.squared_length(h);
    if (!state.is_long(length2) && !state.is_short(length2)) continue;
    ++(state.is_long(length2) ? state.report.edges_above : state.report.edges_below);
    RefusedEdges& counts = state.report.refused;
    switch (why) {
      case Refusal::link_condition:
        ++counts.link_condition;
        break;
      case Refusal::would_be_sliver:
        ++counts.would_be_sliver;
        break;
      case Refusal::would_be_long:
        ++counts.would_be_long;
        break;
      case Refusal::valence:
        ++counts.valence;
        break;
      case Refusal::feature:
        ++counts.feature;
        break;
      case Refusal::contact_line:
        ++counts.contact_line;
        break;
      case Refusal::near_intersection:
        ++counts.near_intersection;
        break;
      default:
        ++counts.would_invert;
        break;
    }
    for (const auto v : {state.mesh.source(h), state.mesh.target(h)}) state.drop.poor_quality()[v] = 1;
  }
}

}  // namespace

void scan(RemeshState& state) {
  const auto& triangles = state.connectivity.triangles();
  const Contact* contact = state.drop.contact();
  const std::size_t rows = state.drop.num_rows();
  state.has_contact = touches_solid(state.drop);
  std::fill_n(state.drop.poor_quality(), rows, std::uint8_t{0});
  const auto x = std::as_const(state.drop).positions();
  const double low2 = state.options.band.edge_min * state.options.band.edge_min;
  const double high2 = least_long_edge2(state.options.band);
  const auto on_solid = [&](const std::array<std::uint32_t, 3>& t) {
    return state.has_contact ? is_colliding(contact[t[0]]) + is_colliding(contact[t[1]]) + is_colliding(contact[t[2]])
                             : 0;
  };
  const auto sides_of = [&](const std::array<std::uint32_t, 3>& t) {
    return Sides(x.col(t[0]), x.col(t[1]), x.col(t[2]));
  };
  const auto n = std::as_const(state.drop).contact_normals();
  const auto is_turned = [&](const std::array<std::uint32_t, 3>& t) {
    const Eigen::Vector3d normal = (n.col(t[0]) + n.col(t[1]) + n.col(t[2])) / 3;
    return facing(x.col(t[0]), x.col(t[1]), x.col(t[2]), normal) < hardly_facing;
  };
  const auto is_bent = [&](const std::array<std::uint32_t, 3>& t) {
    return is_bend(n.col(t[0]), n.col(t[1])) || is_bend(n.col(t[1]), n.col(t[2])) || is_bend(n.col(t[2]), n.col(t[0]));
  };
  // All faces are looked at on all threads; the few that need more are inspected in their order.
  std::vector<std::uint8_t>& marked = state.scratch.marked_faces;
  marked.resize(triangles.size());
  const Found found = sum_over_chunks(triangles.size(), Found{}, [&](std::size_t begin, std::size_t end) {
    Found part;
    for (std::size_t f = begin; f < end; ++f) {
      marked[f] = 0;
      const auto& t = triangles[f];
      if (t[0] == Connectivity::removed) continue;
      const Sides sides = sides_of(t);
      const int colliding = on_solid(t);
      part.sharp += sides.is_sharp();
      part.turned += colliding == 3 && is_turned(t);
      part.bends += colliding == 3 && is_bent(t);
      part.films += colliding == 2 && is_film(state, FaceIndex(static_cast<std::uint32_t>(f)));
      const bool may_leave_band =
          colliding == 3 ? may_wet_face_leave_band(state, t, sides) : sides.least < low2 || sides.greatest > high2;
      marked[f] = may_leave_band || sides.is_obtuse() || sides.is_poor();
    }
    return part;
  });
  state.has_sharp_angle = found.sharp > 0;
  state.has_turned_faces = found.turned > 0;
  state.has_films = found.films > 0;
  state.has_bends = found.bends > 0;
  state.has_slits = state.has_contact && has_slits(state);
  const bool wet_faces_need_more = state.has_turned_faces || state.has_bends;
  for (std::uint32_t f = 0; f < triangles.size(); ++f) {
    if (triangles[f][0] == Connectivity::removed || (marked[f] == 0 && !wet_faces_need_more)) continue;
    const bool wet = on_solid(triangles[f]) == 3;
    if (marked[f] != 0 || wet) inspect_face(state, FaceIndex(f), sides_of(triangles[f]), wet);
  }
}

void mark_poor_quality(RemeshState& state) {
  auto& changed = state.scratch.changed;
  std::sort(changed.begin(), changed.end());
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  const auto x = std::as_const(state.drop).positions();
  std::uint8_t* poor = state.drop.poor_quality();
  for (const auto v : changed) poor[v] = 0;
  for (const auto v : changed) {
    const Ring r = state.ring(v);
    for (int k = 0; k < r.degree; ++k) {
      const auto p = r.neighbour[k], q = r.neighbour[k + 1 == r.degree ? 0 : k + 1];
      if (Sides(x.col(v), x.col(p), x.col(q)).is_poor()) poor[v] = poor[p] = poor[q] = 1;
    }
  }
  count_left_out(state);
}

void check_options(const RemeshOptions& options) {
  const EdgeBand& band = options.band;
  if (!(band.edge_min > 0) || !std::isfinite(band.edge_min) || !std::isfinite(band.edge_max))
    throw UsageError(fmt::format("edge lengths must be finite and above 0: edge_min is {}, edge_max is {} (cm)",
                                 band.edge_min, band.edge_max));
  if (!(band.edge_max > 2 * band.edge_min))
    throw UsageError(
        fmt::format("edge_max ({} cm) must be more than twice edge_min ({} cm), or edges would be split "
                    "and collapsed in turn; the paper takes three times",
                    band.edge_max, band.edge_min));
  if (!(band.wetted_weight > 0 && band.wetted_weight <= 1))
    throw UsageError(fmt::format("the wetted weight must lie in (0, 1]; it is {}", band.wetted_weight));
  if (!(band.refinement >= 1) || !std::isfinite(band.refinement))
    throw UsageError(fmt::format("the refinement must be finite and at least 1; it is {}", band.refinement));
  if (!(options.smoothing >= 0 && options.smoothing <= 1))
    throw UsageError(fmt::format("the smoothing must lie in [0, 1]; it is {}", options.smoothing));
  if (options.max_passes < 1) throw UsageError("remeshing needs at least one pass");
  if (options.feature_angle && !(*options.feature_angle > 0 && *options.feature_angle < 3.1416))
    throw UsageError(
        fmt::format("the feature angle must lie between 0 and 180 degrees; it is {} radians", *options.feature_angle));
}

Remesher::Remesher() : scratch_(std::make_unique<Scratch>()) {}
Remesher::~Remesher() = default;
Remesher::Remesher(Remesher&&) noexcept = default;
Remesher& Remesher::operator=(Remesher&&) noexcept = default;

RemeshReport remesh_with(Remesher::Scratch& scratch, Drop& drop, const RemeshOptions& options) {
  scratch.splits.clear();
  scratch.collapses.clear();
  for (const auto e : scratch.flips) scratch.in_flips[e] = 0;
  scratch.flips.clear();
  scratch.refused.clear();
  scratch.changed.clear();
  scratch.attributes.clear();
  scratch.guard.reset();
  RemeshState state(drop, options, scratch);
  scan(state);
  const bool rests = scratch.splits.empty() && scratch.collapses.empty() && scratch.flips.empty() &&
                     !state.has_turned_faces && !state.has_films && !state.has_slits;
  if (rests && (options.smoothing == 0 || !state.has_sharp_angle)) return state.report;
  WatchedRegion region = options.guard_everywhere ? WatchedRegion() : guarded_region(drop, options.band.edge_max);
  if (!region.empty()) scratch.guard.emplace(drop, std::move(region));
  run_passes(state);
  scratch.guard.reset();
  mark_poor_quality(state);
  if (state.report.changed()) {
    drop.topology_changed();
    drop.collect_garbage();
  }
  return state.report;
}

RemeshReport Remesher::remesh(Drop& drop, const RemeshOptions& options) {
  return remesh_with(*scratch_, drop, options);
}

RemeshReport remesh(Drop& drop, const RemeshOptions& options) {
  check_options(options);
  return Remesher().remesh(drop, options);
}

}  // namespace meniscus
