// SPDX-License-Identifier: GPL-3.0-or-later
#include "recover_step.h"

#include "meniscus/core/error.h"
#include "meniscus/topology/face_changes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

constexpr double most_turned = 0.05;        // share of the surface
constexpr double most_growth = 2;           // of the surface
constexpr double most_volume_change = 0.5;  // of the target, away from it
constexpr int most_halvings = 6;
/// A substep that stretches a drop so much that the correction has to take more than this share of its volume is too
/// long for what the drop does; after so many halvings it has to do.
constexpr double most_corrected = 0.2;
constexpr int most_rough_halvings = 3;

/// Mending and remeshing a drop of so many faces that is not crumpled changes its volume by far less than this.
constexpr std::size_t least_faces = 200;
constexpr double most_remeshed_volume = 0.05;

StepOptions at_half_step(StepOptions options) {
  options.paper.curvature_flow_coefficient *= 0.5;
  options.paper.boundary_force *= 0.5;
  return options;
}

/// One try: why it failed, or "".
std::string attempt(Drop& drop, double time, double dt, const StepOptions& options, StepReport& report,
                    const Deform& deform, const KeptState& kept, bool may_be_rough) {
  try {
    const double correction = deform(drop, time, dt, options, report);
    if (!may_be_rough && std::abs(correction) > most_corrected)
      return fmt::format("the volume went off by {:.0f} % before its correction", 100 * correction);
  } catch (const NumericsError& error) {
    return error.what();
  }
  return blow_up(drop, kept);
}

/// Whether a drop is where it was, but for its slack, when a look at its faces found nothing. Draws what moved since
/// `kept` from the slack.
bool is_as_last_seen(Drop& drop, const KeptState& kept) {
  const double slack = drop.slack();
  drop.set_slack(0);
  if (!(slack > 0) || !drop.workspace().films.empty() || !kept.has_contact_of(drop)) return false;
  drop.set_slack(std::max(0.0, slack - kept.moved(drop, slack)));
  return drop.slack() > 0 && drop.velocities().allFinite();
}

/// `kept` is the drop as it is.
void recurse(Drop& drop, double time, double dt, const StepOptions& options, StepReport& report, const Deform& deform,
             const KeptState& kept, int halvings) {
  StepReport tried = report;
  // What a source adds is no stretching.
  const bool may_be_rough = options.level == Level::paper || halvings >= most_rough_halvings || drop.inflow() != 0;
  const std::string wrong = attempt(drop, time, dt, options, tried, deform, kept, may_be_rough);
  if (wrong.empty()) {
    report = tried;
    return;
  }
  kept.restore(drop);
  if (halvings == most_halvings)
    throw NumericsError(
        fmt::format("drop {} at {:.6g} s: {}, even in substeps of {:.2g} s; use a smaller time step, "
                    "or a level that holds there (docs/MODELS.md)",
                    drop.id(), time, wrong, dt));
  ++report.recoveries;
  const StepOptions half = at_half_step(options);
  recurse(drop, time - 0.5 * dt, 0.5 * dt, half, report, deform, kept, halvings + 1);
  KeptState halfway;
  halfway.keep(drop);
  recurse(drop, time, 0.5 * dt, half, report, deform, halfway, halvings + 1);
}

}  // namespace

std::string blow_up(Drop& drop, const KeptState& kept) {
  if (is_as_last_seen(drop, kept)) {
    drop.workspace().violent_faces.clear();
    return {};
  }
  const FaceChanges changes = find_face_changes(drop, kept.positions(), drop.workspace().violent_faces);
  if (!std::isfinite(changes.volume) || !drop.velocities().allFinite()) return "a position or velocity is not finite";
  if (changes.turned_area > most_turned * changes.area)
    return fmt::format("{:.0f} % of the surface turned over", 100 * changes.turned_area / changes.area);
  if (changes.area > most_growth * changes.area_before)
    return fmt::format("the surface grew {:.2g} times", changes.area / changes.area_before);
  const double target = drop.target_volume();
  const double off = (std::abs(changes.volume - target) - std::abs(changes.volume_before - target)) / target;
  if (off > most_volume_change) return fmt::format("the volume went off by {:.0f} %", 100 * off);
  return {};
}

void check_not_crumpled(const Drop& drop, const std::vector<Drop>& cut_off, double volume_before, int id) {
  if (touches_solid(drop)) return;
  double volume = drop.volume();
  std::size_t faces = drop.mesh().number_of_faces();
  for (const Drop& piece : cut_off) {
    if (touches_solid(piece)) return;
    volume += piece.volume();
    faces += piece.mesh().number_of_faces();
  }
  const double change = volume / volume_before - 1;
  if (faces >= least_faces && std::abs(change) > most_remeshed_volume)
    throw NumericsError(
        fmt::format("drop {}: the surface crumpled: mending it changed the volume by {:.0f} %; use a "
                    "smaller time step, or a level that holds there (docs/MODELS.md)",
                    id, 100 * change));
}

void deform_or_recover(Drop& drop, double time, double dt, const StepOptions& options, StepReport& report,
                       const Deform& deform) {
  KeptState& kept = drop.workspace().kept;
  kept.keep(drop);
  const std::size_t recoveries = report.recoveries;
  recurse(drop, time, dt, options, report, deform, kept, 0);
  if (report.recoveries > recoveries) find_face_changes(drop, kept.positions(), drop.workspace().violent_faces);
}

}  // namespace meniscus
