// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/core/error.h"
#include "meniscus/operators/pressure.h"
#include "meniscus/simulation/merge_touching.h"
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

/// How far a drop is on its way through the step.
struct Way {
  double left;                                ///< s to the end of the step
  double next;                                ///< s to try
  std::optional<Eigen::Vector3d> velocity{};  ///< with which its centre of mass flies on; none on a solid
  int substeps = 0;
  bool is_calmed = false;  ///< see calm_newly_torn
};

/// One substep of at most `longest` (s): how long it was. Carries `velocity` on, if there is one.
double substep(Drop& drop, std::optional<Eigen::Vector3d>& velocity, const std::vector<Solid>& solids, double time,
               double longest, double shortest, const StepOptions& options, StageClock& clock, StepReport& report) {
  PressureOptions pressure = pressure_options(options);
  pressure.velocity = velocity;
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
  if (velocity) velocity = done.velocity;
  report.solver_iterations = std::max(report.solver_iterations, done.iterations);
  report.worst_volume_error = std::max(report.worst_volume_error, std::abs(done.relative_volume_error));
  clock.done(Stage::volume_correction);
  return dt;
}

/// The same; a substep after which the drop is not fit to go on is taken back and tried at half its length.
/// Throws NumericsError when one of `shortest` fails too.
double substep_or_recover(Drop& drop, std::optional<Eigen::Vector3d>& velocity, const std::vector<Solid>& solids,
                          double time, double longest, double shortest, const StepOptions& options,
                          const KeptState& kept, StageClock& clock, StepReport& report) {
  const std::optional<Eigen::Vector3d> velocity_before = velocity;
  for (;;) {
    std::string wrong;
    double dt = longest;
    try {
      dt = substep(drop, velocity, solids, time, longest, shortest, options, clock, report);
      wrong = blow_up(drop, kept);
    } catch (const NumericsError& error) {
      wrong = error.what();
    }
    if (wrong.empty()) return dt;
    kept.restore(drop);
    velocity = velocity_before;
    if (dt <= shortest)
      throw NumericsError(fmt::format("drop {} at {:.6g} s: {}, even in substeps of {:.2g} s; use a smaller time step",
                                      drop.id(), time, wrong, dt));
    ++report.recoveries;
    longest = 0.5 * dt;
  }
}

/// One substep of at most way.left. Writes what to try next.
void take_substep(Drop& drop, Way& way, const std::vector<Solid>& solids, double time, double shortest,
                  const StepOptions& options, const KeptState& kept, StageClock& clock, StepReport& report) {
  const double dt = substep_or_recover(drop, way.velocity, solids, time - way.left, std::min(way.next, way.left),
                                       shortest, options, kept, clock, report);
  way.left -= dt;
  if (way.left < 0.5 * shortest) {
    drop.set_target_volume(drop.target_volume() + drop.inflow() * way.left);
    way.left = 0;
  }
  way.next = 2 * dt;
  ++way.substeps;
}

/// A speck on a solid of which most vertices were taken back rests there until the next step: it does not get free in
/// shorter substeps either, and they would be of the shortest.
void rest(Drop& speck, Way& way, const std::vector<Solid>& solids, double time) {
  const Solid& solid = *holder_of(speck, solids);
  speck.positions().colwise() += solid.offset(time) - solid.offset(time - way.left);
  speck.velocities().colwise() = solid.velocity(time);
  speck.set_target_volume(speck.target_volume() + speck.inflow() * way.left);
  speck.set_slack(0);
  way.left = 0;
}

/// With what velocity a drop sets out on a substep.
void set_out(const Drop& drop, Way& way) {
  if (touches_solid(drop))
    way.velocity.reset();
  else if (!way.velocity)
    way.velocity = mean_motion(drop).velocity;
}

/// What a drop in flight became at the end of its way has that velocity, whatever its surface says.
void arrive(Drop& drop, std::vector<Drop>& cut_off, const Way& way) {
  if (!way.velocity || touches_solid(drop) || std::any_of(cut_off.begin(), cut_off.end(), touches_solid)) return;
  restore_velocity(&drop, cut_off, 0, *way.velocity);
}

/// A piece that was torn off in this very step and that no substep is short enough for goes on with its mean motion:
/// the violent motion of the neck that it was torn from is no motion of its own. Once: returns whether it did.
bool calm_newly_torn(Drop& piece, Way& way) {
  if (piece.id() != no_id || way.is_calmed) return false;
  const Eigen::Vector3d mean = mean_over_vertices(piece, piece.velocities());
  piece.velocities().colwise() = mean;
  way.is_calmed = true;
  return true;
}

/// Takes a drop to the end of the step of dt, or until something is cut off it: that lies in `cut_off` then. Returns
/// whether the drop goes on.
bool travel(Drop& drop, Way& way, std::vector<Drop>& cut_off, const std::vector<Solid>& solids, double time, double dt,
            const StepOptions& options, Remesher& remesher, StageClock& clock, StepReport& report) {
  while (way.left > 0 && cut_off.empty()) {
    KeptState& kept = drop.workspace().kept;
    kept.keep(drop);
    set_out(drop, way);
    const double left_before = way.left, inflow = drop.inflow();
    try {
      take_substep(drop, way, solids, time, least_share * dt, options, kept, clock, report);
    } catch (const NumericsError&) {
      if (!may_be_rounded_off(drop, options.band)) {
        if (!calm_newly_torn(drop, way)) throw;
        way.next = way.left;
        continue;
      }
      ++report.rounded;
      drop.set_target_volume(drop.target_volume() + drop.inflow() * way.left);
      drop = rounded_off(drop, solids, time, way.left, options.band);
      if (way.velocity) drop.velocities().colwise() = *way.velocity + way.left * options.gravity;
      way.left = 0;
      return true;
    }
    report.substeps = std::max(report.substeps, way.substeps);
    const std::size_t taken_back = report.taken_back;
    if (!remesh_and_split(drop, cut_off, kept.positions(), solids, time - way.left, left_before - way.left, options,
                          remesher, clock, report))
      return false;
    drop.set_inflow(inflow);  // a fold that was united made a new drop
    const bool is_stuck = cut_off.empty() && 2 * (report.taken_back - taken_back) >= drop.num_rows() &&
                          is_speck(drop, options.band) && touches_solid(drop);
    if (is_stuck) rest(drop, way, solids, time);
  }
  arrive(drop, cut_off, way);
  if (cut_off.empty()) report.triangles += drop.mesh().number_of_faces();
  return true;
}

/// A drop and the rest of its way.
struct Traveller {
  Drop drop;
  Way way;
};

/// Puts what a drop became on the way, so that the first of it comes first.
void send_pieces(Drop& drop, std::vector<Drop>& cut_off, Way way, double inflow, const std::vector<Solid>& solids,
                 std::vector<Traveller>& on_the_way) {
  way.velocity.reset();  // each has its own
  way.is_calmed = false;
  cut_off.insert(cut_off.begin(), std::move(drop));
  keep_inflow(cut_off, solids, inflow);
  for (auto piece = cut_off.rbegin(); piece != cut_off.rend(); ++piece) on_the_way.push_back({std::move(*piece), way});
}

}  // namespace

bool step_by_pressure(Drop& drop, std::vector<Drop>& cut_off, const std::vector<Solid>& solids, double time, double dt,
                      const StepOptions& options, Remesher& remesher, StepReport& report) {
  StageClock clock(options.clock, report);
  Way way{dt, dt};
  double inflow = drop.inflow();
  std::vector<Drop> pieces;
  if (!travel(drop, way, pieces, solids, time, dt, options, remesher, clock, report)) return false;
  if (pieces.empty()) return true;
  std::vector<Traveller> on_the_way;
  std::vector<Drop> arrived;
  send_pieces(drop, pieces, way, inflow, solids, on_the_way);
  while (!on_the_way.empty()) {  // pieces arrive in the order in which they split off
    Traveller next = std::move(on_the_way.back());
    on_the_way.pop_back();
    inflow = next.drop.inflow();
    pieces.clear();
    if (!travel(next.drop, next.way, pieces, solids, time, dt, options, remesher, clock, report)) continue;
    if (pieces.empty())
      arrived.push_back(std::move(next.drop));
    else
      send_pieces(next.drop, pieces, next.way, inflow, solids, on_the_way);
  }
  return replace_by_pieces(drop, cut_off, std::move(arrived));
}

}  // namespace meniscus
