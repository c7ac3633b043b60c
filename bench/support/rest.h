// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/simulation/choose_model.h"

namespace meniscus::bench {

/// A drop laid on the plane z = 0 without hysteresis, remeshing on, from a cap whose contact radius is off.
struct RestCase {
  Level level = Level::calibrated;
  std::optional<Accuracy> accuracy;  ///< the level "auto" instead
  double radius = 0.2;               ///< of the ball of its volume, cm
  double angle = 1.5;                ///< radians
  double edge_min = 0.02;            ///< cm; edge_max is three times it
  double time_step = 1 / 240.0;
  double start_factor = 1.2;  ///< the starting cap's contact radius over the cap's at rest without gravity
  double longest = 2;         ///< s simulated at most
};

/// What came of it, beside Young-Laplace for the volume that the drop keeps.
struct RestRun {
  double height_error = 0, radius_error = 0;  ///< relative; the radius is that of the circle of the wetted area
  double triangles = 0;
  double seconds = 0;      ///< simulated until height and radius had changed by less than 1e-4 over 0.05 s, twice
  double cpu_seconds = 0;  ///< until then
  bool rested = false;     ///< before RestCase::longest
  ModelChoice choice;      ///< what it was run with
};

/// A run that throws or loses the drop gives NaN.
RestRun run_to_rest(const RestCase& rest);

}  // namespace meniscus::bench
