// SPDX-License-Identifier: GPL-3.0-or-later
#include "references/waves.h"

#include <boost/math/special_functions/bessel.hpp>
#include <boost/math/tools/minima.hpp>

#include <cmath>

namespace meniscus::references {
namespace {

/// The growth rate in units of sqrt(sigma/(rho R^3)), squared.
double growth_squared(double x) {
  return x * (1 - x * x) * boost::math::cyl_bessel_i(1, x) / boost::math::cyl_bessel_i(0, x);
}

double capillary_rate(double radius, const Liquid& liquid) {
  return std::sqrt(liquid.surface_tension / (liquid.density * radius * radius * radius));
}

}  // namespace

double rayleigh_frequency(int mode, double radius, const Liquid& liquid) {
  const double n = mode;
  return std::sqrt(n * (n - 1) * (n + 2)) * capillary_rate(radius, liquid);
}

double lamb_decay(int mode, double radius, const Liquid& liquid) {
  const double n = mode;
  return (n - 1) * (2 * n + 1) * liquid.viscosity / (radius * radius);
}

double rayleigh_plateau_growth(double wave_number_times_radius, double radius, const Liquid& liquid) {
  if (wave_number_times_radius <= 0 || wave_number_times_radius >= 1) return 0;
  return std::sqrt(growth_squared(wave_number_times_radius)) * capillary_rate(radius, liquid);
}

double fastest_thread_wave() {
  const auto slower = [](double x) { return -growth_squared(x); };
  return boost::math::tools::brent_find_minima(slower, 0.1, 0.9, 40).first;
}

}  // namespace meniscus::references
