// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/simulation/step.h"

namespace meniscus::bench {

/// A ball about the origin with mode n along z: r = radius (1 + amplitude P_n(cos theta)). 10 frequency^2 + 2 vertices.
Drop drop_in_mode(int mode, int frequency, double radius, double amplitude);

/// Its amplitude: the projection of the radius on P_n over the mean radius.
double mode_amplitude(const Drop& drop, int mode);

/// A ball of R = 0.2 cm left alone in one mode at 5 %, beside Rayleigh's inviscid one.
struct ModeRun {
  double frequency_error = 0;  ///< relative, from zero crossings; NaN with fewer than two
  double kept_per_period = 0;  ///< of the amplitude; NaN with fewer than three swings
  double cpu_per_period = 0;   ///< seconds of processor time for one period of Rayleigh's
  double worst_volume_error = 0;
};

/// Runs `periods` of Rayleigh's periods in steps of dt (s) without remeshing. A run that throws gives NaN.
ModeRun run_mode(int mode, int frequency, double dt, double periods, const StepOptions& options);

/// Water without viscosity or gravity, no remeshing.
StepOptions inviscid_water(Level level);

}  // namespace meniscus::bench
