// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/geometry/rigid_motion.h"

#include "meniscus/core/chunks.h"

#include <Eigen/Dense>

namespace meniscus {

using Eigen::Matrix3d;
using Eigen::Vector3d;

RigidMotionFit& RigidMotionFit::operator+=(const RigidMotionFit& other) {
  mass_ += other.mass_;
  first_ += other.first_;
  momentum_ += other.momentum_;
  angular_momentum_ += other.angular_momentum_;
  squares_ += other.squares_;
  products_ += other.products_;
  return *this;
}

RigidMotion RigidMotionFit::motion() const {
  if (!(mass_ > 0)) return {};
  const Vector3d arm = first_ / mass_;
  RigidMotion motion;
  motion.center = origin_ + arm;
  motion.translation = momentum_ / mass_;
  Matrix3d second;  // about the centre: sum of m r r^T
  second << squares_.x(), products_.z(), products_.y(), products_.z(), squares_.y(), products_.x(), products_.y(),
      products_.x(), squares_.z();
  second -= mass_ * arm * arm.transpose();
  const Matrix3d inertia = second.trace() * Matrix3d::Identity() - second;
  motion.rotation = inertia.ldlt().solve(angular_momentum_ - arm.cross(momentum_));
  return motion;
}

Vector3d fit_origin(const ConstColumns& x, const SurfaceGeometry& geometry) {
  for (Eigen::Index i = 0; i < x.cols(); ++i)
    if (geometry.lumped_area(static_cast<std::uint32_t>(i)) > 0) return x.col(i);
  return Vector3d::Zero();
}

RigidMotion fit_rigid_motion(const ConstColumns& x, const ConstColumns& v, const SurfaceGeometry& geometry) {
  const RigidMotionFit none(fit_origin(x, geometry));
  return sum_over_chunks(static_cast<std::size_t>(x.cols()), none,
                         [&](std::size_t begin, std::size_t end) {
                           RigidMotionFit fit = none;
                           for (auto i = static_cast<std::uint32_t>(begin); i < end; ++i)
                             fit.add(geometry.lumped_area(i), x.col(i), v.col(i));
                           return fit;
                         })
      .motion();
}

}  // namespace meniscus
