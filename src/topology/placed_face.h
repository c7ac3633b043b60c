// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/geometry/placed_triangle.h"
#include "meniscus/topology/boolean.h"

namespace meniscus {

inline PlacedTriangle placed_face(const MeshView& mesh, std::uint32_t face) {
  const Triangle& t = mesh.triangles[face];
  return {t, {mesh.points.col(t[0]), mesh.points.col(t[1]), mesh.points.col(t[2])}};
}

}  // namespace meniscus
