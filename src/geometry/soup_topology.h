// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/mesh_data.h"

namespace meniscus {

constexpr std::uint32_t no_component = ~std::uint32_t{0};

/// How the triangles of a soup hang together, by indices. Only triangles of three different
/// vertices that are there take part.
struct SoupTopology {
  struct Edge {
    std::uint32_t low, high;           ///< its vertices
    std::vector<std::uint32_t> faces;  ///< in index order
  };

  std::vector<std::uint32_t> component;  ///< of each triangle, numbered by their first; or no_component
  std::size_t num_components = 0, num_edges = 0;
  std::size_t num_vertices = 0;                   ///< of triangles that take part
  std::vector<Edge> boundary;                     ///< edges of one face
  std::vector<Edge> non_manifold;                 ///< edges of more than two
  std::vector<Edge> inconsistent;                 ///< edges that their two faces run along in one direction
  std::vector<std::uint32_t> pinched;             ///< vertices whose faces form more than one fan
  std::vector<std::vector<std::uint32_t>> holes;  ///< indices into `boundary`, joined by common vertices
};

SoupTopology soup_topology(const MeshData& data);

}  // namespace meniscus
