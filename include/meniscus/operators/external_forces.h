// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/drop.h"
#include "meniscus/state/solid.h"

#include <limits>
#include <vector>

namespace meniscus {

struct ExternalForcesOptions {
  Eigen::Vector3d gravity{0, 0, -981};  ///< cm/s^2
  /// Whether Eq 2 takes friction_speed off once a step, as the paper writes it, or friction_speed
  /// per 1/240 s, so that the slowing does not depend on the time step.
  bool friction_per_step = false;
  /// Whether vertices inside the wetted area stay where they are on the solid (no slip).
  bool no_slip = true;
  double touching_distance = 0;                                   ///< cm: vertices this near to a solid are on it
  double longest_edge = std::numeric_limits<double>::infinity();  ///< cm: for Solid::rim_point
};

struct ExternalForcesReport {
  std::size_t colliding = 0;  ///< vertices on a solid after the step
};

/// Gravity, advection, collision and friction (Section 4.1 of the paper), one time step dt (s) that
/// ends at `time` (s): v += g dt; x += v dt; a vertex inside a solid goes to the nearest point of
/// its surface and loses the velocity along the normal relative to the solid (Eq 1); then friction
/// on the velocity relative to the solid (Eq 2), and x += (v_new - v_old) dt.
///
/// A vertex that was colliding and belongs to a wetted face stays on its solid: nothing can come
/// between. It is the contact line that moves off, along the solid; the last vertices without a
/// wetted face are free to leave. On a source (Solid::inflow) they stay where they are, the line on the
/// disc's rim, with the velocity of what comes out. A source stops liquid in front of it: what is or gets behind its
/// disc from elsewhere passes.
///
/// Reads and writes positions (cm), velocities (cm/s), contact state, normals and solids.
/// A drop far from every solid, or no solids: no contact work. dt = 0 moves nothing.
/// Throws NumericsError if a position or velocity is not finite.
ExternalForcesReport apply_external_forces(Drop& drop, const std::vector<Solid>& solids, double time, double dt,
                                           const ExternalForcesOptions& options);

/// Marks the vertices that lie within `tolerance` (cm) of a solid, or inside it, as colliding, and
/// all others as free (what is behind the disc of a source is not inside it); moves nothing. For drops that start on a
/// solid.
void find_contact(Drop& drop, const std::vector<Solid>& solids, double time, double tolerance);

}  // namespace meniscus
