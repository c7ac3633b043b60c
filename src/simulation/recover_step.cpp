// SPDX-License-Identifier: GPL-3.0-or-later
#include "recover_step.h"

#include "meniscus/core/error.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

using Eigen::Vector3d;

constexpr double most_turned = 0.05;        // share of the surface
constexpr double most_growth = 2;           // of the surface
constexpr double most_volume_change = 0.5;  // of the target, away from it
constexpr int most_halvings = 6;

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
                    const Deform& deform, const KeptState& kept) {
  try {
    deform(drop, time, dt, options, report);
  } catch (const NumericsError& error) {
    return error.what();
  }
  return blow_up(drop, kept.positions());
}

/// `kept` is the drop as it is.
void recurse(Drop& drop, double time, double dt, const StepOptions& options, StepReport& report, const Deform& deform,
             const KeptState& kept, int halvings) {
  StepReport tried = report;
  const std::string wrong = attempt(drop, time, dt, options, tried, deform, kept);
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

void KeptState::keep(Drop& drop) {
  const std::size_t n = drop.num_rows();
  positions_ = drop.positions();
  velocities_ = drop.velocities();
  displacements_ = drop.displacements();
  contact_normals_ = drop.contact_normals();
  contact_.assign(drop.contact(), drop.contact() + n);
  contact_solid_.assign(drop.contact_solid(), drop.contact_solid() + n);
  line_status_.assign(drop.line_statuses(), drop.line_statuses() + n);
  target_volume_ = drop.target_volume();
}

void KeptState::restore(Drop& drop) const {
  drop.positions() = positions_;
  drop.velocities() = velocities_;
  drop.displacements() = displacements_;
  drop.contact_normals() = contact_normals_;
  std::copy(contact_.begin(), contact_.end(), drop.contact());
  std::copy(contact_solid_.begin(), contact_solid_.end(), drop.contact_solid());
  std::copy(line_status_.begin(), line_status_.end(), drop.line_statuses());
  drop.set_target_volume(target_volume_);
}

std::string blow_up(const Drop& drop, const Eigen::Matrix3Xd& before) {
  const ConstColumns x = drop.positions();
  if (!x.allFinite() || !drop.velocities().allFinite()) return "a position or velocity is not finite";
  double turned = 0, area_now = 0, area_then = 0, volume_now = 0, volume_then = 0;
  for (const auto& [a, b, c] : drop.connectivity().triangles()) {
    if (a == Connectivity::removed) continue;
    const Vector3d p = x.col(a), q = before.col(a);
    const Vector3d now = (x.col(b) - p).cross(x.col(c) - p), then = (before.col(b) - q).cross(before.col(c) - q);
    const double size = now.norm();
    area_now += size;
    area_then += then.norm();
    volume_now += now.dot(p) / 6;
    volume_then += then.dot(q) / 6;
    if (now.dot(then) < 0) turned += size;
  }
  if (turned > most_turned * area_now)
    return fmt::format("{:.0f} % of the surface turned over", 100 * turned / area_now);
  if (area_now > most_growth * area_then) return fmt::format("the surface grew {:.2g} times", area_now / area_then);
  const double target = drop.target_volume();
  const double off = (std::abs(volume_now - target) - std::abs(volume_then - target)) / target;
  if (off > most_volume_change) return fmt::format("the volume went off by {:.0f} %", 100 * off);
  return {};
}

void check_not_crumpled(const std::vector<Drop>& pieces, double volume_before, int id) {
  double volume = 0;
  std::size_t faces = 0;
  for (const Drop& piece : pieces) {
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

KeptState deform_or_recover(Drop& drop, double time, double dt, const StepOptions& options, StepReport& report,
                            const Deform& deform) {
  KeptState kept;
  kept.keep(drop);
  recurse(drop, time, dt, options, report, deform, kept, 0);
  return kept;
}

}  // namespace meniscus
