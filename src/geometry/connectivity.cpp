// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/geometry/connectivity.h"

#include "meniscus/core/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace meniscus {
namespace {

/// The triangle of face f, starting at its smallest vertex.
std::array<std::uint32_t, 3> sorted_triangle(const Mesh& mesh, FaceIndex f) {
  const auto h = mesh.halfedge(f);
  std::array<std::uint32_t, 3> t{mesh.source(h), mesh.target(h), mesh.target(mesh.next(h))};
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

}  // namespace

std::size_t Connectivity::long_ring(std::uint32_t v) const {
  const auto it = std::lower_bound(long_rings_.begin(), long_rings_.end(), v,
                                   [](const LongRing& ring, std::uint32_t vertex) { return ring.vertex < vertex; });
  return static_cast<std::size_t>(it - long_rings_.begin());
}

void Connectivity::rebuild(const Mesh& mesh) {
  long_rings_.clear();
  degree_.assign(mesh.num_vertices(), 0);
  triangles_.assign(mesh.num_faces(), {removed, removed, removed});
  neighbour_.resize(width * std::size_t{mesh.num_vertices()});
  corner_.assign(width * std::size_t{mesh.num_vertices()}, 0);
  for (const auto f : mesh.faces()) read_face(mesh, f);
  for (std::uint32_t v = 0; v < mesh.num_vertices(); ++v) read_ring(mesh, VertexIndex(v));
}

void Connectivity::grow(const Mesh& mesh) {
  degree_.resize(mesh.num_vertices(), 0);
  triangles_.resize(mesh.num_faces(), {removed, removed, removed});
  neighbour_.resize(width * std::size_t{mesh.num_vertices()});
  corner_.resize(width * std::size_t{mesh.num_vertices()}, 0);
}

void Connectivity::update_vertex(const Mesh& mesh, VertexIndex v) {
  if (!mesh.is_removed(v) && mesh.halfedge(v) != Mesh::null_halfedge())
    for (const auto h : CGAL::halfedges_around_target(mesh.halfedge(v), mesh)) read_face(mesh, mesh.face(h));
  read_ring(mesh, v);
}

void Connectivity::start_ring_at(std::uint32_t v, std::uint32_t neighbour) {
  const Ring ring = this->ring(v);
  const auto place = std::find(ring.neighbour, ring.neighbour + ring.degree, neighbour) - ring.neighbour;
  if (place == ring.degree)
    throw GeometryError(fmt::format("vertex {} cannot be the first around vertex {}: they share no edge", neighbour, v),
                        {}, {v, neighbour});
  const auto turn = [&](std::uint32_t* row) { std::rotate(row, row + place, row + ring.degree); };
  if (ring.degree <= width) {
    turn(&neighbour_[width * std::size_t{v}]);
    turn(&corner_[width * std::size_t{v}]);
  } else {
    LongRing& turned = long_rings_[long_ring(v)];
    turn(turned.neighbour.data());
    turn(turned.corner.data());
  }
}

void Connectivity::read_face(const Mesh& mesh, FaceIndex f) { triangles_[f] = sorted_triangle(mesh, f); }

void Connectivity::read_ring(const Mesh& mesh, VertexIndex v) {
  if (degree_[v] > width) long_rings_.erase(long_rings_.begin() + static_cast<std::ptrdiff_t>(long_ring(v)));
  std::uint32_t* const neighbour = &neighbour_[width * std::size_t{v}];
  std::uint32_t* const corner = &corner_[width * std::size_t{v}];
  int degree = 0;
  if (!mesh.is_removed(v) && mesh.halfedge(v) != Mesh::null_halfedge()) {
    const auto first = mesh.halfedge(v);
    const auto corner_in = [&](FaceIndex f) {
      const auto& t = triangles_[f];
      return 3 * static_cast<std::uint32_t>(f) + (t[0] == v ? 0u : t[1] == v ? 1u : 2u);
    };
    auto h = first;
    do {
      if (degree < width) {
        neighbour[degree] = mesh.target(mesh.next(h));
        corner[degree] = corner_in(mesh.face(h));
      }
      ++degree;
      h = mesh.prev(mesh.opposite(h));
    } while (h != first);
    if (degree > width) {
      LongRing ring{v, {}, {}};
      do {
        ring.neighbour.push_back(mesh.target(mesh.next(h)));
        ring.corner.push_back(corner_in(mesh.face(h)));
        h = mesh.prev(mesh.opposite(h));
      } while (h != first);
      degree_[v] = static_cast<std::uint16_t>(degree);
      const auto place = std::lower_bound(long_rings_.begin(), long_rings_.end(), ring.vertex,
                                          [](const LongRing& r, std::uint32_t vertex) { return r.vertex < vertex; });
      long_rings_.insert(place, std::move(ring));
    }
  }
  degree_[v] = static_cast<std::uint16_t>(degree);
  for (int k = degree > width ? 0 : degree; k < width; ++k) neighbour[k] = v;
}

}  // namespace meniscus
