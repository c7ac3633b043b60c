// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/simulation/safe_time_step.h"

#include "step_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace meniscus {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// What docs/charts/stability.csv shows to be safe: gamma dt/R^2 at Level::paper in the air, a fifth of the largest up
/// to which all held; dt/sqrt(rho R^3/sigma) at the others, the largest that is in it.
constexpr double longest_flow = 0.04, longest_capillary_step = 20;

/// Where there are solids, a drop that moves by more of its radius in a step would need more substeps than there may
/// be.
constexpr double farthest_move = largest_move * most_substeps;

}  // namespace

double safe_time_step(const StepOptions& options, const std::vector<Drop>& drops, const std::vector<Solid>& solids) {
  double smallest = infinity;
  for (const Drop& drop : drops) smallest = std::min(smallest, ball_radius(drop));
  if (std::isinf(smallest)) return infinity;
  if (options.level == Level::paper) {
    if (!solids.empty()) return 0;
    const double gamma = options.paper.curvature_flow_coefficient;
    return gamma > 0 ? longest_flow * smallest * smallest / gamma : infinity;
  }
  double longest = infinity;
  if (!solids.empty())
    for (const Drop& drop : drops) longest = std::min(longest, farthest_move * ball_radius(drop) / top_speed(drop));
  const Liquid& liquid = options.liquid;
  if (!(liquid.surface_tension > 0)) return longest;
  const double capillary =
      longest_capillary_step * std::sqrt(liquid.density * std::pow(smallest, 3) / liquid.surface_tension);
  return std::min(longest, capillary);
}

}  // namespace meniscus
