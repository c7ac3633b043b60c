// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/simulation/step.h"

namespace meniscus {

/// A ball of `radius` (cm) about the origin, stretched along z by mode 2 of relative amplitude
/// `amplitude`: r = radius (1 + amplitude P2(cos theta)). 10 frequency^2 + 2 vertices.
Drop oscillating_drop(int frequency, double radius, double amplitude);

/// The amplitude of mode 2 of a drop: the projection of the radius on P2, over the mean radius.
double mode_two_amplitude(const Drop& drop);

/// A drop left to oscillate in mode 2, beside Rayleigh's sqrt(8 sigma/(rho R^3)).
struct OscillationResult {
  double angular_frequency = 0;  ///< rad/s, from the zero crossings; NaN with fewer than two
  double rayleigh = 0;           ///< rad/s
  double kept_per_period = 0;    ///< ratio of successive swings to the same side; NaN with fewer than two
};

/// Runs `steps` steps of dt (s) from rest for R = 0.2 cm and measures.
OscillationResult measure_oscillation(int frequency, double amplitude, double dt, int steps,
                                      const StepOptions& options);

}  // namespace meniscus
