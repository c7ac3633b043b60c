// SPDX-License-Identifier: GPL-3.0-or-later
#include "references/curved_surfaces.h"

#include <gtest/gtest.h>
#include <boost/math/quadrature/gauss_kronrod.hpp>

#include <cmath>

namespace meniscus::references {
namespace {

using Eigen::Vector3d;

constexpr double pi = 3.14159265358979323846;

TEST(CurvedSurfaces, AnEllipsoidOfEqualAxesIsASphere) {
  EXPECT_NEAR(ellipsoid_curvature({0.3, 0.3, 0.3}, {0, 0.18, 0.24}), sphere_curvature(0.3), 1e-12);
  EXPECT_NEAR(ellipsoid_area({0.3, 0.3, 0.3}), 4 * pi * 0.09, 1e-12);
  EXPECT_NEAR(ellipsoid_area({0.3, 0.3, 0.3 * (1 - 1e-5)}), 4 * pi * 0.09 * (1 - 2e-5 / 3), 1e-9);
}

TEST(CurvedSurfaces, AnEllipsoidCurvesAtItsPolesAsEllipsesDo) {
  const Vector3d a(1, 2, 3);
  EXPECT_NEAR(ellipsoid_curvature(a, {1, 0, 0}), 1.0 / 4 + 1.0 / 9, 1e-13);
  EXPECT_NEAR(ellipsoid_curvature(a, {0, 0, 3}), 3.0 / 1 + 3.0 / 4, 1e-13);
}

TEST(CurvedSurfaces, CurvatureIsTheFirstVariationOfArea) {
  // Offsetting by e n: dA/de = the integral of K. Steiner: for convex bodies A(e) = A + M e + 4 pi e^2; here
  // by quadrature over the spheroid and the torus.
  const Vector3d a(1, 1, 2);
  using boost::math::quadrature::gauss_kronrod;
  const auto spheroid = [&](auto what) {
    return 2 * pi *
           gauss_kronrod<double, 61>::integrate(
               [&](double t) {
                 const Vector3d x(std::sin(t), 0, 2 * std::cos(t));
                 return what(x) * std::sin(t) * std::hypot(std::cos(t), 2 * std::sin(t));
               },
               0.0, pi);
  };
  EXPECT_NEAR(spheroid([](const Vector3d&) { return 1.0; }), ellipsoid_area(a), 1e-9);
  // Minkowski: 3 V = int x.n dA and 2 A = int K x.n dA.
  const auto support = [&](const Vector3d& x) { return x.dot(Vector3d(x.x(), x.y(), x.z() / 4).normalized()); };
  EXPECT_NEAR(spheroid(support), 3 * ellipsoid_volume(a), 1e-9);
  EXPECT_NEAR(spheroid([&](const Vector3d& x) { return support(x) * ellipsoid_curvature(a, x); }),
              2 * ellipsoid_area(a), 1e-9);
  const auto torus = [&](auto what) {
    return 2 * pi *
           gauss_kronrod<double, 61>::integrate(
               [&](double t) {
                 const Vector3d x(1 + 0.4 * std::cos(t), 0, 0.4 * std::sin(t));
                 return what(x) * x.x() * 0.4;
               },
               0.0, 2 * pi);
  };
  EXPECT_NEAR(torus([](const Vector3d&) { return 1.0; }), torus_area(1, 0.4), 1e-9);
  EXPECT_NEAR(
      torus([](const Vector3d& x) { return torus_curvature(1, 0.4, x) * x.dot(Vector3d(x.x() - 1, 0, x.z()) / 0.4); }),
      2 * torus_area(1, 0.4), 1e-9);
  EXPECT_NEAR(torus_area(1, 0.4) * 0.2, torus_volume(1, 0.4), 1e-12);
}

TEST(CurvedSurfaces, TwoBallsAreOneOrTwoAtTheEndsAndSlicesBetween) {
  EXPECT_NEAR(two_balls_volume(0.2, 0), 4 * pi / 3 * 0.008, 1e-15);
  EXPECT_NEAR(two_balls_area(0.2, 0.4), 8 * pi * 0.04, 1e-14);
  using boost::math::quadrature::gauss_kronrod;
  const auto slice = [](double x) { return pi * (0.04 - (x - 0.12) * (x - 0.12)); };
  EXPECT_NEAR(two_balls_volume(0.2, 0.24), 2 * (gauss_kronrod<double, 31>::integrate(slice, 0.0, 0.32)), 1e-14);
}

TEST(CurvedSurfaces, ImplicitFlowOfASphereConvergesToTheFlow) {
  const double exact = sphere_radius_under_flow(0.2, 1, 0.005);
  const double coarse = sphere_radius_under_implicit_flow(0.2, 1, 0.005 / 100, 100) - exact;
  const double fine = sphere_radius_under_implicit_flow(0.2, 1, 0.005 / 200, 200) - exact;
  EXPECT_NEAR(coarse / fine, 2, 0.02);  // first order
  EXPECT_EQ(sphere_radius_under_flow(0.2, 1, 1), 0);
}

}  // namespace
}  // namespace meniscus::references
