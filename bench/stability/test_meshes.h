// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/types.h"

#include <array>
#include <string>

namespace meniscus::bench {

/// How good the triangles are.
enum class Quality {
  good,      ///< an icosphere, stretched
  jittered,  ///< each vertex moved along the surface by up to a quarter of an edge
  obtuse,    ///< sheared: twisted about the axis, angles up to 150 degrees
  slivers,   ///< a vertex of one face in twenty moved next to the middle of the edge opposite
  needle,    ///< one edge in thirty shortened to a fiftieth
  aspect,    ///< one edge in thirty shortened to a thousandth
};
inline constexpr std::array<const char*, 6> quality_names{"good", "jittered", "obtuse", "slivers", "needle", "1:1000"};

/// A spheroid about the origin, half as wide as it is long (along z), of the volume of a ball of `radius`, vertices
/// on the exact surface, edges near edge_length (cm). The same for the same seed on every machine.
/// Throws GeometryError if the mesh is not sound.
Mesh test_spheroid(Quality quality, double radius, double edge_length, unsigned seed);

}  // namespace meniscus::bench
