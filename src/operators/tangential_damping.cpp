// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/operators/tangential_damping.h"

#include "meniscus/state/free_rigid_motion.h"

namespace meniscus {

using Eigen::Vector3d;

void remove_tangential_deformation(Drop& drop, const SurfaceGeometry& geometry, double dt) {
  const RigidMotion rigid = free_rigid_motion(drop, geometry);
  Columns x = drop.positions(), v = drop.velocities();
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i) {
    if (drop.connectivity().degree(i) == 0 || is_colliding(drop.contact()[i])) continue;
    const Vector3d u = v.col(i) - rigid.at(x.col(i)), normal = geometry.normal(i);
    const Vector3d along = u - u.dot(normal) * normal;
    v.col(i) -= along;
    x.col(i) -= along * dt;
  }
}

}  // namespace meniscus
