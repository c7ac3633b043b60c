// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/simulation/source.h"

#include "meniscus/simulation/simulation.h"
#include "support/judge.h"

#include <gtest/gtest.h>

#include <cmath>

namespace meniscus {
namespace {

using Eigen::Vector3d;

Scene tap(double speed) {
  Scene scene = default_scene();
  scene.time_step = 1.0 / 960;
  scene.mesh.edge_min = 0.03;
  scene.mesh.edge_max = 0.09;
  scene.sources.emplace_back();
  scene.sources[0].speed = speed;
  return scene;
}

double flow_of(const SourceSpec& source) { return source.speed * pi * source.radius * source.radius; }

TEST(SourceFeed, GivesExactlySpeedTimesAreaTimesTime) {
  Scene scene = tap(10);
  const std::vector<Solid> solids = make_solids(scene);
  SourceFeed feed;
  std::vector<Drop> drops;
  int next_id = 5;
  double added = 0;
  for (int n = 0; n < 300; ++n) {
    const FeedReport report = feed.feed(drops, solids, n * 1e-4, (n + 1) * 1e-4, scene.mesh, next_id);
    added += report.volume_added;
    EXPECT_NEAR(added + feed.waiting(), (n + 1) * 1e-4 * flow_of(scene.sources[0]), 1e-15);
  }
  ASSERT_EQ(drops.size(), 1u);  // it waited for enough, then fed the one that hangs there
  EXPECT_EQ(drops[0].id(), 5);
  EXPECT_EQ(next_id, 6);
  EXPECT_EQ(feed.waiting(), 0);
  EXPECT_NEAR(drops[0].inflow(), flow_of(scene.sources[0]), 1e-12);
  EXPECT_EQ(judge::defect(drops[0].mesh()), "");
}

TEST(SourceFeed, FlowsFromStartToStopOnly) {
  Scene scene = tap(50);
  scene.sources[0].start = 0.0101;
  scene.sources[0].stop = 0.0303;
  Simulation simulation(scene);
  double added = 0;
  while (simulation.time() < 0.04) added += simulation.step().volume_added;
  EXPECT_NEAR(added / (flow_of(scene.sources[0]) * 0.0202), 1, 1e-12);
}

/// Where nothing was before, rounding is of the order of what was added.
TEST(SourceFeed, StartsFromNothingUnderTheJudge) {
  Scene scene = tap(50);
  scene.time_step = 1.0 / 480;
  scene.sources[0].radius = 0.1;
  Simulation simulation(scene);
  simulation.set_verify(Verify::everything);
  for (int n = 0; n < 4; ++n) EXPECT_NO_THROW(simulation.step());
  EXPECT_EQ(simulation.drops().size(), 1u);
}

/// Runs a tap and checks at every step that the ledger adds up and that all is sound.
void check_tap(double speed, double seconds) {
  Scene scene = tap(speed);
  Simulation simulation(scene);
  double added = 0;
  while (simulation.time() < seconds) {
    const StepReport report = simulation.step();
    added += report.volume_added;
    ASSERT_EQ(report.deleted, 0u);
    ASSERT_NEAR(simulation.target_volume(), added, 1e-12);
    ASSERT_NEAR(simulation.volume(), added, 0.05 * added);  // remeshing changes it after the correction
    for (const Drop& drop : simulation.drops()) ASSERT_EQ(judge::defect(drop.mesh()), "") << simulation.time();
  }
  EXPECT_NEAR(simulation.volume(), added, 0.005 * added);
  EXPECT_NEAR(added, flow_of(scene.sources[0]) * simulation.time(), 1e-3);  // the rest waits for a new drop
  bool hangs = false;
  for (const Drop& drop : simulation.drops()) hangs = hangs || hangs_from(drop, 0);
  EXPECT_TRUE(hangs);
}

TEST(Sources, ADrippingTapIsSoundAndItsLedgerAddsUp) { check_tap(5, 0.1); }
TEST(Sources, AJetIsSoundAndItsLedgerAddsUp) { check_tap(60, 0.02); }

TEST(Sources, AJetFallsAsAStreamAndADropHangs) {
  // The tip of a jet is at v t + g t^2/2 or above (tension pulls it back); slow liquid hangs from the disc.
  Simulation jet(tap(80)), drip(tap(5));
  while (jet.time() < 0.03) jet.step();
  while (drip.time() < 0.03) drip.step();
  const auto tip = [](const Simulation& simulation) {
    double low = 0;
    for (const Drop& drop : simulation.drops()) low = std::min(low, drop.positions().row(2).minCoeff());
    return -low;
  };
  const double free_fall = 80 * 0.03 + 0.5 * 981 * 0.03 * 0.03;
  EXPECT_LT(tip(jet), 1.05 * free_fall);
  EXPECT_GT(tip(jet), 0.6 * free_fall);
  EXPECT_LT(tip(drip), 0.2);
}

}  // namespace
}  // namespace meniscus
