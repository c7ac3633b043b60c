// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/parameters.h"

/// Exact small motions of balls and threads of liquid. cm, g, s.
namespace meniscus::references {

/// Rayleigh (1879): the angular frequency of mode n >= 2 of an inviscid ball, sqrt(n (n-1)(n+2) sigma/(rho R^3)),
/// rad/s.
double rayleigh_frequency(int mode, double radius, const Liquid& liquid);

/// Lamb (Hydrodynamics, 355): the decay rate of its amplitude for a small viscosity, (n-1)(2n+1) nu/R^2, 1/s.
double lamb_decay(int mode, double radius, const Liquid& liquid);

/// Rayleigh (1878): the growth rate (1/s) of a wave of number k on an inviscid thread of `radius`, x = k radius:
/// sqrt(sigma/(rho R^3)) sqrt(x (1 - x^2) I1(x)/I0(x)). Zero where the thread is stable, x >= 1 or x <= 0.
double rayleigh_plateau_growth(double wave_number_times_radius, double radius, const Liquid& liquid);

/// The x = k R that grows fastest (0.697: wavelengths of 9.01 R); it depends on nothing.
double fastest_thread_wave();

}  // namespace meniscus::references
