// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/mesh_data.h"

/// Measures of triangle meshes. A Mesh must have triangles only; removed faces do not count. Of a
/// MeshData, triangles that name a vertex which is not there, or one twice, or one whose
/// coordinates are not finite do not count; so everything else is safe on any soup. No triangles: zeros.
///
/// Coordinates are scaled by a power of two meanwhile, so that nothing overflows but the results.
namespace meniscus {

struct EdgeLengths {
  double min = 0, mean = 0, max = 0;  ///< cm
};

/// Every side of every triangle counts: on a closed mesh that is each edge twice.
EdgeLengths edge_lengths(const Mesh& mesh);
EdgeLengths edge_lengths(const MeshData& data);

struct Angles {
  double least = 0, greatest = 0;  ///< of all corners, radians
  double share_below = 0;          ///< the share of triangles whose least angle is below `threshold`
};

/// A triangle without area has angles 0 and pi (0, 0 and 0 if it is a point).
Angles angles(const Mesh& mesh, double threshold = 0);
Angles angles(const MeshData& data, double threshold = 0);

double surface_area(const Mesh& mesh);  ///< cm^2
double surface_area(const MeshData& data);

/// The sum over triangles of the signed volume that they span with the first vertex (cm^3): what a
/// closed mesh encloses, negative if it is inside out; of no meaning for open ones.
double enclosed_volume(const Mesh& mesh);
double enclosed_volume(const MeshData& data);

/// The centre of mass of the solid that a closed mesh encloses (cm). If that is of no volume, the
/// mean of the triangles' corners.
Eigen::Vector3d solid_centroid(const Mesh& mesh);
Eigen::Vector3d solid_centroid(const MeshData& data);

}  // namespace meniscus
