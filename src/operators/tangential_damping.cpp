// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/operators/tangential_damping.h"

#include "meniscus/state/free_rigid_motion.h"

namespace meniscus {

using Eigen::Vector3d;

namespace {

/// Gives back the momentum that the removal took from a drop in flight: without it, an uneven mesh drives
/// itself.
void restore_rigid_motion(Drop& drop, const SurfaceGeometry& geometry, const RigidMotion& before, double dt) {
  Columns x = drop.positions(), v = drop.velocities();
  const RigidMotion after = fit_rigid_motion(x, v, geometry);
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i) {
    if (drop.connectivity().degree(i) == 0) continue;
    const Vector3d p = x.col(i), lost = before.at(p) - after.at(p);
    v.col(i) += lost;
    x.col(i) += lost * dt;
  }
}

}  // namespace

void remove_tangential_deformation(Drop& drop, const SurfaceGeometry& geometry, double dt) {
  const RigidMotion rigid = free_rigid_motion(drop, geometry);
  Columns x = drop.positions(), v = drop.velocities();
  bool in_flight = true;
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i) {
    if (is_colliding(drop.contact()[i])) in_flight = false;
    if (drop.connectivity().degree(i) == 0 || is_colliding(drop.contact()[i])) continue;
    const Vector3d u = v.col(i) - rigid.at(x.col(i)), normal = geometry.normal(i);
    const Vector3d along = u - u.dot(normal) * normal;
    v.col(i) -= along;
    x.col(i) -= along * dt;
  }
  if (in_flight) restore_rigid_motion(drop, geometry, rigid, dt);
}

}  // namespace meniscus
