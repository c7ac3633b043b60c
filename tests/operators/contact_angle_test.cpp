// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/operators/contact_angle.h"

#include "meniscus/geometry/shapes.h"
#include "meniscus/operators/external_forces.h"

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <cmath>

namespace meniscus {
namespace {

using Eigen::Vector3d;

double radians(double degrees) { return degrees * M_PI / 180; }

std::vector<Solid> plate(double receding, double advancing) {
  std::vector<Solid> solids{Solid::plane({0, 0, 0}, {0, 0, 1})};
  solids[0].receding_angle = receding;
  solids[0].advancing_angle = advancing;
  return solids;
}

/// A cap on z = 0 with its contact found.
Drop cap(double angle, double edge) {
  Drop drop(make_cap({0, 0, 0}, {0, 0, 1}, 0.2 * std::sin(angle), angle, edge));
  find_contact(drop, plate(angle, angle), 0, 1e-12);
  return drop;
}

/// Largest error over the line of the angle by virtual work, and the mean error of the paper's.
struct AngleError {
  double virtual_work, mean_measured;
};
AngleError angle_error(double angle, double edge) {
  const Drop drop = cap(angle, edge);
  AngleError error{0, std::abs(*mean_contact_angle(drop) - angle)};
  for (std::uint32_t v = 0; v < drop.num_rows(); ++v)
    if (drop.contact()[v] == Contact::line)
      error.virtual_work =
          std::max(error.virtual_work, std::abs(std::acos(contact_line_vertex(drop, v)->energy_cosine) - angle));
  return error;
}

TEST(ContactAngle, IsThatOfASphericalCap) {
  // Both converge at first order in the edge: the normals are those of the first row of faces.
  for (const double degrees : {30.0, 60.0, 90.0, 120.0, 150.0}) {
    const AngleError coarse = angle_error(radians(degrees), 0.02), fine = angle_error(radians(degrees), 0.005);
    EXPECT_LT(fine.mean_measured, radians(1.5)) << degrees;
    EXPECT_LT(fine.mean_measured, 0.4 * coarse.mean_measured) << degrees;
    EXPECT_LT(fine.virtual_work, radians(2.5)) << degrees;
  }
}

TEST(ContactAngle, LineLengthsAddUpToTheCircle) {
  const Drop drop = cap(radians(70), 0.01);
  double length = 0;
  for (std::uint32_t v = 0; v < drop.num_rows(); ++v)
    if (drop.contact()[v] == Contact::line) length += contact_line_vertex(drop, v)->length;
  EXPECT_NEAR(length, 2 * M_PI * 0.2 * std::sin(radians(70)), 1e-3 * length);
}

/// The mean outward speed of the line after one call on a 90 degree cap.
double line_speed(double receding, double advancing, ContactForce force) {
  Drop drop = cap(radians(90), 0.02);
  SurfaceGeometry& geometry = drop.workspace().geometry;
  geometry.compute(std::as_const(drop).positions(), drop.connectivity());
  ContactAngleOptions options;
  options.force = force;
  options.tension_over_mass = 720;
  apply_contact_angle(drop, plate(receding, advancing), geometry, 1e-3, 1e-3, options);
  double sum = 0;
  int count = 0;
  for (std::uint32_t v = 0; v < drop.num_rows(); ++v) {
    if (drop.contact()[v] != Contact::line) {
      EXPECT_EQ(drop.velocities().col(v).norm(), 0);
      continue;
    }
    EXPECT_EQ(drop.velocities()(2, v), 0);
    EXPECT_LT(std::abs(drop.positions()(2, v)), 1e-15);
    sum += drop.velocities().col(v).dot(Vector3d(drop.positions().col(v)).normalized());
    ++count;
  }
  return sum / count;
}

TEST(ContactAngle, TheLineAdvancesRecedesOrStays) {
  for (const ContactForce force : {ContactForce::measured_angle, ContactForce::virtual_work}) {
    EXPECT_GT(line_speed(radians(30), radians(60), force), 0);    // wetter: outward
    EXPECT_LT(line_speed(radians(120), radians(150), force), 0);  // drier: inward
    EXPECT_EQ(line_speed(radians(60), radians(120), force), 0);   // between: hysteresis
  }
}

TEST(ContactAngle, Eq8IsLinearInTheAngle) {
  const double once = line_speed(radians(30), radians(60), ContactForce::measured_angle);
  const double mean = *mean_contact_angle(cap(radians(90), 0.02));
  EXPECT_NEAR(once, mean - radians(60), 0.02);  // alpha = 1
}

TEST(ContactAngle, ALineBetweenItsAnglesSticks) {
  Drop drop = cap(radians(90), 0.02);
  SurfaceGeometry& geometry = drop.workspace().geometry;
  geometry.compute(std::as_const(drop).positions(), drop.connectivity());
  const Eigen::Matrix3Xd x0 = drop.positions();
  drop.velocities().colwise() = Vector3d(3, 1, 0);
  drop.positions().colwise() += Vector3d(3, 1, 0) * 1e-3;  // as advection left it
  ContactAngleOptions options;
  options.tension_over_mass = 720;
  apply_contact_angle(drop, plate(radians(60), radians(120)), geometry, 1e-3, 1e-3, options);
  for (std::uint32_t v = 0; v < drop.num_rows(); ++v)
    if (drop.contact()[v] == Contact::line) {
      EXPECT_LT(drop.velocities().col(v).norm(), 1e-14);
      EXPECT_LT((drop.positions().col(v) - x0.col(v)).norm(), 1e-14);
    }
}

TEST(ContactAngle, AFreeDropHasNone) {
  Drop drop(make_icosphere({0, 0, 1}, 0.2, 3));
  drop.workspace().geometry.compute(std::as_const(drop).positions(), drop.connectivity());
  EXPECT_FALSE(mean_contact_angle(drop));
  EXPECT_EQ(apply_contact_angle(drop, {}, drop.workspace().geometry, 0, 1e-3, {}).line, 0u);
  EXPECT_EQ(wetted_area(drop), 0);
}

TEST(ContactAngle, WettedAreaOfACap) {
  EXPECT_NEAR(wetted_area(cap(radians(60), 0.01)), M_PI * std::pow(0.2 * std::sin(radians(60)), 2), 1e-3);
}

}  // namespace
}  // namespace meniscus
