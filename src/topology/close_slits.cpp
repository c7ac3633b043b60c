// SPDX-License-Identifier: GPL-3.0-or-later
#include "remesh_state.h"

#include <CGAL/boost/graph/Euler_operations.h>

#include <algorithm>
#include <optional>

namespace meniscus {
namespace {

using Eigen::Vector3d;

/// A slit is a dry wedge of less than 30 degrees between two parts of the contact line that come together in a vertex.
constexpr double cosine_of_slit = 0.8660254037844387;
/// The wet face that closes it has at least this facing_solid: more than rounding can turn over.
constexpr double least_facing = 1e-6;

/// The end of a slit at `tip`: of its ring the vertices `first` and `last` are on the solid, those between are over it.
struct Slit {
  VertexIndex tip;
  int first, last;  ///< places in the ring; last > first + 1, modulo the degree
};

/// A cyclic view of a ring.
std::uint32_t neighbour(const Ring& ring, int k) { return ring.neighbour[k % ring.degree]; }
FaceIndex face(const Ring& ring, int k) { return FaceIndex(ring.corner[k % ring.degree] / 3); }

bool is_slit(const RemeshState& state, const Ring& ring, const Slit& slit) {
  const Vector3d x = state.point(slit.tip), p = state.point(VertexIndex(neighbour(ring, slit.first))),
                 q = state.point(VertexIndex(neighbour(ring, slit.last)));
  return (p - x).normalized().dot((q - x).normalized()) > cosine_of_slit &&
         facing(x, p, q, state.contact_normal(slit.tip)) > least_facing;
}

/// The end of a slit at a vertex of the contact line, if there is one.
std::optional<Slit> slit_at(const RemeshState& state, VertexIndex tip) {
  const Ring ring = state.ring(tip);
  const auto is_on_solid = [&](int k) { return state.colliding(VertexIndex(neighbour(ring, k))); };
  for (int first = 0; first < ring.degree; ++first) {
    if (!is_on_solid(first) || is_on_solid(first + 1)) continue;
    Slit slit{tip, first, first + 2};
    while (!is_on_solid(slit.last)) ++slit.last;
    const int num_left = ring.degree - (slit.last - slit.first) + 1;  // faces at the tip once it is closed
    if (num_left >= 3 && is_slit(state, ring, slit)) return slit;
  }
  return std::nullopt;
}

/// The line passes over the end of the slit: the faces over it leave the tip, which then lies inside the wetted area.
bool close(RemeshState& state, const Slit& slit) {
  Mesh& mesh = state.mesh;
  const Ring ring = state.ring(slit.tip);
  const std::uint32_t tip = slit.tip, p = neighbour(ring, slit.first), q = neighbour(ring, slit.last);
  const auto placed = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    return SheetGuard::NewFace{{a, b, c},
                               {state.point(VertexIndex(a)), state.point(VertexIndex(b)), state.point(VertexIndex(c))}};
  };
  std::vector<std::uint32_t> removed, over;  // over: what leaves the tip
  auto& faces = state.scratch.new_faces;
  faces = {placed(tip, p, q)};
  for (int k = slit.first; k < slit.last; ++k) {
    removed.push_back(face(ring, k));
    if (k == slit.first) continue;
    over.push_back(neighbour(ring, k));
    faces.push_back(placed(p, neighbour(ring, k), neighbour(ring, k + 1)));
  }
  if (are_joined(mesh, VertexIndex(p), VertexIndex(q))) return false;
  if (std::any_of(over.begin() + 1, over.end(),
                  [&](std::uint32_t v) { return are_joined(mesh, VertexIndex(p), VertexIndex(v)); }))
    return false;
  if (std::any_of(over.begin(), over.end(), [&](std::uint32_t v) { return state.connectivity.degree(v) < 4; }))
    return false;
  if (state.would_meet_sheet({}, removed)) return false;

  std::vector<VertexIndex> changed{slit.tip, VertexIndex(p), VertexIndex(q)};
  for (const std::uint32_t v : over) {
    CGAL::Euler::flip_edge(mesh.halfedge(slit.tip, VertexIndex(v)), mesh);
    changed.emplace_back(v);
  }
  for (const auto v : changed) state.update(v);
  for (const auto v : changed) state.update_contact(v);
  for (const auto v : changed) state.queue_ring(v);
  state.report.flips += over.size();
  return true;
}

/// Where a vertex over a slit comes down on the solid.
struct Landing {
  VertexIndex beside;  ///< a vertex of the line
  Vector3d point;
};

/// The roof of a slit: a free vertex v next to the solid that has faces over either part of the line, or over both
/// sides of its end. On the solid, all face it.
std::optional<Landing> landing_of(const RemeshState& state, VertexIndex v) {
  constexpr double low = 0.1;  // in lengths of edge_min
  const Ring ring = state.ring(v);
  std::optional<Landing> landing;
  int walls = 0;
  for (int k = 0; k < ring.degree; ++k) {
    const VertexIndex p(neighbour(ring, k)), q(neighbour(ring, k + 1));
    if (!state.colliding(p) || !state.colliding(q)) continue;
    const Vector3d n = state.contact_normal(p), x = state.point(v);
    const double height = (x - state.point(p)).dot(n);
    if (!(std::abs(height) < low * state.options.band.edge_min) || is_bend(n, state.contact_normal(q)))
      return std::nullopt;
    if (!landing) landing = Landing{p, x - height * n};
    if (!(facing(landing->point, state.point(p), state.point(q), n) > least_facing)) return std::nullopt;
    ++walls;
  }
  return walls >= 2 ? landing : std::nullopt;
}

bool land(RemeshState& state, VertexIndex v, const Landing& landing) {
  if (state.is_forbidden(landing.point) || state.star_would_meet(v, landing.point)) return false;
  Drop& drop = state.drop;
  drop.contact()[v] = Contact::line;
  drop.contact_solid()[v] = drop.contact_solid()[landing.beside];
  drop.contact_normals().col(v) = state.contact_normal(landing.beside);
  state.mesh.point(v) = to_point(landing.point);
  state.update(v);
  state.update_contact(v);
  const Ring ring = state.ring(v);
  for (int k = 0; k < ring.degree; ++k) state.update_contact(VertexIndex(ring.neighbour[k]));
  state.queue_ring(v);
  ++state.report.lifts;
  return true;
}

/// Where operations have put the surface or the line of late, or it came too near to itself.
bool is_watched(const RemeshState& state, VertexIndex v) {
  return state.drop.seam_watch()[v] != 0 && state.connectivity.degree(v) > 0;
}

}  // namespace

bool has_slits(const RemeshState& state) {
  for (std::uint32_t k = 0; k < state.drop.num_rows(); ++k) {
    const VertexIndex v(k);
    if (!is_watched(state, v)) continue;
    if (state.on_line(v) ? slit_at(state, v).has_value() : !state.colliding(v) && landing_of(state, v).has_value())
      return true;
  }
  return false;
}

void close_slits(RemeshState& state) {
  for (std::uint32_t k = 0; k < state.mesh.num_vertices(); ++k) {
    const VertexIndex v(k);
    if (!is_watched(state, v)) continue;
    if (!state.colliding(v))
      if (const auto landing = landing_of(state, v)) land(state, v, *landing);
    if (!state.on_line(v)) continue;
    if (const auto slit = slit_at(state, v)) close(state, *slit);
  }
}

}  // namespace meniscus
