// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/simulation/step.h"

#include <limits>
#include <vector>

namespace meniscus {

/// A ball of `radius` (cm) about the origin, stretched along z by mode 2 of relative amplitude
/// `amplitude`: r = radius (1 + amplitude P2(cos theta)). 10 frequency^2 + 2 vertices.
Drop oscillating_drop(int frequency, double radius, double amplitude);

/// The amplitude of mode 2 of a drop: the projection of the radius on P2, over the mean radius.
double mode_two_amplitude(const Drop& drop);

/// A damped swing.
struct Swing {
  double angular_frequency = std::numeric_limits<double>::quiet_NaN();  ///< rad/s
  double kept_per_period = std::numeric_limits<double>::quiet_NaN();    ///< of the amplitude
};

/// The swing that samples dt (s) apart are of, about any mean, however few a period, by Prony's method: x_{n+1} = a x_n
/// - b x_{n-1} + c by least squares, a = 2 exp(-g dt) cos(omega dt), b = exp(-2 g dt). NaN if they creep.
/// Precondition: at least five samples.
Swing fit_swing(const std::vector<double>& samples, double dt);

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
