// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/types.h"

#include <cstdint>
#include <vector>

namespace meniscus {

/// The connectivity of a closed triangle mesh exactly as it lies in memory: removed elements and the order
/// in which new ones will take their places included, so that a mesh made of it grows to the same bits.
struct MeshArrays {
  struct Halfedge {
    std::uint32_t target, face, next;
  };
  std::vector<std::uint32_t> vertex_halfedge;  ///< one a vertex: a halfedge that points to it
  std::vector<Halfedge> halfedges;             ///< 2 e and 2 e + 1 are edge e
  std::vector<std::uint32_t> face_halfedge;    ///< one a face
  /// Removed elements, the one that is used again first in front. What the arrays say of them is zero.
  std::vector<std::uint32_t> removed_vertices, removed_edges, removed_faces;
};

/// Reads them off. Precondition: as above, and CGAL's own lists of removed elements are whole.
MeshArrays mesh_arrays(const Mesh& mesh);

/// The mesh, with every point at the origin. Throws GeometryError, naming the element, unless the arrays are a
/// closed, 2-manifold mesh of triangles without isolated vertices, in every index.
Mesh to_mesh(const MeshArrays& arrays);

}  // namespace meniscus
