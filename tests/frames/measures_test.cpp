// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/frames/measures.h"

#include "meniscus/state/ledger.h"

#include "meniscus/geometry/shapes.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double pi = 3.14159265358979323846;

Drop box_drop(const Vector3d& center, const Vector3d& size) { return Drop(make_box(center, size, 0.25)); }

/// Sets u(x) = a + B x on the surface.
void set_linear_velocity(Drop& drop, const Vector3d& a, const Matrix3d& b) {
  drop.velocities() = (b * drop.positions()).colwise() + a;
}

Vector3d random_vector(double size) {
  const auto number = [&] { return size * (*rc::gen::inRange(-1000, 1001)) / 1000.0; };
  return {number(), number(), number()};
}

TEST(Measures, BoxHasItsVolumeAreaCentroidAndEdges) {
  const Vector3d center(3, -4, 5), size(1, 0.5, 0.25);
  const DropMeasures m = measure_drop(box_drop(center, size), 1);
  EXPECT_NEAR(m.volume, 0.125, 1e-14);
  EXPECT_NEAR(m.target_volume, 0.125, 1e-14);
  EXPECT_NEAR(m.area, 2 * (0.5 + 0.25 + 0.125), 1e-13);
  EXPECT_LT((m.centroid - center).norm(), 1e-13);
  EXPECT_EQ(m.momentum.norm(), 0);
  EXPECT_EQ(m.wetted_area, 0);
  EXPECT_FALSE(m.mean_contact_angle.has_value());
  EXPECT_NEAR(m.least_angle, pi / 4, 1e-12);
  EXPECT_NEAR(m.edge_min, 0.25, 1e-12);
  EXPECT_NEAR(m.edge_max, 0.25 * std::sqrt(2.0), 1e-12);
  EXPECT_GT(m.edge_mean, m.edge_min);
  EXPECT_LT(m.edge_mean, m.edge_max);
}

TEST(Measures, EdgesAreCountedOnceAndFacesAll) {
  const Drop drop(make_icosphere(Vector3d::Zero(), 1, 1));
  const DropMeasures m = measure_drop(drop, 1);
  const double edge = 4 / std::sqrt(10 + 2 * std::sqrt(5.0));
  EXPECT_EQ(m.triangles, 20u);
  EXPECT_NEAR(m.edge_min, edge, 1e-14);
  EXPECT_NEAR(m.edge_mean, edge, 1e-14);
  EXPECT_NEAR(m.edge_max, edge, 1e-14);
  EXPECT_NEAR(m.least_angle, pi / 3, 1e-14);
}

RC_GTEST_PROP(Measures, MomentumOfATranslationIsMassTimesVelocity, ()) {
  const Vector3d velocity = random_vector(100), center = random_vector(10);
  const double density = *rc::gen::inRange(1, 30) / 10.0;
  Drop drop = box_drop(center, {1, 0.5, 0.75});
  set_linear_velocity(drop, velocity, Matrix3d::Zero());
  const Vector3d expected = density * drop.volume() * velocity;
  RC_ASSERT((measure_drop(drop, density).momentum - expected).norm() < 1e-11 * (1 + expected.norm()));
}

RC_GTEST_PROP(Measures, MomentumOfAFlowWithoutDivergenceIsTheVolumeIntegral, ()) {
  const Vector3d velocity = random_vector(10), center = random_vector(10);
  Matrix3d gradient;
  for (int k = 0; k < 3; ++k) gradient.col(k) = random_vector(10);
  gradient -= gradient.trace() / 3 * Matrix3d::Identity();
  Drop drop = box_drop(center, {1, 0.5, 0.75});
  set_linear_velocity(drop, velocity, gradient);
  const Vector3d expected = drop.volume() * (velocity + gradient * center);
  const Vector3d here = surface_momentum(drop, 1, Vector3d::Zero());
  const Vector3d elsewhere = surface_momentum(drop, 1, random_vector(10));
  RC_ASSERT((here - expected).norm() < 1e-10 * (1 + expected.norm()));
  RC_ASSERT((elsewhere - expected).norm() < 1e-10 * (1 + expected.norm()));
}

TEST(Measures, RotationAndExpansionAboutTheCentreHaveNoMomentum) {
  Drop drop = box_drop({7, 0, 0}, {1, 1, 1});
  Matrix3d gradient;
  gradient << 2, -1, 0, 1, 2, 0, 0, 0, 2;
  set_linear_velocity(drop, -gradient * Vector3d(7, 0, 0), gradient);
  EXPECT_LT(measure_drop(drop, 1).momentum.norm(), 1e-12);
}

TEST(Measures, CapOnAPlaneHasItsContactAngleAndWettedArea) {
  const double radius = 0.3, angle = pi / 3;
  Drop drop(make_cap(Vector3d::Zero(), Vector3d::UnitZ(), radius, angle, 0.02));
  for (std::size_t v = 0; v < drop.num_rows(); ++v) {
    const Vector3d x = drop.positions().col(static_cast<Eigen::Index>(v));
    if (std::abs(x.z()) > 1e-12) continue;
    drop.contact()[v] = x.norm() > radius * (1 - 1e-9) ? Contact::line : Contact::wetted;
    drop.contact_normals().col(static_cast<Eigen::Index>(v)) = Vector3d::UnitZ();
  }
  const DropMeasures m = measure_drop(drop, 1);
  EXPECT_NEAR(m.wetted_area, pi * radius * radius, 0.01 * pi * radius * radius);
  ASSERT_TRUE(m.mean_contact_angle.has_value());
  EXPECT_NEAR(*m.mean_contact_angle, angle, 0.06);
  EXPECT_GT(m.centroid.z(), 0);
}

TEST(Measures, RowHasAsManyFieldsAsTheHeader) {
  const auto count = [](const std::string& line) { return std::count(line.begin(), line.end(), ','); };
  const DropMeasures m = measure_drop(box_drop({0, 0, 0}, {1, 1, 1}), 1);
  const std::string row = measures_row(1.0 / 3, m);
  EXPECT_EQ(count(row), count(measures_header()));
  EXPECT_EQ(row.substr(0, row.find(',')), "0.33333333333333331");
  EXPECT_NE(row.find(",,"), std::string::npos) << "no contact, no angle";
  EXPECT_EQ(row.back(), '\n');
}

}  // namespace
}  // namespace meniscus
