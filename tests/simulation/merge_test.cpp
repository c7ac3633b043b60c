// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/geometry/shapes.h"
#include "meniscus/simulation/simulation.h"
#include "meniscus/state/ledger.h"
#include "support/judge.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

namespace meniscus {
namespace {

using Eigen::Vector3d;

Scene scene_in_flight() {
  Scene scene = default_scene();
  scene.gravity.setZero();
  scene.time_step = 5e-4;
  scene.mesh.edge_min = 0.02;
  scene.mesh.edge_max = 0.06;
  return scene;
}

Drop ball(const Vector3d& center, double radius, const Vector3d& velocity) {
  Drop drop(make_sphere(center, radius, 0.04));
  for (Eigen::Index i = 0; i < drop.velocities().cols(); ++i) drop.velocities().col(i) = velocity;
  return drop;
}

Ledger ledger_of(const Simulation& simulation) {
  Ledger sum;
  for (const Drop& drop : simulation.drops()) sum += measure_ledger(drop);
  return sum;
}

void expect_sound(const Simulation& simulation, int step) {
  for (const Drop& drop : simulation.drops())
    EXPECT_EQ(judge::defect(drop), "") << "drop " << drop.id() << ", " << step;
}

TEST(Merging, DropsThatCollideStaySoundAndBecomeOne) {
  std::vector<Drop> drops;
  drops.push_back(ball({-0.26, 0, 0.04}, 0.25, {15, 0, 0}));
  drops.push_back(ball({0.26, 0, -0.04}, 0.25, {-15, 0, 0}));
  Simulation simulation(scene_in_flight(), std::move(drops));
  const double target = simulation.target_volume();
  const Ledger start = ledger_of(simulation);
  std::size_t merges = 0;
  for (int n = 1; n <= 80; ++n) {
    merges += simulation.step().merges;
    EXPECT_NEAR(simulation.target_volume(), target, 1e-12 * target);
    expect_sound(simulation, n);
  }
  EXPECT_EQ(merges, 1u);
  ASSERT_EQ(simulation.drops().size(), 1u);
  EXPECT_NEAR(simulation.volume(), target, 1e-2 * target);
  // What one drop had, 15 cm/s times its volume, is given to the other.
  EXPECT_LT((ledger_of(simulation).momentum - start.momentum).norm(), 1e-9 * 15 * target / 2);
}

TEST(Merging, AViolentCollisionKeepsItsMomentum) {
  // A Weber number of 125: what becomes of it is a disc, and its rim. The sum of what the drops have is not zero.
  for (const Level level : {Level::calibrated, Level::pressure}) {
    Scene scene = scene_in_flight();
    scene.model = level;
    scene.gravity = {0, 0, 10};
    std::vector<Drop> drops;
    drops.push_back(ball({-0.26, 0, 0.02}, 0.25, {80, 0, 5}));
    drops.push_back(ball({0.26, 0, -0.02}, 0.25, {-55, 0, 5}));
    Simulation simulation(scene, std::move(drops));
    const Ledger start = ledger_of(simulation);
    for (int n = 0; n < 20; ++n) simulation.step();
    const Ledger end = ledger_of(simulation);
    const Eigen::Vector3d wanted = start.momentum / start.volume + simulation.time() * scene.gravity;
    EXPECT_LT((end.momentum / end.volume - wanted).norm(), 1e-3 * 67) << level_name(level);
  }
}

TEST(Merging, DropsThatWouldFlyThroughEachOtherInOneStepMeet) {
  Scene scene = scene_in_flight();
  scene.time_step = 0.01;
  std::vector<Drop> drops;
  drops.push_back(ball({-0.5, 0, 0}, 0.2, {60, 0, 0}));  // 1.2 cm closer a step, from 0.6 cm apart
  drops.push_back(ball({0.5, 0, 0}, 0.2, {-60, 0, 0}));
  Simulation simulation(scene, std::move(drops));
  EXPECT_EQ(simulation.step().merges, 1u);
  EXPECT_EQ(simulation.drops().size(), 1u);
}

TEST(Merging, ManyDropsOnOneBecomeOneInOneStep) {
  std::vector<Drop> drops;
  drops.push_back(ball({0, 0, 0}, 0.3, Vector3d::Zero()));
  for (const auto& way : {Vector3d(1, 0.1, 0.05), Vector3d(-1, 0.07, 0.02), Vector3d(0.03, 1, 0.1),
                          Vector3d(0.1, -1, 0.02), Vector3d(0.04, 0.06, 1), Vector3d(0.05, 0.02, -1)})
    drops.push_back(ball(0.38 * way.normalized(), 0.12, Vector3d::Zero()));
  Simulation simulation(scene_in_flight(), std::move(drops));
  const double target = simulation.target_volume();
  EXPECT_EQ(simulation.step().merges, 6u);
  EXPECT_EQ(simulation.drops().size(), 1u);
  EXPECT_NEAR(simulation.target_volume(), target, 1e-12 * target);
  expect_sound(simulation, 1);
}

TEST(Merging, PuddlesOnAPlateGrowTogetherToOneContactLine) {
  Scene scene = default_scene();
  scene.time_step = 5e-4;
  scene.mesh.edge_min = 0.02;
  scene.mesh.edge_max = 0.06;
  SolidSpec plate;
  plate.advancing_angle = plate.receding_angle = 1.2;
  scene.solids.push_back(plate);
  std::vector<Drop> drops;
  for (const double x : {-0.19, 0.19}) drops.emplace_back(make_cap({x, 0.013 * x, 0}, {0, 0, 1}, 0.2, 1.5, 0.04));
  Simulation simulation(scene, std::move(drops));
  const double target = simulation.target_volume();
  for (int n = 1; n <= 60; ++n) {
    simulation.step();
    expect_sound(simulation, n);
  }
  ASSERT_EQ(simulation.drops().size(), 1u);
  EXPECT_NEAR(simulation.volume(), target, 1e-2 * target);
  const Drop& drop = simulation.drops().front();
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i) {
    if (drop.connectivity().degree(i) > 0 && is_colliding(drop.contact()[i])) {
      EXPECT_NEAR(drop.positions()(2, i), 0, 1e-12);
    }
  }
}

TEST(Merging, CanBeTurnedOff) {
  Scene scene = scene_in_flight();
  scene.topology.merge = false;
  std::vector<Drop> drops;
  drops.push_back(ball({-0.1, 0, 0}, 0.2, Vector3d::Zero()));
  drops.push_back(ball({0.1, 0, 0}, 0.2, Vector3d::Zero()));
  Simulation simulation(scene, std::move(drops));
  EXPECT_EQ(simulation.step().merges, 0u);
  EXPECT_EQ(simulation.drops().size(), 2u);
}

TEST(Merging, SameBitsWithOneThreadAndTwo) {
  const auto after = [](std::size_t threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    std::vector<Drop> drops;
    for (int k = 0; k < 4; ++k) drops.push_back(ball({0.42 * k, 0.02 * k, 0}, 0.2, {k % 2 == 0 ? 20.0 : -20.0, 0, 0}));
    Simulation simulation(scene_in_flight(), std::move(drops));
    for (int n = 0; n < 20; ++n) simulation.step();
    return simulation;
  };
  const Simulation one = after(1), two = after(2);
  ASSERT_EQ(one.drops().size(), two.drops().size());
  for (std::size_t d = 0; d < one.drops().size(); ++d) {
    EXPECT_EQ(one.drops()[d].id(), two.drops()[d].id());
    EXPECT_EQ(one.drops()[d].positions(), two.drops()[d].positions());
    EXPECT_EQ(one.drops()[d].velocities(), two.drops()[d].velocities());
  }
}

}  // namespace
}  // namespace meniscus
