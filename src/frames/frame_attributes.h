// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/mesh_data.h"

#include <array>
#include <string>
#include <vector>

/// What formats with vectors need of a mesh whose attributes are scalars.
namespace meniscus {

bool is_velocity(const VertexAttribute& attribute);  ///< vx, vy or vz

/// x, y, z of each vertex' velocity in turn (cm/s); empty if the mesh does not have all three.
std::vector<double> velocities(const MeshData& data);

/// The unit normal of each vertex: of the sum of its faces' area vectors; z where that vanishes.
std::vector<std::array<float, 3>> vertex_normals(const MeshData& data);

/// Throws GeometryError if a point or a velocity is not finite, or a triangle names a vertex that is not there.
void check_finite(const MeshData& data);

}  // namespace meniscus
