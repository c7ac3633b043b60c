// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/body_pressure.h"
#include "meniscus/state/contact_line.h"
#include "meniscus/state/drop.h"
#include "meniscus/state/solid.h"

#include <vector>

namespace meniscus {

enum class ContactForce {
  measured_angle,  ///< Eq 8 as written: a force alpha (theta - theta_c) along n_p
  virtual_work,    ///< the surface energies' force sigma (cos theta_c - cos theta) per length, taken implicitly
};

struct ContactAngleOptions {
  ContactForce force = ContactForce::virtual_work;
  double boundary_force = 1;           ///< alpha of Eq 8, cm/s of contact line speed per radian and step
  double tension_over_mass = 0;        ///< virtual_work: c = 2 sigma/(rho R), cm^3/s^2 per cm of energy gradient
  double line_friction_over_mass = 0;  ///< virtual_work: 2 xi/(rho R), cm/s, xi in g/(cm s) of contact line
  BodyPressure body_pressure;          ///< virtual_work: that of the last flow
};

struct ContactAngleReport {
  std::size_t line = 0, advancing = 0, receding = 0;  ///< vertices
  std::size_t straightened = 0;                       ///< virtual_work: vertices where the line turned too sharply
};

/// Moves the contact line towards its stable angle (Section 4.3 of the paper, Eq 8): outward where
/// theta is above the solid's advancing angle, inward where it is below the receding angle, and
/// not at all between. Each solid brings its own two angles; a source holds its line where it is.
///
/// measured_angle is the paper's. virtual_work measures theta by the derivative of the surface area
/// and pushes each line vertex by c f/M against friction, implicitly, so that it is stable at any dt; a
/// vertex between its two angles sticks to the solid. The drop's pressure counts in the balance. Where the line turns
/// by more than 90 degrees (or three times what a regular polygon of its vertices would) the vertex goes half way to
/// the middle of its neighbours.
///
/// Reads positions, `geometry` (lumped areas only: that of the step's start will do), contact state and `time` (for
/// moving solids); writes positions and velocities of line vertices, never along the solid's normal.
ContactAngleReport apply_contact_angle(Drop& drop, const std::vector<Solid>& solids, const SurfaceGeometry& geometry,
                                       double time, double dt, const ContactAngleOptions& options);

}  // namespace meniscus
