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

/// The rigid motion nearest to a velocity field on a surface, in the least squares weighted by the
/// lumped areas; it is found exactly if the field is rigid. Positions and velocities are 3 x n.
RigidMotion fit_rigid_motion(const ConstColumns& positions, const ConstColumns& velocities,
                             const SurfaceGeometry& geometry);

}  // namespace meniscus
