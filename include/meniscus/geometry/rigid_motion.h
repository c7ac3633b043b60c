// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/types.h"
#include "meniscus/geometry/surface_geometry.h"

#include <Eigen/Geometry>

namespace meniscus {

/// A rigid velocity field: translation + rotation x (x - center).
struct RigidMotion {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();       ///< cm
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< cm/s
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();     ///< rad/s

  Eigen::Vector3d at(const Eigen::Vector3d& x) const { return translation + rotation.cross(x - center); }
};

/// Sums over vertices from which the rigid motion nearest to a velocity field follows, in one pass: moments about an
/// origin near the vertices (cm), so that nothing cancels.
class RigidMotionFit {
 public:
  explicit RigidMotionFit(const Eigen::Vector3d& origin = Eigen::Vector3d::Zero()) : origin_(origin) {}
  /// A vertex of mass m (any unit) at x (cm) with velocity v (cm/s).
  void add(double m, const Eigen::Vector3d& x, const Eigen::Vector3d& v) {
    const Eigen::Vector3d r = x - origin_;
    mass_ += m;
    first_ += m * r;
    momentum_ += m * v;
    angular_momentum_ += m * r.cross(v);
    squares_ += m * r.cwiseAbs2();
    products_ += m * Eigen::Vector3d(r.y() * r.z(), r.z() * r.x(), r.x() * r.y());
  }
  /// Precondition: the same origin.
  RigidMotionFit& operator+=(const RigidMotionFit& other);
  /// All zero if there is no mass.
  RigidMotion motion() const;

 private:
  Eigen::Vector3d origin_;
  double mass_ = 0;
  Eigen::Vector3d first_ = Eigen::Vector3d::Zero(), momentum_ = Eigen::Vector3d::Zero(),
                  angular_momentum_ = Eigen::Vector3d::Zero(), squares_ = Eigen::Vector3d::Zero(),
                  products_ = Eigen::Vector3d::Zero();  // of r: x^2, y^2, z^2; yz, zx, xy
};

/// The origin for a RigidMotionFit: the first vertex that has an area; zero if none has.
Eigen::Vector3d fit_origin(const ConstColumns& positions, const SurfaceGeometry& geometry);

/// The rigid motion nearest to a velocity field on a surface, in the least squares weighted by the
/// lumped areas; it is found exactly if the field is rigid. Positions and velocities are 3 x n.
RigidMotion fit_rigid_motion(const ConstColumns& positions, const ConstColumns& velocities,
                             const SurfaceGeometry& geometry);

}  // namespace meniscus
