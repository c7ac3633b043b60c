// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>

namespace meniscus {

/// Whether p lies within the triangle of three points, or on its border, as seen along n.
inline bool is_within(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                      const Eigen::Vector3d& c, const Eigen::Vector3d& n) {
  const double u = (b - a).cross(p - a).dot(n), v = (c - b).cross(p - b).dot(n), w = (a - c).cross(p - c).dot(n);
  return (u <= 0 && v <= 0 && w <= 0) || (u >= 0 && v >= 0 && w >= 0);
}

}  // namespace meniscus
