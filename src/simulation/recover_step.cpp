// SPDX-License-Identifier: GPL-3.0-or-later
#include "recover_step.h"

#include "meniscus/core/error.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <cmath>

namespace meniscus {
namespace {

constexpr double most_turned = 0.05;  ///< share of the surface
constexpr double most_growth = 2;     ///< of the surface
constexpr double most_volume_change = 0.5;
constexpr int most_halvings = 6;

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
  return blow_up(drop, drop.workspace().geometry, kept);
}

void recurse(Drop& drop, double time, double dt, const StepOptions& options, StepReport& report, const Deform& deform,
             KeptState& kept, int halvings) {
  kept.keep(drop);
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
                    "or a level that holds there (docs/ACCURACY.md)",
                    drop.id(), time, wrong, dt));
  ++report.recoveries;
  const StepOptions half = at_half_step(options);
  recurse(drop, time - 0.5 * dt, 0.5 * dt, half, report, deform, kept, halvings + 1);
  recurse(drop, time, 0.5 * dt, half, report, deform, kept, halvings + 1);
}

}  // namespace

void KeptState::keep(const Drop& drop) {
  positions_ = drop.positions();
  velocities_ = drop.velocities();
  displacements_ = drop.displacements();
  contact_normals_ = drop.contact_normals();
  contact_.assign(drop.contact(), drop.contact() + drop.num_rows());
  contact_solid_.assign(drop.contact_solid(), drop.contact_solid() + drop.num_rows());
  volume_ = drop.volume();
}

void KeptState::restore(Drop& drop) const {
  drop.positions() = positions_;
  drop.velocities() = velocities_;
  drop.displacements() = displacements_;
  drop.contact_normals() = contact_normals_;
  std::copy(contact_.begin(), contact_.end(), drop.contact());
  std::copy(contact_solid_.begin(), contact_solid_.end(), drop.contact_solid());
}

std::string blow_up(const Drop& drop, const SurfaceGeometry& geometry, const KeptState& before) {
  const ConstColumns x = drop.positions();
  if (!x.allFinite() || !drop.velocities().allFinite()) return "a position or velocity is not finite";
  const auto& triangles = drop.connectivity().triangles();
  double turned = 0, area = 0;
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    if (triangles[f][0] == Connectivity::removed) continue;
    const Eigen::Vector3d a = x.col(triangles[f][0]), b = x.col(triangles[f][1]), c = x.col(triangles[f][2]);
    const Eigen::Vector3d now = 0.5 * (b - a).cross(c - a);
    const Eigen::Map<const Eigen::Vector3d> then(geometry.faces()[f].area_vector.data());
    const double size = now.norm();
    area += size;
    if (now.dot(then) < 0) turned += size;
  }
  if (turned > most_turned * area) return fmt::format("{:.0f} % of the surface turned over", 100 * turned / area);
  if (area > most_growth * geometry.area()) return fmt::format("the surface grew {:.2g} times", area / geometry.area());
  const double change = (drop.volume() - before.volume()) / drop.target_volume();
  if (std::abs(change) > most_volume_change) return fmt::format("the volume changed by {:.0f} %", 100 * change);
  return {};
}

void deform_or_recover(Drop& drop, double time, double dt, const StepOptions& options, StepReport& report,
                       const Deform& deform) {
  KeptState kept;
  recurse(drop, time, dt, options, report, deform, kept, 0);
}

}  // namespace meniscus
