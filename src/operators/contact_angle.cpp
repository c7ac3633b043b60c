// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/operators/contact_angle.h"

#include "meniscus/operators/collision_constraint.h"
#include "within_triangle.h"

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

using Eigen::Vector3d;

constexpr double pi = 3.14159265358979323846;

/// Eq 8 as written, at one vertex. Returns the change of velocity.
Vector3d measured_angle_kick(const ContactLineVertex& line, double receding, double advancing, double alpha) {
  const double angle = line.angle();
  if (angle < receding) return alpha * (angle - receding) * line.outward;
  if (angle > advancing) return alpha * (angle - advancing) * line.outward;
  return Vector3d::Zero();
}

/// What all vertices on a solid share.
struct SolidAngles {
  double cos_advancing, cos_receding;
  Vector3d velocity;
};

/// The energy gradient that drives the line (cm, positive outward), zero between the two angles.
/// `pressure` is the drop's, over sigma (1/cm): it pushes on the line vertex's share of the surface.
double unbalanced_length(const ContactLineVertex& line, const SolidAngles& angles, double pressure) {
  const double cosine = line.energy_cosine - pressure * line.volume_gradient / line.length;
  if (cosine < angles.cos_advancing) return line.length * (angles.cos_advancing - cosine);
  if (cosine > angles.cos_receding) return line.length * (angles.cos_receding - cosine);
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

/// The line turns by no more than this at a vertex, or by three times what a polygon of its number of vertices does.
double largest_turn(std::size_t num_line) {
  return std::max(pi / 2, num_line > 0 ? 6 * pi / static_cast<double>(num_line) : pi);
}

/// Where the line turns too sharply.
struct SharpTurn {
  std::uint32_t vertex;
  std::array<std::uint32_t, 2> neighbours;
};

/// There the vertex goes half way to the middle of its neighbours, stuck or not: one that stuck while they moved on
/// would stay behind for good, and the line crumple. The line passes over none of its other vertices, or two parts of
/// it that face each other would change sides.
Vector3d straightening_move(const Drop& drop, const SharpTurn& turn, const std::vector<std::uint32_t>& line) {
  constexpr int most_halvings = 4;
  const ConstColumns x = drop.positions();
  const std::uint32_t v = turn.vertex, first = turn.neighbours[0], second = turn.neighbours[1];
  const Vector3d p = x.col(v), a = x.col(first), b = x.col(second), n = drop.contact_normals().col(v);
  Vector3d move = constrain_to_solid(drop, v, 0.5 * (0.5 * (a + b) - p));
  const auto passes_over = [&](std::uint32_t w) {
    const Vector3d q = x.col(w);
    return w != v && w != first && w != second && (is_within(q, a, p, p + move, n) || is_within(q, b, p, p + move, n));
  };
  for (int halving = 0; halving < most_halvings; ++halving, move *= 0.5)
    if (std::none_of(line.begin(), line.end(), passes_over)) return move;
  return Vector3d::Zero();
}

}  // namespace

ContactAngleReport apply_contact_angle(Drop& drop, const std::vector<Solid>& solids, const SurfaceGeometry& geometry,
                                       double time, double dt, const ContactAngleOptions& options) {
  ContactAngleReport report;
  const Contact* contact = drop.contact();
  const auto n = static_cast<std::uint32_t>(drop.num_rows());
  std::vector<Vector3d>& kick = drop.workspace().vectors;  // all from the same state, so that order does not matter
  kick.resize(n);
  std::vector<std::uint32_t>& line_vertices = drop.workspace().line;
  line_vertices.clear();
  for (std::uint32_t v = 0; v < n; ++v)
    if (contact[v] == Contact::line) line_vertices.push_back(v);
  report.line = line_vertices.size();
  if (line_vertices.empty()) return report;
  const double cos_sharp_turn = std::cos(std::min(largest_turn(report.line), pi));
  std::int32_t last_solid = -1;
  SolidAngles angles{0, 0, Vector3d::Zero()};
  std::vector<SharpTurn> sharp;
  for (const std::uint32_t v : line_vertices) {
    kick[v].setZero();
    const std::int32_t s = drop.contact_solid()[v];
    const Solid& solid = solids[s];
    if (s != last_solid)
      angles = {std::cos(solid.advancing_angle), std::cos(solid.receding_angle), solid.velocity(time)};
    last_solid = s;
    const auto line = solid.inflow ? std::nullopt : contact_line_vertex(drop, v);
    if (!line) continue;
    if (options.force == ContactForce::measured_angle) {
      kick[v] = measured_angle_kick(*line, solid.receding_angle, solid.advancing_angle, options.boundary_force);
      report.advancing += line->angle() > solid.advancing_angle;
      report.receding += line->angle() < solid.receding_angle;
    } else {
      const double force = unbalanced_length(*line, angles, options.body_pressure.at(drop.positions().col(v)));
      const Vector3d slip = drop.velocities().col(v) - angles.velocity;
      kick[v] = virtual_work_kick(*line, force, slip, geometry.lumped_area(v), dt, options);
      report.advancing += force > 0;
      report.receding += force < 0;
      if (line->turn_cosine < cos_sharp_turn) sharp.push_back({v, line->neighbours});
    }
  }
  Columns x = drop.positions(), velocity = drop.velocities();
  for (const std::uint32_t v : line_vertices) {
    const Vector3d change = constrain_to_solid(drop, v, kick[v]);
    velocity.col(v) += change;
    x.col(v) += change * dt;
  }
  std::vector<Vector3d> moves;
  for (const SharpTurn& turn : sharp) moves.push_back(straightening_move(drop, turn, line_vertices));
  for (std::size_t k = 0; k < sharp.size(); ++k) x.col(sharp[k].vertex) += moves[k];
  report.straightened = sharp.size();
  return report;
}

}  // namespace meniscus
