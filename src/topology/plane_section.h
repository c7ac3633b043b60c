// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/types.h"

#include <optional>
#include <vector>

namespace meniscus {

/// The plane n.x = offset, n a unit vector.
struct Plane {
  Eigen::Vector3d normal;
  double offset;
  double distance(const Point& p) const { return normal.dot(to_eigen(p)) - offset; }
};

/// One closed curve in which a plane meets a closed mesh.
struct Section {
  std::vector<HalfedgeIndex> crossings;  ///< each runs from the plane's positive side to the other
  double perimeter = 0;                  ///< cm
};

/// Where an edge (positive to negative side) meets the plane, as a share of its length from the source.
double crossing(const Mesh& mesh, HalfedgeIndex h, const Plane& plane);

/// The curve through one crossing edge; nothing if it is longer than `longest`.
std::optional<Section> trace_section(const Mesh& mesh, HalfedgeIndex start, const Plane& plane, double longest);

/// An edge that crosses the plane, found by walking from v straight along the plane's normal (or
/// against it); null if the walk ends in a peak first.
HalfedgeIndex walk_to_plane(const Mesh& mesh, VertexIndex v, const Plane& plane);

}  // namespace meniscus
