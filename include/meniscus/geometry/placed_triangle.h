// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <limits>

namespace meniscus {

/// A triangle of a surface with what tells quickly that it does not meet another one.
struct PlacedTriangle {
  std::array<std::uint32_t, 3> vertices;  ///< two triangles share the corners whose vertices are the same
  std::array<Eigen::Vector3d, 3> points;  ///< cm
  Eigen::Vector3d normal;                 ///< twice the area vector, cm^2
  double reach;                           ///< no less than its longest side, cm
  double rounding;  ///< by how much normal . x may be off for |x| = 1 cm; infinite if the area is next to none

  PlacedTriangle(const std::array<std::uint32_t, 3>& its_vertices, const std::array<Eigen::Vector3d, 3>& its_points);

  bool has_plane() const { return rounding < std::numeric_limits<double>::infinity(); }
  Eigen::AlignedBox3d box() const {
    return {points[0].cwiseMin(points[1]).cwiseMin(points[2]), points[0].cwiseMax(points[1]).cwiseMax(points[2])};
  }
};

/// Whether two triangles of positive area meet elsewhere than in the corners that they share, or share all three: the
/// same answers as those of meet_elsewhere in self_intersection.h, which is asked where rounding could decide.
bool meet(const PlacedTriangle& s, const PlacedTriangle& t);

}  // namespace meniscus
