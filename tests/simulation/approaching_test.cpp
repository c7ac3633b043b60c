// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/simulation/approaching.h"

#include "meniscus/geometry/shapes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace meniscus {
namespace {

using Eigen::Vector3d;
constexpr double radius = 0.2, least_radius = 0.06, dt = 0.01;

Drop ball(const Vector3d& center, const Vector3d& velocity) {
  Drop drop(make_icosphere(center, radius, 4));
  drop.velocities().colwise() = velocity;
  return drop;
}

std::vector<Drop> two_balls(double gap, double speed) {
  std::vector<Drop> drops;
  drops.push_back(ball({0, 0, 0}, {speed, 0, 0}));
  drops.push_back(ball({0, 0, 0}, {0, 0, 0}));
  const double length = bounding_box(drops[0]).sizes().x();
  drops[1].positions().row(0).array() += length + gap;
  return drops;
}

TEST(Approach, StepsEndBeforeBoxesMeet) {
  EXPECT_NEAR(longest_step(two_balls(1, 200), dt, least_radius), 0.75 * 1 / 200.0, 1e-12);
  EXPECT_EQ(longest_step(two_balls(3, 200), dt, least_radius), dt) << "they do not meet";
}

TEST(Approach, DropsThatMayMeetComeCloserByAQuarterOfTheSmallerRadius) {
  std::vector<Drop> drops = two_balls(0, 200);
  const double ball_radius = std::cbrt(0.75 * drops[0].volume() / M_PI);
  EXPECT_NEAR(longest_step(drops, dt, least_radius), 0.25 * ball_radius / 200, 1e-9);
  EXPECT_NEAR(longest_step(drops, dt, 0.5), 0.25 * 0.5 / 200, 1e-9) << "smaller ones count as if they were this large";
  EXPECT_EQ(longest_step(two_balls(0, 1), dt, least_radius), dt);
}

TEST(Approach, OnlyWhatMayMeetFastSharesACluster) {
  std::vector<Drop> drops = two_balls(1, 200);
  drops.push_back(ball({0, 5, 0}, {200, 0, 0}));  // flies past
  drops.push_back(ball({0, 0, 5}, {0, 0, 1}));
  drops.push_back(ball({0, 0, 5.401}, {0, 0, 0}));  // may meet it, but slowly
  Approach approach;
  EXPECT_EQ(approach.find_clusters(drops, dt, least_radius), (std::vector<std::vector<std::uint32_t>>{{0, 1}}));
  drops[0].velocities().setZero();
  EXPECT_TRUE(approach.find_clusters(drops, dt, least_radius).empty());
}

}  // namespace
}  // namespace meniscus
