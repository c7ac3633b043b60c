// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/core/error.h"
#include "meniscus/geometry/shapes.h"
#include "meniscus/simulation/choose_level.h"
#include "meniscus/simulation/safe_time_step.h"
#include "meniscus/simulation/simulation.h"
#include "support/judge.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace meniscus {
namespace {

Drop long_spheroid() { return Drop(make_ellipsoid({0, 0, 0}, {0.16, 0.16, 0.32}, 0.04)); }

StepOptions paper_options(double gamma) {
  StepOptions options;
  options.level = Level::paper;
  options.gravity.setZero();
  options.paper.curvature_flow_coefficient = gamma;
  options.band = {0.02, 0.06, 0.5};
  return options;
}

TEST(Recovery, ABadStepIsTakenBackAndRedoneInHalves) {
  // gamma dt of 50 squared edges turns the paper's triangles over on a 2 : 1 spheroid.
  StepOptions options = paper_options(8);
  Remesher remesher;
  StepReport report;
  std::vector<Drop> drops;
  drops.push_back(long_spheroid());
  const double volume = drops[0].volume();
  std::size_t recoveries = 0;
  bool gave_up = false;
  try {
    for (int n = 1; n <= 6; ++n) {
      drops = step_drop(std::move(drops[0]), {}, n * 0.01, 0.01, options, remesher, report);
      ASSERT_EQ(drops.size(), 1u);
      ASSERT_TRUE(drops[0].positions().allFinite());
      ASSERT_EQ(judge::topology_defect(drops[0].mesh()), "");
    }
    EXPECT_NEAR(drops[0].volume() / volume, 1, 0.05);
  } catch (const NumericsError& error) {
    gave_up = true;
    EXPECT_NE(std::string(error.what()).find("smaller time step"), std::string::npos);
  }
  recoveries = report.recoveries;
  EXPECT_TRUE(recoveries > 0 || gave_up);
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
  for (const Level level : {Level::paper, Level::calibrated}) {
    StepOptions options;
    options.level = level;
    Drop drop = long_spheroid();
    drop.velocities()(1, 3) = std::numeric_limits<double>::quiet_NaN();
    Remesher remesher;
    StepReport report;
    EXPECT_THROW(step_drop(std::move(drop), {}, 0.001, 0.001, options, remesher, report), NumericsError);
  }
}

TEST(SafeTimeStep, ScalesAsTheLawsDo) {
  std::vector<Drop> drops;
  drops.push_back(long_spheroid());
  EXPECT_TRUE(std::isinf(safe_time_step(StepOptions(), {})));
  // At `paper` it is gamma dt that counts; elsewhere dt goes with the root of density over tension.
  EXPECT_NEAR(safe_time_step(paper_options(0.1), drops) / safe_time_step(paper_options(0.4), drops), 4, 1e-12);
  StepOptions water, slow;
  slow.liquid.surface_tension = 18;
  EXPECT_NEAR(safe_time_step(slow, drops) / safe_time_step(water, drops), 2, 1e-12);
}

Scene scene_of_water(Accuracy accuracy, double edge_min) {
  Scene scene = default_scene();
  scene.model = Level::automatic;
  scene.accuracy = accuracy;
  scene.mesh = {edge_min, 3 * edge_min, 0.5};
  scene.drops.emplace_back();
  return scene;
}

TEST(ChooseLevel, MoreAccuracyNeverTakesLongerSubsteps) {
  const LevelChoice look = choose_level(scene_of_water(Accuracy::look, 0.02));
  const LevelChoice shape = choose_level(scene_of_water(Accuracy::shape, 0.02));
  const LevelChoice motion = choose_level(scene_of_water(Accuracy::motion, 0.02));
  EXPECT_LE(motion.longest_phase, shape.longest_phase);
  EXPECT_LE(shape.solver.tolerance, look.solver.tolerance);
  EXPECT_TRUE(shape.meets);
  EXPECT_TRUE(motion.meets);
  EXPECT_NE(motion.why.find("mode 2"), std::string::npos);
}

TEST(ChooseLevel, SaysWhenNothingMeasuredIsGoodEnough) {
  const LevelChoice coarse = choose_level(scene_of_water(Accuracy::shape, 0.079));
  EXPECT_FALSE(coarse.meets);
  EXPECT_NE(coarse.why.find("nothing measured"), std::string::npos);
}

TEST(ChooseLevel, ASimulationRunsWhatWasChosen) {
  const Scene scene = scene_of_water(Accuracy::motion, 0.04);
  const StepOptions options = make_step_options(scene);
  EXPECT_NE(options.level, Level::automatic);
  Simulation simulation(scene);
  const StepReport report = simulation.step();
  // mode 2 of R = 0.2 cm at 268.3 rad/s: the substeps keep the phase that was chosen
  EXPECT_GE(report.substeps, static_cast<int>(268 * scene.time_step / options.longest_phase));
}

}  // namespace
}  // namespace meniscus
