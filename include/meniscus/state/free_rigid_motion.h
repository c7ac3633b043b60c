// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/geometry/rigid_motion.h"
#include "meniscus/state/drop.h"

namespace meniscus {

/// The part of a drop's velocities that does not deform it. In flight: fit_rigid_motion. On a solid: the
/// mean velocity of the contact line along it (a solid that moves carries the drop along by its line);
/// all else that the drop does there changes its shape.
RigidMotion free_rigid_motion(const Drop& drop, const SurfaceGeometry& geometry);

}  // namespace meniscus
