// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/core/error.h"
#include "meniscus/geometry/shapes.h"
#include "meniscus/scene/read_scene.h"
#include "meniscus/simulation/simulation.h"
#include "support/judge.h"

#include <gtest/gtest.h>

#include <limits>

namespace meniscus {
namespace {

Drop long_spheroid() { return Drop(make_ellipsoid({0, 0, 0}, {0.16, 0.16, 0.32}, 0.04)); }

TEST(Recovery, ABadSubstepIsTakenBackAndRedoneInHalves) {
  // gamma dt of 50 squared edges turns the paper's triangles over on a 2 : 1 spheroid.
  StepOptions options;
  options.level = Level::paper;
  options.gravity.setZero();
  options.paper.curvature_flow_coefficient = 8;
  options.band = {0.02, 0.06, 0.5};
  Remesher remesher;
  StepReport report;
  std::vector<Drop> drops;
  drops.push_back(long_spheroid());
  const double volume = drops[0].volume();
  for (int n = 1; n <= 6; ++n) {
    try {
      drops = step_drop(std::move(drops[0]), {}, n * 0.01, 0.01, options, remesher, report);
    } catch (const NumericsError& error) {  // it may give up, if it says so
      EXPECT_NE(std::string(error.what()).find("smaller time step"), std::string::npos);
      break;
    }
    ASSERT_EQ(drops.size(), 1u);
    ASSERT_EQ(judge::topology_defect(drops[0].mesh()), "");
    EXPECT_NEAR(drops[0].volume() / volume, 1, 0.05);
  }
  EXPECT_GT(report.recoveries, 0u);
}

TEST(Recovery, SoundStepsAreNotTakenBack) {
  StepOptions options;
  Remesher remesher;
  StepReport report;
  std::vector<Drop> drops;
  drops.push_back(long_spheroid());
  for (int n = 1; n <= 10; ++n)
    drops = step_drop(std::move(drops[0]), {}, n / 960.0, 1 / 960.0, options, remesher, report);
  EXPECT_EQ(report.recoveries, 0u);
}

TEST(Recovery, WhatCannotBeMendedEndsInAClearError) {
  for (const Level level : {Level::paper, Level::calibrated, Level::pressure}) {
    StepOptions options;
    options.level = level;
    Drop drop = long_spheroid();
    drop.velocities()(1, 3) = std::numeric_limits<double>::quiet_NaN();
    Remesher remesher;
    StepReport report;
    EXPECT_THROW(step_drop(std::move(drop), {}, 0.001, 0.001, options, remesher, report), NumericsError);
  }
}

/// Drops of `rain`, each a step before its surface met itself in an earlier version: at a closing gap between two
/// drops that had merged, at a film that touched down on the wetted area, at a fold of the rim.
class FoldsOnPlate : public testing::TestWithParam<int> {};

TEST_P(FoldsOnPlate, StaySound) {
  const Scene scene = parse_scene(R"({
    "time_step": 0.001, "frames": 3, "steps_per_frame": 10, "mesh": { "edge_min": 0.04, "edge_max": 0.12 },
    "solids": [ { "shape": "plane", "advancing_angle_deg": 95, "receding_angle_deg": 60 } ],
    "drops": [ { "mesh": "folds_on_plate_)" +
                                      std::to_string(GetParam()) + R"(.ply" } ]
  })",
                                  "folds_on_plate", MENISCUS_DATA_DIR "/regressions");
  Simulation simulation(scene);
  const double volume = simulation.target_volume();
  for (int n = 1; n <= 30; ++n) {
    simulation.step();
    for (const Drop& drop : simulation.drops())
      ASSERT_EQ(judge::defect(drop), "") << "drop " << drop.id() << ", step " << n;
    ASSERT_NEAR(simulation.target_volume(), volume, 1e-12 * volume);
  }
}

INSTANTIATE_TEST_SUITE_P(Regressions, FoldsOnPlate, testing::Range(1, 8));

}  // namespace
}  // namespace meniscus
