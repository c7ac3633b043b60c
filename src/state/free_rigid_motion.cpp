// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/state/free_rigid_motion.h"

#include <algorithm>

namespace meniscus {

using Eigen::Vector3d;

RigidMotion free_rigid_motion(const Drop& drop, const SurfaceGeometry& geometry) {
  const ConstColumns v = drop.velocities();
  RigidMotion held;
  double area = 0;
  const Contact* contact = drop.contact();
  if (!touches_solid(drop)) return fit_rigid_motion(drop.positions(), v, geometry);
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i) {
    if (contact[i] != Contact::line) continue;
    const Vector3d n = drop.contact_normals().col(i);
    held.translation += geometry.lumped_area(i) * (v.col(i) - v.col(i).dot(n) * n);
    area += geometry.lumped_area(i);
  }
  if (area > 0) held.translation /= area;
  return held;
}

}  // namespace meniscus
