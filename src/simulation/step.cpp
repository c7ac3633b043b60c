// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/simulation/step.h"

#include "meniscus/core/error.h"
#include "meniscus/geometry/rigid_motion.h"
#include "meniscus/operators/contact_angle.h"
#include "meniscus/operators/damping.h"
#include "meniscus/operators/external_forces.h"
#include "meniscus/operators/lift_films.h"
#include "meniscus/operators/mean_curvature_flow.h"
#include "meniscus/operators/tangential_damping.h"
#include "meniscus/operators/volume_correction.h"
#include "meniscus/state/contact_line.h"
#include "meniscus/state/free_rigid_motion.h"
#include "meniscus/state/ledger.h"
#include "recover_step.h"
#include "round_off.h"
#include "step_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace meniscus {
namespace {

using Eigen::Vector3d;

/// c = 2 sigma/(rho R), cm^3/s^2: the acceleration that a mean curvature of 1/cm gives a drop whose
/// lowest mode runs at Rayleigh's frequency; R = 3 V/A of the water-air surface.
double tension_over_mass(const Drop& drop, const SurfaceGeometry& geometry, const Liquid& liquid) {
  const double length = 3 * drop.target_volume() / (geometry.area() - wetted_area(drop));
  return 2 * liquid.surface_tension / (liquid.density * length);
}

/// The most by which the flow of a drop in flight is made stronger for what the time step makes it slower.
constexpr double largest_phase_correction = 2;

/// By what factor tension has to be stronger for mode 2 of a ball to keep its frequency omega at the time step dt;
/// phase = omega dt. Backward Euler has the flow of strength q = c dt^2/R^2 act on mode 2 as s = 4 q/(1 + 6 q), for the
/// stiffness of a ball is 4 but the matrix L has 6, and turns the phase by atan(sqrt(s/(1 - s))): 4 q/(1 + 2 q) must be
/// tan^2(phase). That has no solution for large phases: the factor stays at its bound up to a phase of 1 and falls from
/// there, to 1 at sqrt(2), the longest that substeps leave (largest_phase_squared).
double phase_correction(double phase) {
  const double tangent = std::tan(std::min(phase, 0.25 * M_PI));
  const double squared = tangent * tangent;
  return std::min(largest_phase_correction, squared / (phase * phase * (1 - 0.5 * squared)));
}

/// What one step of the flow of a drop takes as tension: in flight corrected for the time step, on a solid as it is,
/// for the contact line must balance with it.
double flow_tension(const Drop& drop, const SurfaceGeometry& geometry, double dt, const StepOptions& step) {
  const double tension = tension_over_mass(drop, geometry, step.liquid);
  if (!(tension > 0) || step.level == Level::paper || touches_solid(drop)) return tension;
  return tension * phase_correction(2 * std::sqrt(tension) * dt / ball_radius(drop));
}

/// From this Weber number rho v^2 D/sigma on, what comes from a source is a jet and no longer drips from it
/// (Clanet and Lasheras 1999: about 4 where gravity matters little).
constexpr double jet_weber = 4;

/// Whether a drop is a jet: some source that it hangs from is running, faster than surface tension can hold back.
/// Its vertices are then in free fall along it. Level::paper knows no Weber number.
bool is_jet(const Drop& drop, const std::vector<Solid>& solids, double time, const StepOptions& step) {
  for (std::size_t s = 0; s < solids.size(); ++s) {
    const Solid& solid = solids[s];
    if (!solid.inflow || !hangs_from(drop, static_cast<std::int32_t>(s))) continue;
    const double speed = solid.inflow->speed_at(time), diameter = 2 * solid.inflow->radius;
    if (speed == 0) continue;
    if (step.level == Level::paper) return true;
    if (step.liquid.density * speed * speed * diameter > jet_weber * step.liquid.surface_tension) return true;
  }
  return false;
}

/// Whether gravity acts as a pressure: on a drop that a solid holds. In flight, in a jet, and in Level::paper,
/// it moves the vertices instead.
bool gravity_is_pressure(const Drop& drop, bool jet, const StepOptions& step) {
  return step.level != Level::paper && step.liquid.surface_tension > 0 && !jet && touches_solid(drop);
}

/// What holds against the curvature at rest.
BodyPressure body_pressure(const Drop& drop, const SurfaceGeometry& geometry, bool jet, const StepOptions& step) {
  BodyPressure pressure;
  if (step.level == Level::paper) return pressure;
  if (gravity_is_pressure(drop, jet, step)) {
    pressure.gradient = step.liquid.density / step.liquid.surface_tension * step.gravity;
    pressure.center = drop.positions().col(0);
  }
  pressure.mean = mean_pressure(drop, geometry, pressure);
  return pressure;
}

ExternalForcesOptions external_forces_options(const Drop& drop, bool jet, const StepOptions& step) {
  ExternalForcesOptions options;
  options.gravity = gravity_is_pressure(drop, jet, step) ? Vector3d(Vector3d::Zero()) : step.gravity;
  options.friction_per_step = step.level == Level::paper;
  options.no_slip = step.level != Level::paper;
  options.longest_edge = step.band.edge_max;
  return options;
}

/// Lamb's decay by mu >= 0 and eta: a velocity damping rate b gives the amplitude the rate b/2, and
/// eta = 2.456 nu fits b to twice (n - 1)(2 n + 1) nu/R^2 for modes 2 to 8.
constexpr double viscosity_to_eta = 2.456;

DampingOptions damping_options(const StepOptions& step) {
  DampingOptions options;
  options.solver = step.solver;
  if (step.level == Level::paper) {
    options.damping_rate = step.paper.damping_rate;
    options.viscosity_coefficient = step.paper.viscosity_coefficient;
  }  // else viscosity is part of the flow
  return options;
}

/// At Level::calibrated the flow's solver stops here even if the scene asks for more: the motion is then off by less
/// than 1e-5 of its amplitude (bench_tolerance), far less than the model is.
constexpr double least_flow_tolerance = 1e-4;

MeanCurvatureFlowOptions flow_options(const StepOptions& step, const BodyPressure& pressure, double tension,
                                      const RigidMotion& rigid, double dt) {
  MeanCurvatureFlowOptions options;
  options.solver = step.solver;
  if (step.level == Level::paper) {
    options.coefficient = step.paper.curvature_flow_coefficient;
    options.clamp_negative_weights = false;
  } else {
    options.coefficient = tension * dt;
    options.body_pressure = pressure;
    options.viscosity = viscosity_to_eta * step.liquid.viscosity;
    options.rotation = rigid.rotation;
    options.solver.tolerance = std::max(step.solver.tolerance, least_flow_tolerance);
  }
  return options;
}

/// xi, g/(cm s): what a moving contact line of water on smooth solids meets, in order of magnitude.
constexpr double contact_line_friction = 1;

ContactAngleOptions contact_angle_options(const StepOptions& step, const BodyPressure& pressure, double tension) {
  ContactAngleOptions options;
  options.force = step.level == Level::paper ? ContactForce::measured_angle : ContactForce::virtual_work;
  options.boundary_force = step.paper.boundary_force;
  options.tension_over_mass = tension;
  options.body_pressure = pressure;
  if (step.liquid.surface_tension > 0)
    options.line_friction_over_mass = contact_line_friction * tension / step.liquid.surface_tension;
  return options;
}

/// The most that one volume correction may offset the surface, as a share of the ball's radius.
constexpr double largest_offset = 0.25;

VolumeCorrectionOptions volume_options(const StepOptions& step, const Drop& drop) {
  VolumeCorrectionOptions options;
  options.method = step.volume_correction;
  options.local = step.level == Level::paper ? LocalCorrection::smooth_velocity : LocalCorrection::local_pressure;
  options.solver = step.solver;
  options.solver.tolerance = std::max(options.solver.tolerance, 1e-3);  // what it leaves is the global part's
  options.offset_limit = largest_offset * ball_radius(drop);
  return options;
}

/// At most this much of a drop's lowest mode's phase, sqrt(2), passes in one substep of Level::calibrated:
/// (omega dt)^2 = 4 c dt^2/R^2 <= 2. Beyond, one implicit step of the flow would shrink the drop by half.
constexpr double largest_phase_squared = 2;
/// Beyond this relative error of the volume a run has failed.
constexpr double largest_volume_error = 2;

/// How far a drop's fastest vertex may get within dt, cm.
double reach_of_step(const Drop& drop, const Vector3d& gravity, double dt) {
  return (top_speed(drop) + gravity.norm() * dt) * dt;
}

/// Whether a solid may meet within dt what is in the box and moves by at most `reach` (cm).
bool may_meet_solid(const Eigen::AlignedBox3d& box, double reach, const std::vector<Solid>& solids, double time,
                    double dt) {
  return std::any_of(solids.begin(), solids.end(), [&](const Solid& solid) {
    return solid.is_near(box, time, reach + solid.velocity(time).norm() * dt);
  });
}

/// How many substeps keep a step of this drop within the limits above.
int num_substeps(const Drop& drop, const std::vector<Solid>& solids, double time, double dt,
                 const StepOptions& options) {
  const Eigen::AlignedBox3d box = bounding_box(drop);
  if (box.isEmpty()) return 1;
  const double length = ball_radius(drop);
  const double move = reach_of_step(drop, options.gravity, dt);
  const bool near = may_meet_solid(box, move, solids, time, dt);
  double substeps = near ? std::max(1.0, move / (largest_move * length)) : 1;
  if (options.level != Level::paper) {
    const double sqrt_c = std::sqrt(2 * options.liquid.surface_tension / (options.liquid.density * length));
    substeps = std::max(substeps, std::sqrt(4 / largest_phase_squared) * sqrt_c * dt / length);
    // Near a solid sqrt(c) dt is at most the middle of the edge band: beyond, the contact line and the surface beside
    // it move past each other within a substep, and the wetted area folds.
    if (near) substeps = std::max(substeps, sqrt_c * dt / (0.5 * (options.band.edge_min + options.band.edge_max)));
  }
  return static_cast<int>(std::ceil(std::min(substeps, static_cast<double>(most_substeps))));
}

/// Films lower than this (in lengths of edge_min) come down no further and have no volume to give.
constexpr double low_film = 0.05;

/// Above the drop's own wetted area, what it was above at the start of the substep.
void keep_films(Drop& drop, const std::vector<Solid>& solids, double time, const StepOptions& options) {
  const ConstColumns start = drop.workspace().kept.positions();
  stop_at_discs(drop, solids, time, [&](std::uint32_t v) -> Vector3d { return start.col(v); });
  lift_films(drop, solids, time, low_film * options.band.edge_min);
}

/// The mean place (cm) and velocity (cm/s) of a drop's vertices.
struct Means {
  Vector3d place, velocity;
};

Means means_of(const Drop& drop) {
  return {mean_over_vertices(drop, drop.positions()), mean_over_vertices(drop, drop.velocities())};
}

/// About a speck neither areas nor what the volume's correction moves balance, and it would drive itself.
void restore_means(Drop& speck, const Means& means) {
  const Means now = means_of(speck);
  speck.positions().colwise() += means.place - now.place;
  speck.velocities().colwise() += means.velocity - now.velocity;
}

/// All of a ball's surface energy would move its liquid at sqrt(6 sigma/(rho R)). A speck of which a vertex is so many
/// times as fast is no drop that oscillates: its few faces drive themselves, and it keeps its mean motion alone.
constexpr double most_speck_speed = 4;

void calm_speck(Drop& speck, const Vector3d& mean, const Liquid& liquid) {
  const double energy_speed = std::sqrt(6 * liquid.surface_tension / (liquid.density * ball_radius(speck)));
  if (liquid.surface_tension > 0 && top_speed(speck, mean) > most_speck_speed * energy_speed)
    speck.velocities().colwise() = mean;
}

/// The operators of one substep, in the order of the paper's Figure 1. Returns by what share of the target the volume
/// was off before its correction.
double deform(Drop& drop, const std::vector<Solid>& solids, double time, double dt, const StepOptions& options,
              StepReport& report) {
  StageClock clock(options.clock, report);
  drop.workspace().films.clear();
  const bool jet = is_jet(drop, solids, time, options);
  const ExternalForcesReport forces =
      apply_external_forces(drop, solids, time, dt, external_forces_options(drop, jet, options));
  std::optional<Means> in_flight;
  if (!jet && forces.colliding == 0 && is_speck(drop, options.band)) in_flight = means_of(drop);
  clock.done(Stage::external_forces);

  SurfaceGeometry& geometry = drop.workspace().geometry;
  geometry.compute(std::as_const(drop).positions(), drop.connectivity());
  const double tension = flow_tension(drop, geometry, dt, options);
  const BodyPressure pressure = body_pressure(drop, geometry, jet, options);
  clock.done(Stage::geometry);

  apply_damping(drop, geometry, dt, damping_options(options));
  const RigidMotion rigid = free_rigid_motion(drop, geometry);
  clock.done(Stage::damping);

  // The paper moves the contact line after the flow; there the surface stands back by what the volume
  // correction will give it again, and the angle is off by as much: the line moves before.
  if (forces.colliding > 0)
    apply_contact_angle(drop, solids, geometry, time, dt, contact_angle_options(options, pressure, tension));
  else
    report.skip(Stage::contact_angle);
  clock.done(Stage::contact_angle);

  const SolveReport flow =
      flow_by_mean_curvature(drop, geometry, dt, flow_options(options, pressure, tension, rigid, dt));
  report.solver_iterations = std::max(report.solver_iterations, flow.iterations);
  clock.done(Stage::curvature_flow);

  // The flow leaves the momentum of a drop in flight alone, not the line's motion.
  if (!jet)
    remove_tangential_deformation(drop, geometry, forces.colliding > 0 ? free_rigid_motion(drop, geometry) : rigid, dt);
  clock.done(Stage::damping);

  // What lifting films adds is taken from elsewhere, and what sank in by that is lifted for good.
  if (forces.colliding > 0) keep_films(drop, solids, time, options);
  const VolumeCorrectionReport volume = correct_volume(drop, geometry, dt, volume_options(options, drop));
  if (in_flight) {
    restore_means(drop, *in_flight);
    calm_speck(drop, in_flight->velocity, options.liquid);
  }
  report.limited_volume += volume.limited;
  if (!std::isnan(volume.relative_error))
    report.worst_volume_error = std::max(report.worst_volume_error, std::abs(volume.relative_error));
  if (std::abs(volume.relative_error) > largest_volume_error)
    throw NumericsError(fmt::format("drop {}: the surface turned over: its volume is {:.2g} times what it ought to be",
                                    drop.id(), 1 + volume.relative_error));
  clock.done(Stage::volume_correction);

  if (forces.colliding > 0) keep_films(drop, solids, time, options);
  if (options.volume_correction == VolumeCorrectionMethod::none) report.skip(Stage::volume_correction);
  return volume.relative_error_before;
}

/// One substep: operators, remesh, split. As step_in_place.
bool substep(Drop& drop, std::vector<Drop>& cut_off, const std::vector<Solid>& solids, double time, double dt,
             const StepOptions& options, Remesher& remesher, StepReport& report) {
  const auto move = [&](Drop& moving, double to, double step, const StepOptions& at, StepReport& sum) {
    return deform(moving, solids, to, step, at, sum);
  };
  try {
    deform_or_recover(drop, time, dt, options, report, move);
  } catch (const NumericsError&) {
    if (!may_be_rounded_off(drop, options.band)) throw;
    ++report.rounded;
    drop = rounded_off(drop, solids, time, dt, options.band);
    return true;
  }
  StageClock clock(options.clock, report);
  const int id = drop.id();
  const double volume = options.level == Level::paper ? drop.volume() : 0;
  const ConstColumns before = drop.workspace().kept.positions();
  const bool goes_on = remesh_and_split(drop, cut_off, before, solids, time, dt, options, remesher, clock, report);
  if (options.level == Level::paper && goes_on) check_not_crumpled(drop, cut_off, volume, id);
  return goes_on;
}

/// The drop, if it is there, and the pieces that were cut off it, in one list.
std::vector<Drop> all_pieces(bool is_there, Drop& drop, std::vector<Drop> cut_off) {
  if (is_there) cut_off.insert(cut_off.begin(), std::move(drop));
  return cut_off;
}

/// step_in_place of the other levels, but for the momentum of drops in flight.
bool step_by_operators(Drop& drop, std::vector<Drop>& cut_off, const std::vector<Solid>& solids, double time, double dt,
                       const StepOptions& options, Remesher& remesher, StepReport& report) {
  int left = num_substeps(drop, solids, time, dt, options);
  report.substeps = std::max(report.substeps, left);
  const double part = dt / left, inflow = drop.inflow();
  std::vector<Drop> others;
  while (left > 0 && others.empty()) {
    --left;
    drop.set_target_volume(drop.target_volume() + inflow * part);
    if (!substep(drop, others, solids, time - left * part, part, options, remesher, report)) return false;
  }
  if (others.empty()) {
    drop.set_inflow(inflow);  // a fold that was united made a new drop
    report.triangles += drop.mesh().number_of_faces();
    return true;
  }
  std::vector<Drop> pieces = all_pieces(true, drop, std::move(others));
  keep_inflow(pieces, solids, inflow);
  if (left == 0) {
    for (const Drop& piece : pieces) report.triangles += piece.mesh().number_of_faces();
    return replace_by_pieces(drop, cut_off, std::move(pieces));
  }
  std::vector<Drop> all;  // a small piece needs shorter substeps than what it came from
  for (Drop& piece : pieces)
    for (Drop& part_of_it : step_drop(std::move(piece), solids, time, left * part, options, remesher, report))
      all.push_back(std::move(part_of_it));
  return replace_by_pieces(drop, cut_off, std::move(all));
}

/// Whether no solid can touch a drop within dt.
bool is_in_flight(const Drop& drop, const std::vector<Solid>& solids, double time, double dt, const Vector3d& gravity) {
  if (touches_solid(drop)) return false;
  return solids.empty() || !may_meet_solid(bounding_box(drop), reach_of_step(drop, gravity, dt), solids, time, dt);
}

}  // namespace

bool step_in_place(Drop& drop, std::vector<Drop>& cut_off, const std::vector<Solid>& solids, double time, double dt,
                   const StepOptions& options, Remesher& remesher, StepReport& report) {
  if (options.level == Level::pressure)
    return step_by_pressure(drop, cut_off, solids, time, dt, options, remesher, report);
  if (options.level == Level::paper || !is_in_flight(drop, solids, time, dt, options.gravity))
    return step_by_operators(drop, cut_off, solids, time, dt, options, remesher, report);
  const MeanMotion before = mean_motion(drop);
  const std::size_t first = cut_off.size();
  const bool goes_on = step_by_operators(drop, cut_off, solids, time, dt, options, remesher, report);
  restore_velocity(goes_on ? &drop : nullptr, cut_off, first, before.velocity + dt * options.gravity);
  return goes_on;
}

std::vector<Drop> step_drop(Drop drop, const std::vector<Solid>& solids, double time, double dt,
                            const StepOptions& options, Remesher& remesher, StepReport& report) {
  std::vector<Drop> cut_off;
  const bool goes_on = step_in_place(drop, cut_off, solids, time, dt, options, remesher, report);
  return all_pieces(goes_on, drop, std::move(cut_off));
}

}  // namespace meniscus
