// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

/// Exact curvature, area and volume of simple surfaces. K = kappa_1 + kappa_2 (1/cm), positive on convex
/// ones: 2/R on a sphere. All are centred at the origin; points must lie on the surface (cm).
namespace meniscus::references {

double sphere_curvature(double radius);

/// Axis-aligned, with these semi-axes.
double ellipsoid_curvature(const Eigen::Vector3d& semi_axes, const Eigen::Vector3d& point);
/// By elliptic integrals of the first and second kind (Boost.Math), cm^2.
double ellipsoid_area(const Eigen::Vector3d& semi_axes);
double ellipsoid_volume(const Eigen::Vector3d& semi_axes);

/// About the z axis; minor < major.
double torus_curvature(double major, double minor, const Eigen::Vector3d& point);
double torus_area(double major, double minor);
double torus_volume(double major, double minor);

/// The union of two balls of one radius whose centres are `apart` (cm, in [0, 2 radius]): less their lens.
double two_balls_volume(double radius, double apart);
double two_balls_area(double radius, double apart);

/// A sphere under x' = -gamma K n after t seconds (gamma in cm^2/s, Eq 4): sqrt(R^2 - 4 gamma t); 0 once it has gone.
double sphere_radius_under_flow(double radius, double gamma, double time);
/// The same after n implicit steps of dt, each R/(1 + 2 gamma dt/R^2): what an exact discretisation in space gives.
double sphere_radius_under_implicit_flow(double radius, double gamma, double dt, int steps);

}  // namespace meniscus::references
