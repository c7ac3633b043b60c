// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/drop.h"

#include <array>
#include <cmath>
#include <optional>

namespace meniscus {

/// Tells the contact line from the inside of the wetted area: a colliding vertex with a free neighbour
/// becomes Contact::line, the others stay what they are.
void mark_contact_line(Drop& drop);

/// The neighbourhood of a vertex of the contact line (Figure 3 of the paper).
struct ContactLineVertex {
  Eigen::Vector3d outward;  ///< unit, in the solid's tangent plane, from the wetted area to the dry
  double length;            ///< cm of contact line that belongs to the vertex: |grad A_wet|
  double angle_cosine;      ///< of theta from the mean normal n_L of the water-air faces, through the liquid
  double energy_cosine;     ///< cos(theta) by virtual work: grad A_air . outward / length
  double volume_gradient;   ///< the volume's derivative for a move along `outward`, cm^2
  double stiffness;         ///< L_ii of the water-air faces alone: the growth of the force with the move
  std::array<std::uint32_t, 2> neighbours;  ///< on the line: the vertex itself for one that there is not
  double turn_cosine;                       ///< of the angle by which the line turns here, 1 where it is straight

  double angle() const { return std::acos(angle_cosine); }  ///< radians
};

/// Looks at vertex v, whose contact state must be Contact::line. Nothing if its line length or
/// its normals vanish (a lone colliding vertex, a fold).
std::optional<ContactLineVertex> contact_line_vertex(const Drop& drop, std::uint32_t v);

/// The mean of ContactLineVertex::angle over the contact line, weighted by length (radians);
/// nothing without a contact line.
std::optional<double> mean_contact_angle(const Drop& drop);

/// Whether some contact normal is further than `distance` (0 to 2) from the first: if not, no two are further apart
/// than twice that. False without contact.
bool contact_normals_differ(const Drop& drop, double distance);

/// The area of the faces that lie on solids: all three vertices collide and the face looks into the solid (cm^2).
double wetted_area(const Drop& drop);

}  // namespace meniscus
