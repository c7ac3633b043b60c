// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "flows.h"
#include "meniscus/simulation/step.h"
#include "test_meshes.h"

#include <string>

namespace meniscus::bench {

/// What went wrong first; words as in stability.csv.
enum class Failure {
  none,
  not_finite,    ///< NaN or infinity
  solver,        ///< a solve did not converge
  flipped,       ///< faces of more than a thousandth of the surface turned by more than 90 degrees in a step
  area_grown,    ///< in pure flow by more than 1e-6 in a step; in a level to more than 1.5 times the start
  energy_grown,  ///< kinetic energy, where an operator may only take it away
  volume_lost,   ///< off by more than 5 %, where the method keeps it
  unsound,       ///< at the end: meets itself, inside out, open
  error,         ///< the program gave up with a clear error (exit code 5)
};
const char* failure_name(Failure failure);

/// One cell of the map.
struct TrialCase {
  Quality quality = Quality::good;
  double radius = 0.2;  ///< of the ball of the drop's volume, cm
  double edge = 0.03;   ///< cm
  double tension = 72;  ///< sigma, g/s^2
  double time_step = 1 / 240.0;
  int steps = 12;
  unsigned seed = 1;
};

struct TrialResult {
  Failure failure = Failure::none;
  int steps = 0;               ///< taken before it failed, or all
  std::size_t recoveries = 0;  ///< substeps of a level that were taken back and done again in halves
};

/// Pure flow by s = c dt^2, c = 2 sigma/(rho R): what a step of `calibrated` does in that time.
TrialResult try_flow(Flow flow, const TrialCase& trial);

/// Operators that act beside the flow.
enum class Operator {
  viscosity,              ///< random velocities under eta = 2.456 nu, nu = 1 cm^2/s
  global_correction,      ///< advect, clamped flow, global correction
  global_positions_only,  ///< the same without the correction's part in the velocities
  local_as_written,       ///< Eqs 9 to 11, then global
};
inline constexpr std::array<const char*, 4> operator_names{"viscosity", "global volume", "global on x only",
                                                           "local (Eqs 9-11)"};
TrialResult try_operator(Operator which, const TrialCase& trial);

/// Whole steps of a level, at least 0.05 s, remeshing on: a spheroid in the air, or one that hits a plane of 60 degrees
/// at 30 cm/s.
TrialResult try_level(Level level, bool on_plane, const TrialCase& trial);

}  // namespace meniscus::bench
