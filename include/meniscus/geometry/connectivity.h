// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/types.h"

#include <array>
#include <cstdint>
#include <vector>

namespace meniscus {

/// The neighbours of a vertex in counterclockwise order seen from outside. Face k of the ring is
/// (v, neighbour[k], neighbour[k + 1]); corner[k] = 3 f + c says that it is face f, whose corner c is v.
struct Ring {
  const std::uint32_t* neighbour;
  const std::uint32_t* corner;
  int degree;  ///< 0 for a removed or isolated vertex
};

/// The rings and triangles of a closed mesh as flat arrays, so that hot loops never walk halfedges.
///
/// Row v of every array is vertex v of the mesh, removed ones included (degree 0, so that they take
/// no part). Rings of up to `width` neighbours lie in rows of fixed width, padded with v itself;
/// longer ones lie in a list of their own, sorted by vertex.
/// Triangles start at their smallest vertex index, so that they depend on nothing but their vertices.
class Connectivity {
 public:
  static constexpr int width = 8;
  static constexpr std::uint32_t removed = ~std::uint32_t{0};

  struct LongRing {
    std::uint32_t vertex;
    std::vector<std::uint32_t> neighbour, corner;
  };

  /// Reads the whole mesh. Precondition: closed and triangular (no border halfedge).
  void rebuild(const Mesh& mesh);

  /// Brings the arrays up to the size of the mesh after elements were added.
  void grow(const Mesh& mesh);

  /// Reads the faces and the ring of one vertex again. After an edge operation, call it for every
  /// vertex of every face that was made, changed or removed (removed vertices included).
  void update_vertex(const Mesh& mesh, VertexIndex v);

  /// Turns the ring of v so that it starts at `neighbour`: where a ring starts decides the last bits of sums
  /// over it. Throws GeometryError if it is no neighbour.
  void start_ring_at(std::uint32_t v, std::uint32_t neighbour);

  /// Marks a face as removed. Call it for the faces that an edge operation removed.
  void remove_face(FaceIndex f) { triangles_[f] = {removed, removed, removed}; }

  std::size_t num_rows() const { return degree_.size(); }
  /// All faces, removed ones as {removed, removed, removed}.
  const std::vector<std::array<std::uint32_t, 3>>& triangles() const { return triangles_; }
  int degree(std::uint32_t v) const { return degree_[v]; }
  Ring ring(std::uint32_t v) const {
    const int degree = degree_[v];
    if (degree <= width) return {&neighbour_[width * std::size_t{v}], &corner_[width * std::size_t{v}], degree};
    const LongRing& ring = long_rings_[long_ring(v)];
    return {ring.neighbour.data(), ring.corner.data(), degree};
  }
  /// Rows of `width` neighbours, for loops over all vertices; a long ring's row is all v.
  const std::uint32_t* neighbour_rows() const { return neighbour_.data(); }
  const std::uint32_t* corner_rows() const { return corner_.data(); }
  const std::uint16_t* degrees() const { return degree_.data(); }
  const std::vector<LongRing>& long_rings() const { return long_rings_; }
  /// The place in long_rings() of vertex v. Precondition: degree(v) > width.
  std::size_t long_ring(std::uint32_t v) const;

 private:
  void read_face(const Mesh& mesh, FaceIndex f);
  void read_ring(const Mesh& mesh, VertexIndex v);

  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<std::uint32_t> neighbour_, corner_;  // width entries a row
  std::vector<std::uint16_t> degree_;
  std::vector<LongRing> long_rings_;
};

}  // namespace meniscus
