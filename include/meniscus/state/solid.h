// SPDX-License-Identifier: GPL-3.0-or-later
// DRAFT by the lead so that the operators compile: helper "inspect" owns this file and replaces it (same names).
#pragma once
#include "meniscus/core/types.h"
#include <Eigen/Geometry>
#include <string>
#include <vector>
namespace meniscus {
struct SolidContact { double distance; Eigen::Vector3d point, normal; };
class Solid {
 public:
  static Solid plane(const Eigen::Vector3d& p, const Eigen::Vector3d& n) { Solid s; s.p_ = p; s.n_ = n.normalized(); return s; }
  SolidContact query(const Eigen::Vector3d& x, double) const { double d = (x - p_).dot(n_); return {d, x - d * n_, n_}; }
  Eigen::Vector3d velocity(double) const { return Eigen::Vector3d::Zero(); }
  bool is_near(const Eigen::AlignedBox3d& box, double, double margin) const { for (int k = 0; k < 8; ++k) if ((box.corner((Eigen::AlignedBox3d::CornerType)k) - p_).dot(n_) <= margin) return true; return false; }
  std::string name;
  double advancing_angle = 1.5707963267948966, receding_angle = 1.5707963267948966, friction_speed = 0.1;
  Eigen::Vector3d p_, n_;
};
}
