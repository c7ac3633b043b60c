// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/operators/external_forces.h"

#include "meniscus/core/error.h"
#include "meniscus/geometry/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace meniscus {
namespace {

using Eigen::Vector3d;

constexpr double g = 981;

Drop drop_at(const Vector3d& center, double radius = 0.2) { return Drop(make_icosphere(center, radius, 4)); }

/// Steps of external forces alone; n starts at 1.
void run(Drop& drop, const std::vector<Solid>& solids, int steps, double dt,
         const ExternalForcesOptions& options = {}) {
  for (int n = 1; n <= steps; ++n) apply_external_forces(drop, solids, n * dt, dt, options);
}

TEST(ExternalForces, FreeFallIsTheSumOfTheSteps) {
  // x_n = x_0 + n v_0 dt + n (n + 1)/2 g dt^2, the exact sum of symplectic Euler.
  const double dt = 1.0 / 240;
  const int n = 48;
  Drop drop = drop_at({0, 0, 5});
  const Eigen::Matrix3Xd x0 = drop.positions();
  const Vector3d v0(3, -2, 10), gravity(0, 0, -g);
  drop.velocities().colwise() = v0;
  run(drop, {}, n, dt);
  for (Eigen::Index i = 0; i < x0.cols(); ++i) {
    const Vector3d expected = x0.col(i) + n * dt * v0 + 0.5 * n * (n + 1) * dt * dt * gravity;
    EXPECT_LT((drop.positions().col(i) - expected).norm(), 1e-12);
    EXPECT_LT((drop.velocities().col(i) - v0 - n * dt * gravity).norm(), 1e-11);
  }
}

TEST(ExternalForces, NoTimeMovesNothing) {
  Drop drop = drop_at({0, 0, 0.1});
  drop.velocities().colwise() = Vector3d(1, 2, 3);
  const Eigen::Matrix3Xd x0 = drop.positions();
  apply_external_forces(drop, {}, 0, 0, {});
  EXPECT_EQ((drop.positions() - x0).norm(), 0);
}

TEST(ExternalForces, VerticesInsideASolidLandOnItWithoutNormalVelocity) {
  std::vector<Solid> solids{Solid::plane({0, 0, 0}, {0, 0, 1})};
  solids[0].friction_speed = 0;
  Drop drop = drop_at({0, 0, 0.19});
  drop.velocities().colwise() = Vector3d(2, 0, -5);
  const ExternalForcesReport report = apply_external_forces(drop, solids, 1e-3, 1e-3, {});
  std::size_t colliding = 0;
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i) {
    EXPECT_GE(drop.positions()(2, i), 0);
    if (drop.contact()[i] == Contact::free) continue;
    ++colliding;
    EXPECT_EQ(drop.velocities()(2, i), 0);
    EXPECT_DOUBLE_EQ(drop.velocities()(0, i), 2);  // Eq 1 keeps the tangential part
    EXPECT_EQ(drop.contact_solid()[i], 0);
  }
  EXPECT_EQ(report.colliding, colliding);
  EXPECT_GT(colliding, 0u);
}

TEST(ExternalForces, ASourceStopsWhatComesFromItsFront) {
  std::vector<Solid> solids{Solid::disc({0, 0, 0}, {0, 0, -1}, 0.4)};
  solids[0].inflow = Inflow{10, {0, 0, 0}, 0.4, 0, 1};
  const auto collide = [&](double height, double speed, double dt) {
    Drop drop = drop_at({0, 0, height});
    drop.velocities().colwise() = Vector3d(0, 0, speed);
    const Eigen::Matrix3Xd start = drop.positions();
    const std::size_t colliding = apply_external_forces(drop, solids, dt, dt, {}).colliding;
    if (colliding == 0)
      EXPECT_LT((drop.positions() - start - dt * drop.velocities()).norm(), 1e-14);
    else
      for (std::uint32_t i = 0; i < drop.num_rows(); ++i) EXPECT_LE(drop.positions()(2, i), 1e-15);
    return colliding;
  };
  for (const double dt : {0.0, 1e-3}) {
    EXPECT_GT(collide(-0.199, 1, dt), 0u);  // from below, where liquid comes out
    for (const double height : {0.1, 0.199, 0.201, 0.3}) EXPECT_EQ(collide(height, -1, dt), 0u) << height;
  }
  EXPECT_GT(collide(-0.25, 200, 1e-3), 0u);  // however far it goes in one step

  Drop inside = drop_at({0, 0, 0.19});
  find_contact(inside, solids, 0, 1e-6);
  EXPECT_FALSE(touches_solid(inside));
}

TEST(ExternalForces, TheContactLineIsWhereCollidingMeetsFree) {
  const std::vector<Solid> solids{Solid::plane({0, 0, 0}, {0, 0, 1})};
  Drop drop = drop_at({0, 0, 0.1});
  apply_external_forces(drop, solids, 1e-4, 1e-4, {});
  std::size_t line = 0, inside = 0;
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i) {
    const Ring ring = drop.connectivity().ring(i);
    bool next_to_free = false;
    for (int k = 0; k < ring.degree; ++k) next_to_free |= drop.contact()[ring.neighbour[k]] == Contact::free;
    if (drop.contact()[i] != Contact::free) {
      EXPECT_EQ(drop.contact()[i] == Contact::line, next_to_free);
    }
    line += drop.contact()[i] == Contact::line;
    inside += drop.contact()[i] == Contact::wetted;
  }
  EXPECT_GT(line, 5u);
  EXPECT_GT(inside, 5u);
}

/// Eq 2 over decades of slip speed around epsilon.
TEST(ExternalForces, FrictionTakesEpsilonOffTheSlipAndNoMore) {
  for (const double epsilon : {1e-3, 0.1, 10.0})
    for (const double speed : {1e-6, 1e-2, 0.099, 0.1, 0.101, 1.0, 100.0}) {
      std::vector<Solid> solids{Solid::plane({0, 0, 0}, {0, 0, 1})};
      solids[0].friction_speed = epsilon;
      Drop drop = drop_at({0, 0, 0.2 - 1e-6});
      drop.velocities().colwise() = Vector3d(speed, 0, 0);
      ExternalForcesOptions options;
      options.gravity.setZero();
      options.friction_per_step = true;
      apply_external_forces(drop, solids, 1e-9, 1e-9, options);
      for (std::uint32_t i = 0; i < drop.num_rows(); ++i)
        if (is_colliding(drop.contact()[i])) {
          EXPECT_NEAR(drop.velocities()(0, i), std::max(0.0, speed - epsilon), 1e-12 * speed);
        }
    }
}

TEST(ExternalForces, FrictionDoesNotDependOnTheTimeStepUnlessAsked) {
  const auto speed_after = [](int steps) {
    std::vector<Solid> solids{Solid::plane({0, 0, 0}, {0, 0, 1})};
    solids[0].friction_speed = 0.5;
    Drop drop = drop_at({0, 0, 0.2});
    drop.velocities().colwise() = Vector3d(100, 0, 0);
    ExternalForcesOptions options;
    options.gravity = Vector3d(0, 0, -1);
    const double dt = 0.05 / steps;
    run(drop, solids, steps, dt, options);
    for (std::uint32_t i = 0; i < drop.num_rows(); ++i)
      if (drop.contact()[i] == Contact::line) return drop.velocities()(0, i);
    return std::numeric_limits<double>::quiet_NaN();
  };
  EXPECT_NEAR(speed_after(12), 100 - 0.5 * 12, 1e-9);  // 12 steps of 1/240 s
  EXPECT_NEAR(speed_after(48), speed_after(12), 0.5);
}

TEST(ExternalForces, WettedVerticesStayAndTheLastColliderMayLeave) {
  const std::vector<Solid> solids{Solid::plane({0, 0, 0}, {0, 0, 1})};
  Drop sitting = drop_at({0, 0, 0.1});
  run(sitting, solids, 1, 1e-3);
  const auto wetted = [](const Drop& drop) {
    return std::count_if(drop.contact(), drop.contact() + drop.num_rows(), is_colliding);
  };
  const auto before = wetted(sitting);
  sitting.velocities().colwise() = Vector3d(0, 0, 50);  // pulled up as a whole
  run(sitting, solids, 1, 1e-3);
  EXPECT_EQ(wetted(sitting), before);
  Drop touching = drop_at({0, 0, 0.2 - 1e-4});
  run(touching, solids, 1, 1e-4);
  ASSERT_EQ(wetted(touching), 1);  // the bottom vertex, without a wetted face
  touching.velocities().colwise() = Vector3d(0, 0, 50);
  run(touching, solids, 1, 1e-3);
  EXPECT_EQ(wetted(touching), 0);
}

TEST(ExternalForces, NumbersThatAreNotFiniteAreAnError) {
  Drop drop = drop_at({0, 0, 1});
  drop.velocities()(1, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(apply_external_forces(drop, {}, 1e-3, 1e-3, {}), NumericsError);
}

}  // namespace
}  // namespace meniscus
