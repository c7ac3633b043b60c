// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/drop.h"

namespace meniscus {

/// The one constraint that survives every operator (Section 3 of the paper): colliding vertices
/// never move along the solid's normal. Returns `move` (a displacement or a velocity relative to
/// the solid) of vertex v without its part along the contact normal; unchanged at a free vertex.
inline Eigen::Vector3d constrain_to_solid(const Drop& drop, std::uint32_t v, const Eigen::Vector3d& move) {
  if (!is_colliding(drop.contact()[v])) return move;
  const Eigen::Vector3d n = drop.contact_normals().col(v);
  return move - move.dot(n) * n;
}

}  // namespace meniscus
