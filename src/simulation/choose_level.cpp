// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/simulation/choose_level.h"

#include "measured_levels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace meniscus {
namespace {

constexpr double look_error = 0.1, shape_error = 0.01, motion_error = 0.02, least_kept = 0.8;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// The radius of the ball of the smallest drop that the scene gives by shape
/// (cm); 0.2 if all are meshes.
double smallest_radius(const Scene& scene) {
  double smallest = infinity;
  for (const DropSpec& drop : scene.drops) {
    if (drop.shape == DropShape::sphere || drop.shape == DropShape::cap) smallest = std::min(smallest, drop.radius);
    if (drop.shape == DropShape::ellipsoid) smallest = std::min(smallest, std::cbrt(drop.semi_axes.prod()));
    if (drop.shape == DropShape::box) smallest = std::min(smallest, std::cbrt(drop.size.prod() * 3 / (4 * pi)));
  }
  return std::isinf(smallest) ? 0.2 : smallest;
}

/// The measured row of a level whose mesh is nearest to the scene's, but no
/// finer than it, if there is one.
const MeasuredShape& shape_of(Level level, double edge_over_radius) {
  const MeasuredShape* best = nullptr;
  const auto distance = [&](const MeasuredShape& row) {
    return row.edge_over_radius >= edge_over_radius * 0.999 ? row.edge_over_radius : 1e3 / row.edge_over_radius;
  };
  for (const MeasuredShape& row : measured_shapes)
    if (row.level == level && (!best || distance(row) < distance(*best))) best = &row;
  return *best;
}

struct Pick {
  Level level = Level::calibrated;
  const MeasuredMotion* motion = nullptr;
  const MeasuredShape* shape = nullptr;
  bool meets = false;
  double cost = infinity, error = infinity;

  bool is_better_than(const Pick& other) const {
    if (meets != other.meets) return meets;
    return meets ? cost < other.cost : error < other.error;
  }
};

Pick pick_by_shape(double edge_over_radius, double limit) {
  Pick best;
  for (const Level level : measured_levels) {
    const MeasuredShape& row = shape_of(level, edge_over_radius);
    Pick pick{level, nullptr, &row, row.error <= limit, row.cost, row.error};
    if (pick.is_better_than(best) || !best.shape) best = pick;
  }
  return best;
}

Pick pick_by_motion(double edge_over_radius, bool has_solids) {
  Pick best;
  for (const MeasuredMotion& row : measured_motions) {
    const MeasuredShape& shape = shape_of(row.level, edge_over_radius);
    const double lost = 1 - row.kept_per_period, error = std::max({row.error, lost / 10, has_solids ? shape.error : 0});
    const bool meets =
        row.error <= motion_error && row.kept_per_period >= least_kept && (!has_solids || shape.error <= shape_error);
    const Pick pick{row.level, &row, &shape, meets, row.cost, error};
    if (pick.is_better_than(best) || !best.shape) best = pick;
  }
  return best;
}

}  // namespace

const char* level_name(Level level) {
  switch (level) {
    case Level::paper:
      return "paper";
    case Level::calibrated:
      return "calibrated";
    case Level::automatic:
      return "auto";
  }
  return "";
}

LevelChoice choose_level(const Scene& scene) {
  const double radius = smallest_radius(scene), share = scene.mesh.edge_min / radius;
  const bool motion = scene.accuracy == Accuracy::motion;
  const Pick pick = motion ? pick_by_motion(share, !scene.solids.empty())
                           : pick_by_shape(share, scene.accuracy == Accuracy::look ? look_error : shape_error);
  LevelChoice choice;
  choice.level = pick.level;
  choice.meets = pick.meets;
  choice.solver = scene.solver;
  choice.solver.tolerance = scene.accuracy == Accuracy::look ? 1e-3 : motion ? 1e-6 : 1e-4;
  if (pick.motion) choice.longest_phase = std::min(choice.longest_phase, pick.motion->phase * 1.0001);
  choice.why = fmt::format("{}: shapes at rest within {:.2g} % at edges from {:.2g} R", level_name(pick.level),
                           100 * pick.shape->error, pick.shape->edge_over_radius);
  if (pick.motion)
    choice.why += fmt::format(
        "; mode 2 within {:.2g} % and {:.2f} of its "
        "amplitude kept a period at omega dt = {:.2g}",
        100 * pick.motion->error, pick.motion->kept_per_period, pick.motion->phase);
  choice.why += pick.meets ? "; the cheapest that does" : "; nothing measured meets the accuracy, this comes nearest";
  return choice;
}

StepOptions resolve_level(const Scene& scene, StepOptions options) {
  if (scene.model != Level::automatic) return options;
  const LevelChoice choice = choose_level(scene);
  options.level = choice.level;
  options.volume_correction = choice.volume_correction;
  options.solver = choice.solver;
  options.longest_phase = choice.longest_phase;
  return options;
}

}  // namespace meniscus
