// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/parameters.h"

#include <Eigen/Core>

#include <vector>

/// Exact shapes of drops at rest on a plane, computed: no figure here is typed in. cm, g, s; radians.
namespace meniscus::references {

/// The part of a ball on one side of a plane: a drop at rest without gravity.
struct SphericalCap {
  double radius;          ///< of the sphere, cm
  double height;          ///< cm
  double contact_radius;  ///< cm
  double air_area;        ///< of the curved part, cm^2
};

/// The cap of this volume (cm^3, > 0) and contact angle (in (0, pi], through the liquid). Throws UsageError otherwise.
SphericalCap spherical_cap(double volume, double contact_angle);

/// Where a drop of revolution lies.
enum class Hold {
  sessile,  ///< on top of a plane
  pendant,  ///< below one: gravity pulls it away
};

/// A drop of revolution at rest on a horizontal plane.
struct DropAtRest {
  double height;                         ///< cm, from the plane to the apex
  double contact_radius;                 ///< cm
  double volume;                         ///< cm^3, of the integrated profile
  double air_area;                       ///< cm^2
  double apex_curvature;                 ///< b, 1/cm: half of K at the apex
  double base_pressure;                  ///< of the liquid at the plane, above the air's, g/(cm s^2)
  double centroid_height;                ///< cm, of the liquid above (below, if pendant) the plane
  std::vector<Eigen::Vector2d> profile;  ///< (distance from the axis, distance from the apex), apex first, cm
};

/// Young-Laplace: the drop of this volume (cm^3, > 0) and contact angle (in (0, pi], through the liquid) under
/// gravity (cm/s^2, >= 0), as the initial value problem from the apex by arc length
///   r' = cos phi, z' = sin phi, phi' = 2 b +- rho g z/sigma - sin phi/r   (+ sessile, - pendant),
/// by Boost.Odeint's Dormand-Prince at relative 1e-12, up to phi = contact_angle, b found by Boost.Math's TOMS 748.
/// Pendant drops only as far as they steepen from the apex to the plane: the first place where phi is the angle.
/// Throws UsageError for arguments out of range, for no surface tension with gravity, and where no such
/// pendant drop is: it is too heavy.
DropAtRest drop_at_rest(double volume, double contact_angle, double gravity, const Liquid& liquid, Hold hold);

/// The most that a plane with hysteresis holds at its contact line, as the weight along the plane over sigma (cm):
/// w (cos theta_r - cos theta_a) times a factor, w = 2 contact_radius the width of the drop.
enum class RetentionForm {
  furmidge,    ///< 1: the front half of the line at theta_a, the rear half at theta_r
  quarter_pi,  ///< pi/4: the cosine varies linearly along the plane from rear to front, the line being a circle
};
double retention(RetentionForm form, double contact_radius, double advancing_angle, double receding_angle);

/// The tilt (radians) at which a drop of this volume, deposited on the level plane at `deposited_angle` and keeping
/// that contact line, starts to slide: sin = sigma retention/(rho g V); pi/2 if the vertical plane holds it.
double critical_tilt(RetentionForm form, double volume, double deposited_angle, double advancing_angle,
                     double receding_angle, double gravity, const Liquid& liquid);

}  // namespace meniscus::references
