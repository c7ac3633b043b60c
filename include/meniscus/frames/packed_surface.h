// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/mesh_data.h"

#include <array>
#include <cstdint>
#include <string>

namespace meniscus {

/// A surface in few bytes, for the page: what is seen of it, not what is computed with.
/// Both strings are zlib streams. n vertices, m triangles.
///
/// `vertices` holds for x, then y, then z: n high bytes, then n low bytes of 16-bit numbers. Each is
/// the zigzag (0, -1, 1, -2, ... as 0, 1, 2, 3, ...) of the difference, modulo 2^16, between this vertex' step
/// and the last one's; coordinate = min + step * number (cm), within half a step of the true one.
/// Then n bytes of speed (255 is `speed`), n bytes of contact, and the drop of each vertex as the
/// zigzag difference from the last one's, 7 bits a byte, lowest first, the top bit saying that more follow.
/// `triangles` holds 3m corners as such differences.
struct PackedSurface {
  std::string vertices, triangles;
  std::uint32_t num_vertices = 0, num_triangles = 0;
  std::array<double, 3> min{}, step{};  ///< cm
  double speed = 0;                     ///< the greatest of any vertex, cm/s; 0 if the mesh has no velocities
};

/// Packs points, triangles and the attributes vx, vy, vz, contact and drop, where there are any.
/// Throws GeometryError if a coordinate or velocity is not finite, a triangle names a vertex that is not there,
/// or there are 2^31 vertices or more.
PackedSurface pack_surface(const MeshData& data);

}  // namespace meniscus
