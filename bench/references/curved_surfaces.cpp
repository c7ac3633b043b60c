// SPDX-License-Identifier: GPL-3.0-or-later
#include "references/curved_surfaces.h"

#include <boost/math/constants/constants.hpp>
#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/ellint_2.hpp>

#include <algorithm>
#include <cmath>

namespace meniscus::references {
namespace {

constexpr double pi = boost::math::constants::pi<double>();

}  // namespace

double sphere_curvature(double radius) { return 2 / radius; }

double ellipsoid_curvature(const Eigen::Vector3d& semi_axes, const Eigen::Vector3d& point) {
  // K = div(grad F/|grad F|) with F = sum x_i^2/a_i^2.
  const Eigen::Array3d inverse = semi_axes.array().square().inverse();
  const Eigen::Array3d gradient = point.array() * inverse;
  const double square = gradient.square().sum();
  return (inverse.sum() - (gradient.square() * inverse).sum() / square) / std::sqrt(square);
}

double ellipsoid_area(const Eigen::Vector3d& semi_axes) {
  std::array<double, 3> s{semi_axes.x(), semi_axes.y(), semi_axes.z()};
  std::sort(s.begin(), s.end(), std::greater<>());
  const auto [a, b, c] = s;
  if (a - c < 1e-7 * a) return 4 * pi * std::pow(ellipsoid_volume(semi_axes) * 3 / (4 * pi), 2.0 / 3);
  const double phi = std::acos(c / a), sine = std::sin(phi);
  const double modulus = a / b * std::sqrt((b * b - c * c) / (a * a - c * c));
  const double k = std::min(1.0, modulus);
  return 2 * pi * c * c +
         2 * pi * a * b / sine *
             (boost::math::ellint_2(k, phi) * sine * sine + boost::math::ellint_1(k, phi) * std::pow(std::cos(phi), 2));
}

double ellipsoid_volume(const Eigen::Vector3d& semi_axes) { return 4 * pi / 3 * semi_axes.prod(); }

double torus_curvature(double major, double minor, const Eigen::Vector3d& point) {
  const double distance = std::hypot(point.x(), point.y());  // = major + minor cos(psi)
  return 1 / minor + (distance - major) / minor / distance;
}

double torus_area(double major, double minor) { return 4 * pi * pi * major * minor; }

double torus_volume(double major, double minor) { return 2 * pi * pi * major * minor * minor; }

double two_balls_volume(double radius, double apart) {
  const double cap = radius - 0.5 * apart;  // the height of half the lens
  return 2 * (4 * pi / 3 * radius * radius * radius - pi * cap * cap * (radius - cap / 3));
}

double two_balls_area(double radius, double apart) {
  const double cap = radius - 0.5 * apart;
  return 2 * (4 * pi * radius * radius - 2 * pi * radius * cap);
}

double sphere_radius_under_flow(double radius, double gamma, double time) {
  return std::sqrt(std::max(0.0, radius * radius - 4 * gamma * time));
}

double sphere_radius_under_implicit_flow(double radius, double gamma, double dt, int steps) {
  for (int n = 0; n < steps; ++n) radius /= 1 + 2 * gamma * dt / (radius * radius);
  return radius;
}

}  // namespace meniscus::references
