// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/geometry/rigid_motion.h"
#include "meniscus/state/drop.h"

namespace meniscus {

/// Takes the part along the surface out of the velocity that deforms a drop (the velocity without `rigid`, that of
/// free_rigid_motion), and what it moved in dt (s) out of the positions.
///
/// That part slides vertices over the surface without changing its shape. With one force a vertex,
/// nothing balances gravity along the surface, and implicit curvature flow moves vertices along it too;
/// without this operator the vertices of a resting drop slide down and remeshing never comes to rest.
/// Not in the paper.
///
/// Reads `geometry` (normals and areas; that of the step's start will do) and contact state; writes
/// velocities and positions of vertices that do not collide. A rigidly moving drop stays as it is,
/// and a drop in flight ends with the linear and angular momentum of `rigid` (of the lumped areas).
void remove_tangential_deformation(Drop& drop, const SurfaceGeometry& geometry, const RigidMotion& rigid, double dt);

}  // namespace meniscus
