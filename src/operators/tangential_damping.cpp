// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/operators/tangential_damping.h"

#include "meniscus/core/chunks.h"

#include <algorithm>

namespace meniscus {

using Eigen::Vector3d;

namespace {

/// Gives back the momentum that the removal took from a drop in flight, which moved as `before` and moves as `after`:
/// without it, an uneven mesh drives itself.
void restore_rigid_motion(Drop& drop, const RigidMotion& before, const RigidMotion& after, double dt) {
  Columns x = drop.positions(), v = drop.velocities();
  for_each_chunk(drop.num_rows(), [&](std::size_t begin, std::size_t end) {
    for (auto i = static_cast<std::uint32_t>(begin); i < end; ++i) {
      if (drop.connectivity().degree(i) == 0) continue;
      const Vector3d p = x.col(i), lost = before.at(p) - after.at(p);
      v.col(i) += lost;
      x.col(i) += lost * dt;
    }
  });
}

}  // namespace

void remove_tangential_deformation(Drop& drop, const SurfaceGeometry& geometry, const RigidMotion& rigid, double dt) {
  const Contact* contact = drop.contact();
  const bool in_flight = !touches_solid(drop);
  Columns x = drop.positions(), v = drop.velocities();
  const RigidMotionFit none(fit_origin(x, geometry));
  const RigidMotionFit after = sum_over_chunks(drop.num_rows(), none, [&](std::size_t begin, std::size_t end) {
    RigidMotionFit fit = none;
    for (auto i = static_cast<std::uint32_t>(begin); i < end; ++i) {
      if (drop.connectivity().degree(i) == 0 || is_colliding(contact[i])) continue;
      const Vector3d u = v.col(i) - rigid.at(x.col(i)), normal = geometry.normal(i);
      const Vector3d along = u - u.dot(normal) * normal;
      v.col(i) -= along;
      x.col(i) -= along * dt;
      if (in_flight) fit.add(geometry.lumped_area(i), x.col(i), v.col(i));
    }
    return fit;
  });
  if (in_flight) restore_rigid_motion(drop, rigid, after.motion(), dt);
}

}  // namespace meniscus
