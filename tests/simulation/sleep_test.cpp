// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/simulation/simulation.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

namespace meniscus {
namespace {

using Eigen::Vector3d;

/// Two caps that rest on a plate within their two angles, 1 cm apart.
Scene two_at_rest() {
  Scene scene = default_scene();
  scene.sleep = true;
  scene.time_step = 1.0 / 480;
  scene.solids.emplace_back();
  scene.solids[0].name = "plate";
  scene.solids[0].advancing_angle = 1.9;
  scene.solids[0].receding_angle = 0.8;
  for (const double x : {0.0, 1.0}) {
    DropSpec& drop = scene.drops.emplace_back();
    drop.shape = DropShape::cap;
    drop.on = "plate";
    drop.center = Vector3d(x, 0, 0);
    drop.radius = 0.15;
  }
  return scene;
}

StepReport run_until(Simulation& simulation, double time) {
  StepReport report;
  while (simulation.time() < time) report = simulation.step();
  return report;
}

TEST(Sleep, DropsAtRestFallAsleepAndTheirBitsStay) {
  Simulation simulation(two_at_rest());
  const StepReport report = run_until(simulation, 1.5);
  EXPECT_EQ(report.asleep, 2u);
  EXPECT_EQ(report.asleep_triangles, report.triangles);
  EXPECT_EQ(report.stage_seconds, (std::array<double, num_stages>{}));
  const Drop before = simulation.drops()[0];
  run_until(simulation, 1.6);
  EXPECT_EQ(before.positions(), simulation.drops()[0].positions());
  EXPECT_EQ(simulation.drops()[0].velocities().norm(), 0);
  EXPECT_NEAR(simulation.volume() / simulation.target_volume(), 1, 1e-9);
}

TEST(Sleep, NothingSleepsUnlessAsked) {
  Scene scene = two_at_rest();
  scene.sleep = false;
  Simulation simulation(scene);
  EXPECT_EQ(run_until(simulation, 1.5).asleep, 0u);
}

TEST(Sleep, AFallingDropWakesTheOneItMeetsAndNoOther) {
  Scene scene = two_at_rest();
  scene.gravity = Vector3d(0, 0, -20);
  DropSpec& falling = scene.drops.emplace_back();
  falling.radius = 0.1;
  falling.center = Vector3d(0, 0, 0.5 * 20 * 1.6 * 1.6 + 0.2);  // meets the first after about 1.6 s
  Simulation simulation(scene);
  EXPECT_EQ(run_until(simulation, 1.5).asleep, 2u);
  bool first_woke = false, second_woke = false;
  while (simulation.time() < 1.61) {
    simulation.step();
    for (const Drop& drop : simulation.drops()) {
      if (drop.id() == 1) second_woke |= drop.rest_time() < 0.05;
      if (drop.id() == 0) first_woke |= drop.rest_time() < 0.05;
    }
  }
  EXPECT_TRUE(first_woke);
  EXPECT_FALSE(second_woke);
}

TEST(Sleep, AMovingSolidWakesTheDropThatItMeets) {
  Scene scene = two_at_rest();
  SolidSpec& button = scene.solids.emplace_back();
  button.shape = SolidShape::sphere;
  button.center = Vector3d(-4, 0, 0.1);
  button.radius = 0.2;
  button.keys = {{1.5, Vector3d(0, 0, 0)}, {1.6, Vector3d(3.5, 0, 0)}};  // up to 0.5 from the first drop
  Simulation simulation(scene);
  EXPECT_EQ(run_until(simulation, 1.5).asleep, 2u);
  EXPECT_EQ(run_until(simulation, 1.6).asleep, 1u);
}

TEST(Sleep, BitsDoNotDependOnThreads) {
  const auto run = [](std::size_t threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    Simulation simulation(two_at_rest());
    run_until(simulation, 0.8);
    return simulation.drops();
  };
  const std::vector<Drop> one = run(1), two = run(2);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t d = 0; d < one.size(); ++d) {
    EXPECT_EQ(one[d].positions(), two[d].positions());
    EXPECT_EQ(one[d].rest_time(), two[d].rest_time());
  }
}

}  // namespace
}  // namespace meniscus
