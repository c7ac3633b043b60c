// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/core/error.h"
#include "meniscus/operators/pressure.h"
#include "recover_step.h"
#include "round_off.h"
#include "step_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

/// A substep is at least this share of the step, whatever it does.
constexpr double least_share = 1.0 / 1024;
/// The start for a substep moves the fastest vertex by this share of edge_min.
constexpr double first_guess = 0.5;
/// The conjugate gradients stop here even if the scene asks for more: what is left is put right at the next
/// substep, and neither free fall nor the volume depends on it.
constexpr double least_tolerance = 1e-4;

PressureOptions pressure_options(const StepOptions& step) {
  PressureOptions options;
  options.gravity = step.gravity;
  options.liquid = step.liquid;
  options.edge_min = step.band.edge_min;
  options.edge_max = step.band.edge_max;
  options.tolerance = std::max(step.solver.tolerance, least_tolerance);
  options.max_iterations = step.solver.max_iterations;
  if (!step.remesh) options.smoothing = 0;
  return options;
}

/// A drop on its way through the step.
struct Traveller {
  Drop drop;
  double left;  ///< s to the end of the step
  double next;  ///< s to try
  int substeps;
};

/// One substep of at most `longest` (s): how long it was.
double substep(Drop& drop, const std::vector<Solid>& solids, double time, double longest, double shortest,
               const StepOptions& options, StageClock& clock, StepReport& report) {
  const PressureOptions pressure = pressure_options(options);
  PressureStep step(drop, solids, time, pressure);
  clock.done(Stage::geometry);
  double dt = longest;
  while (dt > shortest && (dt > step.longest_step() || step.top_speed() * dt > first_guess * pressure.edge_min))
    dt *= 0.5;
  while (!step.solve(dt) && dt > shortest) {
    dt *= 0.5;
    ++report.rejected;
  }
  clock.done(Stage::curvature_flow);
  drop.set_target_volume(drop.target_volume() + drop.inflow() * dt);
  const PressureReport done = step.move();
  report.solver_iterations = std::max(report.solver_iterations, done.iterations);
  report.worst_volume_error = std::max(report.worst_volume_error, std::abs(done.relative_volume_error));
  clock.done(Stage::volume_correction);
  return dt;
}

/// The same; a substep after which the drop is not fit to go on is taken back and tried at half its length.
/// Throws NumericsError when one of `shortest` fails too.
double substep_or_recover(Drop& drop, const std::vector<Solid>& solids, double time, double longest, double shortest,
                          const StepOptions& options, const KeptState& kept, StageClock& clock, StepReport& report) {
  for (;;) {
    std::string wrong;
    double dt = longest;
    try {
      dt = substep(drop, solids, time, longest, shortest, options, clock, report);
      wrong = blow_up(drop, kept.positions());
    } catch (const NumericsError& error) {
      wrong = error.what();
    }
    if (wrong.empty()) return dt;
    kept.restore(drop);
    if (dt <= shortest)
      throw NumericsError(fmt::format("drop {} at {:.6g} s: {}, even in substeps of {:.2g} s; use a smaller time step",
                                      drop.id(), time, wrong, dt));
    ++report.recoveries;
    longest = 0.5 * dt;
  }
}

/// One substep of at most traveller.left. Writes what to try next.
void take_substep(Traveller& traveller, const std::vector<Solid>& solids, double time, double shortest,
                  const StepOptions& options, const KeptState& kept, StageClock& clock, StepReport& report) {
  const double dt =
      substep_or_recover(traveller.drop, solids, time - traveller.left, std::min(traveller.next, traveller.left),
                         shortest, options, kept, clock, report);
  traveller.left -= dt;
  if (traveller.left < 0.5 * shortest) {
    traveller.drop.set_target_volume(traveller.drop.target_volume() + traveller.drop.inflow() * traveller.left);
    traveller.left = 0;
  }
  traveller.next = 2 * dt;
  ++traveller.substeps;
}

/// A speck on a solid of which most vertices were taken back rests there until the next step: it does not get free in
/// shorter substeps either, and they would be of the shortest.
void rest(Traveller& traveller, const std::vector<Solid>& solids, double time) {
  Drop& speck = traveller.drop;
  const Solid& solid = *holder_of(speck, solids);
  speck.positions().colwise() += solid.offset(time) - solid.offset(time - traveller.left);
  speck.velocities().colwise() = solid.velocity(time);
  speck.set_target_volume(speck.target_volume() + speck.inflow() * traveller.left);
  traveller.left = 0;
}

}  // namespace

std::vector<Drop> step_by_pressure(Drop drop, const std::vector<Solid>& solids, double time, double dt,
                                   const StepOptions& options, Remesher& remesher, StepReport& report) {
  StageClock clock(options.clock, report);
  std::vector<Traveller> on_the_way;
  on_the_way.push_back({std::move(drop), dt, dt, 0});
  std::vector<Drop> arrived;
  while (!on_the_way.empty()) {  // pieces arrive in the order in which they split off
    Traveller traveller = std::move(on_the_way.back());
    on_the_way.pop_back();
    if (!(traveller.left > 0)) {
      report.triangles += traveller.drop.mesh().number_of_faces();
      arrived.push_back(std::move(traveller.drop));
      continue;
    }
    KeptState& kept = traveller.drop.workspace().kept;
    kept.keep(traveller.drop);
    const double left_before = traveller.left;
    try {
      take_substep(traveller, solids, time, least_share * dt, options, kept, clock, report);
    } catch (const NumericsError&) {
      if (!has_no_shape(traveller.drop, options.band)) throw;
      ++report.rounded;
      traveller.drop.set_target_volume(traveller.drop.target_volume() + traveller.drop.inflow() * traveller.left);
      arrived.push_back(rounded_off(traveller.drop, solids, time, traveller.left, options.band));
      continue;
    }
    report.substeps = std::max(report.substeps, traveller.substeps);
    const double inflow = traveller.drop.inflow();
    const std::size_t taken_back = report.taken_back;
    std::vector<Drop> pieces =
        remesh_and_split(std::move(traveller.drop), kept.positions(), solids, time - traveller.left,
                         left_before - traveller.left, options, remesher, clock, report);
    keep_inflow(pieces, solids, inflow);
    const bool is_stuck = pieces.size() == 1 && 2 * (report.taken_back - taken_back) >= pieces.front().num_rows() &&
                          is_speck(pieces.front(), options.band) && touches_solid(pieces.front());
    for (auto piece = pieces.rbegin(); piece != pieces.rend(); ++piece)
      on_the_way.push_back({std::move(*piece), traveller.left, traveller.next, traveller.substeps});
    if (is_stuck) rest(on_the_way.back(), solids, time);
  }
  return arrived;
}

}  // namespace meniscus
