// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/simulation/safe_time_step.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace meniscus {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity(), pi = 3.14159265358979323846;

/// At most this much of a drop's lowest mode's phase, sqrt(2), passes in one
/// substep of Level::calibrated: (omega dt)^2 = 4 c dt^2/R^2 <= 2. Beyond, one
/// implicit step of the flow would shrink the drop by half.
constexpr double largest_phase_squared = 2;

/// Level::paper: gamma dt over the squared middle of the band, and over R^2,
/// that the map of failure shows to be safe.
constexpr double largest_flow_over_edge = 0.5, largest_flow_over_radius = 0.02;

double middle(const EdgeBand& band) { return 0.5 * (band.edge_min + band.edge_max); }

double square(double x) { return x * x; }

}  // namespace

double longest_substep(const StepOptions& options, double ball_radius, bool near_solid) {
  if (options.level == Level::paper || options.liquid.surface_tension == 0) return infinity;
  const double sqrt_c = std::sqrt(2 * options.liquid.surface_tension / (options.liquid.density * ball_radius));
  const double phase = std::sqrt(largest_phase_squared / 4) * ball_radius / sqrt_c;
  // Near a solid the contact line and the surface beside it would move past
  // each other within a substep.
  return near_solid ? std::min(phase, middle(options.band) / sqrt_c) : phase;
}

double safe_time_step(const StepOptions& options, const std::vector<Drop>& drops) {
  double smallest = infinity;
  for (const Drop& drop : drops) smallest = std::min(smallest, std::cbrt(3 * drop.target_volume() / (4 * pi)));
  if (std::isinf(smallest)) return infinity;
  if (options.level != Level::paper) return most_substeps * longest_substep(options, smallest, true);
  const double flow =
      std::min(largest_flow_over_edge * square(middle(options.band)), largest_flow_over_radius * square(smallest));
  const double gamma = options.paper.curvature_flow_coefficient;
  return gamma > 0 ? flow / gamma : infinity;
}

}  // namespace meniscus
