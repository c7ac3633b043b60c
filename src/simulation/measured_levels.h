// SPDX-License-Identifier: GPL-3.0-or-later
// PLACEHOLDER figures from docs/MODELS.md until `meniscus bench charts --table` has been run: replace before use.
#pragma once
#include <cmath>
#include "meniscus/state/parameters.h"
namespace meniscus {
struct MeasuredMotion {
  Level level;
  double phase;
  double error;
  double kept_per_period;
  double cost;
};
inline constexpr MeasuredMotion measured_motions[] = {{Level::calibrated, 0.0537, 0.003, 0.84, 1},
                                                      {Level::calibrated, 0.134, 0.014, 0.65, 0.5}};
struct MeasuredShape {
  Level level;
  double edge_over_radius;
  double error;
  double cost;
};
inline constexpr MeasuredShape measured_shapes[] = {{Level::calibrated, 0.2, 0.018, 0.1},
                                                    {Level::calibrated, 0.1, 0.0031, 1}};
inline constexpr Level measured_levels[] = {Level::calibrated};
}  // namespace meniscus
