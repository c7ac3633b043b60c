// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/simulation/safe_time_step.h"

#include "meniscus/geometry/shapes.h"
#include "meniscus/simulation/simulation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace meniscus {
namespace {

std::vector<Drop> balls(const std::vector<double>& radii) {
  std::vector<Drop> drops;
  for (const double radius : radii)
    drops.emplace_back(make_icosphere({5.0 * static_cast<double>(drops.size()), 0, 0}, radius, 4));
  return drops;
}

StepOptions at(Level level) {
  StepOptions options;
  options.level = level;
  return options;
}

constexpr Level all_levels[] = {Level::paper, Level::calibrated, Level::pressure};

TEST(SafeTimeStep, IsInfiniteWithoutDropsOrForces) {
  for (const Level level : all_levels) EXPECT_TRUE(std::isinf(safe_time_step(at(level), {}, {})));
  StepOptions options = at(Level::paper);
  options.paper.curvature_flow_coefficient = 0;
  EXPECT_TRUE(std::isinf(safe_time_step(options, balls({0.2}), {})));
  options = at(Level::calibrated);
  options.liquid.surface_tension = 0;
  EXPECT_TRUE(std::isinf(safe_time_step(options, balls({0.2}), {})));
}

TEST(SafeTimeStep, IsThatOfTheSmallestDrop) {
  for (const Level level : all_levels)
    EXPECT_NEAR(safe_time_step(at(level), balls({0.3, 0.1, 0.2}), {}) / safe_time_step(at(level), balls({0.1}), {}), 1,
                1e-12);
}

TEST(SafeTimeStep, HasTheUnitsOfATime) {
  StepOptions heavy = at(Level::pressure), light = at(Level::pressure);
  heavy.liquid.density = 4;
  EXPECT_NEAR(safe_time_step(heavy, balls({0.2}), {}) / safe_time_step(light, balls({0.2}), {}), 2, 1e-9);
  StepOptions slow = at(Level::paper), fast = at(Level::paper);
  fast.paper.curvature_flow_coefficient *= 3;
  EXPECT_NEAR(safe_time_step(slow, balls({0.2}), {}) / safe_time_step(fast, balls({0.2}), {}), 3, 1e-9);
}

TEST(SafeTimeStep, IsLongAtLevelsThatCutTheirStepsAndNothingForThePaperOnSolids) {
  std::vector<Solid> plate;
  plate.push_back(Solid::plane(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()));
  for (const Level level : {Level::calibrated, Level::pressure})
    EXPECT_GT(safe_time_step(at(level), balls({0.2}), plate), 1.0 / 60);
  EXPECT_EQ(safe_time_step(at(Level::paper), balls({0.2}), plate), 0);
}

}  // namespace
}  // namespace meniscus
