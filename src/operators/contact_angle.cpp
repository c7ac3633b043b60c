// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/operators/contact_angle.h"

#include "meniscus/operators/collision_constraint.h"

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

using Eigen::Vector3d;

/// Eq 8 as written, at one vertex. Returns the change of velocity.
Vector3d measured_angle_kick(const ContactLineVertex& line, double receding, double advancing, double alpha) {
  if (line.angle < receding) return alpha * (line.angle - receding) * line.outward;
  if (line.angle > advancing) return alpha * (line.angle - advancing) * line.outward;
  return Vector3d::Zero();
}

/// The energy gradient that drives the line (cm, positive outward), zero between the two angles.
/// `pressure` is the drop's, over sigma (1/cm): it pushes on the line vertex's share of the surface.
double unbalanced_length(const ContactLineVertex& line, const Solid& solid, double pressure) {
  const double cosine = line.energy_cosine - pressure * line.volume_gradient / line.length;
  const double cos_advancing = std::cos(solid.advancing_angle), cos_receding = std::cos(solid.receding_angle);
  if (cosine < cos_advancing) return line.length * (cos_advancing - cosine);
  if (cosine > cos_receding) return line.length * (cos_receding - cosine);
  return 0;
}

/// The change of the line vertex's velocity by virtual work: it sticks, or it is pushed against friction,
/// (M + dt xi l + dt^2 c L_ii) v_new = M v + dt c f along the line's normal.
Vector3d virtual_work_kick(const ContactLineVertex& line, double force, const Vector3d& slip, double mass, double dt,
                           const ContactAngleOptions& options) {
  if (force == 0) return -slip;
  const double c = options.tension_over_mass, along = slip.dot(line.outward);
  const double resistance = mass + dt * options.line_friction_over_mass * line.length + dt * dt * c * line.stiffness;
  return ((mass * along + dt * c * force) / resistance - along) * line.outward;
}

}  // namespace

ContactAngleReport apply_contact_angle(Drop& drop, const std::vector<Solid>& solids, const SurfaceGeometry& geometry,
                                       double time, double dt, const ContactAngleOptions& options) {
  ContactAngleReport report;
  const Contact* contact = drop.contact();
  const auto n = static_cast<std::uint32_t>(drop.num_rows());
  std::vector<Vector3d>& kick = drop.workspace().vectors;  // all from the same state, so that order does not matter
  kick.resize(n);
  for (std::uint32_t v = 0; v < n; ++v) {
    if (contact[v] != Contact::line) continue;
    kick[v].setZero();
    ++report.line;
    const auto line = contact_line_vertex(drop, v);
    if (!line) continue;
    const Solid& solid = solids[drop.contact_solid()[v]];
    if (options.force == ContactForce::measured_angle) {
      kick[v] = measured_angle_kick(*line, solid.receding_angle, solid.advancing_angle, options.boundary_force);
      report.advancing += line->angle > solid.advancing_angle;
      report.receding += line->angle < solid.receding_angle;
    } else {
      const double force = unbalanced_length(*line, solid, options.body_pressure.at(drop.positions().col(v)));
      const Vector3d slip = drop.velocities().col(v) - solid.velocity(time);
      kick[v] = virtual_work_kick(*line, force, slip, geometry.lumped_area(v), dt, options);
      report.advancing += force > 0;
      report.receding += force < 0;
    }
  }
  if (report.line == 0) return report;
  Columns x = drop.positions(), velocity = drop.velocities();
  for (std::uint32_t v = 0; v < n; ++v) {
    if (contact[v] != Contact::line) continue;
    const Vector3d change = constrain_to_solid(drop, v, kick[v]);
    velocity.col(v) += change;
    x.col(v) += change * dt;
  }
  return report;
}

}  // namespace meniscus
