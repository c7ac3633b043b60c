// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/geometry/rigid_motion.h"

#include <Eigen/Dense>

namespace meniscus {

RigidMotion fit_rigid_motion(const ConstColumns& x, const ConstColumns& v, const SurfaceGeometry& geometry) {
  const auto n = static_cast<std::uint32_t>(x.cols());
  RigidMotion motion;
  double mass = 0;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double m = geometry.lumped_area(i);
    mass += m;
    motion.center += m * x.col(i);
    motion.translation += m * v.col(i);
  }
  if (!(mass > 0)) return {};
  motion.center /= mass;
  motion.translation /= mass;
  Eigen::Vector3d angular_momentum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for (std::uint32_t i = 0; i < n; ++i) {
    const double m = geometry.lumped_area(i);
    const Eigen::Vector3d r = x.col(i) - motion.center;
    angular_momentum += m * r.cross(Eigen::Vector3d(v.col(i)));
    inertia += m * (r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose());
  }
  motion.rotation = inertia.ldlt().solve(angular_momentum);
  return motion;
}

}  // namespace meniscus
