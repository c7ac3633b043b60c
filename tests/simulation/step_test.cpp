// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/simulation/step.h"

#include "meniscus/geometry/inspect.h"
#include "meniscus/geometry/measure.h"
#include "meniscus/geometry/shapes.h"
#include "meniscus/simulation/oscillation.h"
#include "meniscus/simulation/simulation.h"
#include "meniscus/state/contact_line.h"
#include "meniscus/state/ledger.h"
#include "support/knot.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <tuple>

namespace meniscus {
namespace {

using Eigen::Vector3d;

StepOptions free_drop_options() {
  StepOptions options;
  options.gravity.setZero();
  options.liquid.viscosity = 0;
  options.remesh = false;
  return options;
}

Drop step(Drop drop, double time, double dt, const StepOptions& options, StepReport& report) {
  Remesher remesher;
  std::vector<Drop> pieces = step_drop(std::move(drop), {}, time, dt, options, remesher, report);
  EXPECT_EQ(pieces.size(), 1u);
  return std::move(pieces.front());
}

TEST(Step, CalibratedModeTwoRunsAtRayleighsFrequency) {
  // sqrt(8 sigma/(rho R^3)) = 268.33 rad/s for R = 0.2 cm of water; 5 %, 2,562 vertices, dt = 1/5000.
  const OscillationResult result = measure_oscillation(16, 0.05, 1.0 / 5000, 700, free_drop_options());
  EXPECT_NEAR(result.angular_frequency / result.rayleigh, 1, 0.02);
  EXPECT_NEAR(result.rayleigh, 268.33, 0.01);
}

TEST(Step, CalibratedModeTwoKeepsItsFrequencyAtLargeSteps) {
  // The phase of a step is 0.28 and 0.56. Without the correction the frequency is 5.5 and 16 % low.
  for (const double rate : {960.0, 480.0}) {
    const OscillationResult result =
        measure_oscillation(16, 0.05, 1 / rate, static_cast<int>(0.08 * rate), free_drop_options());
    EXPECT_NEAR(result.angular_frequency / result.rayleigh, 1, 0.02) << rate;
  }
}

TEST(Step, TheFrequencyHardlyDependsOnTheTimeStep) {
  // Fixed gamma would change it by a factor of 2 from one of these steps to the next but one.
  const double fine = measure_oscillation(8, 0.05, 1.0 / 8000, 1200, free_drop_options()).angular_frequency;
  const double coarse = measure_oscillation(8, 0.05, 1.0 / 2000, 300, free_drop_options()).angular_frequency;
  EXPECT_NEAR(coarse / fine, 1, 0.04);
}

TEST(Step, VolumeDoesNotDriftInTenThousandSteps) {
  StepOptions options = free_drop_options();
  Drop drop = oscillating_drop(16, 0.2, 0.05);
  StepReport report;
  for (int n = 1; n <= 10000; ++n) drop = step(std::move(drop), n / 5000.0, 1.0 / 5000, options, report);
  EXPECT_LT(std::abs(drop.volume() / drop.target_volume() - 1), 1e-6);
  EXPECT_LT(report.worst_volume_error, 1e-6);
}

/// How far the centre of a ball is from free fall after 100 steps, relative to the way.
double free_fall_error(Level level, bool remesh, double radius = 0.2) {
  StepOptions options;
  options.level = level;
  options.paper.damping_rate = 0;
  options.remesh = remesh;
  const double dt = 1.0 / 960;
  const int n = 100;
  Drop drop(make_icosphere({0, 0, 0}, radius, 8));
  StepReport report;
  for (int k = 1; k <= n; ++k) drop = step(std::move(drop), k * dt, dt, options, report);
  const double expected = -0.5 * 981 * dt * dt * n * (n + 1);
  return std::abs(solid_centroid(drop.mesh()).z() / expected - 1);
}

TEST(Step, AWholeStepInFreeFallIsFreeFall) {
  for (const Level level : {Level::paper, Level::calibrated}) {
    EXPECT_LT(free_fall_error(level, false), 1e-7);
    // On the uneven mesh that the default band makes of this ball (about 200 vertices) surface tension
    // does not balance to the last digit. Which mesh it makes hangs on the last bits, and the error with it (1e-6 to
    // 1e-3): the mean over balls that hardly differ tells.
    constexpr int balls = 8;
    double mean = 0;
    for (int k = 0; k < balls; ++k) mean += free_fall_error(level, true, 0.2 * (1 + 1e-7 * k)) / balls;
    EXPECT_LT(mean, 5e-4);
  }
}

TEST(Step, ASpeckDoesNotDriveItself) {
  // The normals that the volume is given back along do not add up to nothing.
  Drop drop(make_knot());
  StepOptions options = free_drop_options();
  StepReport report;
  for (int k = 1; k <= 200; ++k) drop = step(std::move(drop), k * 1e-3, 1e-3, options, report);
  EXPECT_LT(bounding_box(drop).center().norm(), 0.02) << "cm, in 0.2 s; it was 1.26";
}

/// No energy of a speck's surface moves its vertices that fast: it goes on with their mean.
TEST(Step, ASpeckWhoseVerticesRushKeepsItsMeanMotion) {
  StepOptions options = free_drop_options();
  options.band = {0.02, 0.06, 0.5};
  const double energy_speed = std::sqrt(6 * 72 / 0.01);  // cm/s, of R = 0.01 cm
  for (const double share : {0.5, 200.0}) {
    Drop drop(make_icosphere({0, 0, 0}, 0.01, 2));
    drop.velocities().colwise() = Vector3d(5, 0, 0);
    drop.velocities().col(0) += share * energy_speed * Vector3d::UnitZ();
    const Vector3d motion = mean_motion(drop).velocity;
    StepReport report;
    drop = step(std::move(drop), 1e-8, 1e-8, options, report);
    EXPECT_LT((mean_motion(drop).velocity - motion).norm(), 1e-9) << share;
    EXPECT_EQ(top_speed(drop, motion) > 1, share < 1) << share << ": " << top_speed(drop, motion) << " cm/s";
  }
}

/// Faces are looked at again once vertices have moved by a thousandth of edge_min since a look found nothing.
TEST(Step, ADropThatHardlyMovesIsNotLookedAtAgain) {
  StepOptions options;
  options.band = {0.02, 0.06, 0.5};
  options.gravity.setZero();
  Drop drop(make_icosphere({0, 0, 0}, 0.2, 3));
  const double dt = 1.0 / 960, slack = 1e-3 * options.band.edge_min;
  StepReport report;
  for (int n = 0; n < 200; ++n) drop = step(std::move(drop), dt, dt, options, report);  // it comes to rest
  const double before = drop.slack();
  ASSERT_GT(before, 0);
  const Eigen::Matrix3Xd x = drop.positions();
  drop = step(std::move(drop), dt, dt, options, report);
  const double moved = std::sqrt((drop.positions() - x).colwise().squaredNorm().maxCoeff());
  ASSERT_LT(moved, 0.1 * slack);
  EXPECT_NEAR(drop.slack(), before - moved, 1e-12) << "it draws from its slack";

  drop.velocities().row(2).setConstant(1.5 * slack / dt);
  drop = step(std::move(drop), dt, dt, options, report);
  EXPECT_EQ(drop.slack(), slack) << "it moved further, was looked at, and nothing was found";
  drop.topology_changed();
  EXPECT_EQ(drop.slack(), 0);
}

TEST(Step, StaysFiniteAndSoundAtAnyTimeStep) {
  for (const Level level : {Level::paper, Level::calibrated})
    for (const double rate : {15.0, 60.0, 240.0, 960.0}) {
      StepOptions options = free_drop_options();
      options.level = level;
      options.remesh = true;
      Drop drop = oscillating_drop(8, 0.2, 0.2);
      StepReport report;
      for (int n = 1; n <= 60; ++n) drop = step(std::move(drop), n / rate, 1 / rate, options, report);
      EXPECT_NEAR(drop.volume() / drop.target_volume(), 1, 1e-3) << rate;
      const double sphere_area = std::cbrt(36 * M_PI * std::pow(drop.target_volume(), 2));
      drop.workspace().geometry.compute(std::as_const(drop).positions(), drop.connectivity());
      EXPECT_LT(drop.workspace().geometry.area(), 1.05 * sphere_area) << rate;  // it has become round
    }
}

Scene three_drops_on_a_plate() {
  Scene scene = default_scene();
  scene.solids.emplace_back();
  scene.time_step = 1.0 / 960;
  for (int k = 0; k < 3; ++k) {
    DropSpec drop;
    drop.center = Vector3d(0.6 * k, 0, 0.2 + 0.02 * k);
    drop.velocity = Vector3d(0, 5 * k, -10);
    scene.drops.push_back(drop);
  }
  return scene;
}

TEST(Simulation, SameBitsWithOneThreadAndTwo) {
  const auto run = [](std::size_t threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    Simulation simulation(three_drops_on_a_plate());
    for (int n = 0; n < 100; ++n) simulation.step();
    return simulation;
  };
  const Simulation one = run(1), two = run(2);
  ASSERT_EQ(one.drops().size(), two.drops().size());
  for (std::size_t d = 0; d < one.drops().size(); ++d) {
    ASSERT_EQ(one.drops()[d].num_rows(), two.drops()[d].num_rows());
    EXPECT_EQ(one.drops()[d].positions(), two.drops()[d].positions());
    EXPECT_EQ(one.drops()[d].velocities(), two.drops()[d].velocities());
  }
}

TEST(Simulation, DropsOnAPlateKeepTheirVolumeAndComeToRest) {
  Simulation simulation(three_drops_on_a_plate());
  while (simulation.time() < 1) simulation.step();
  for (const Drop& drop : simulation.drops()) {
    EXPECT_NEAR(drop.volume() / drop.target_volume(), 1, 1e-6);
    EXPECT_GE(drop.positions().row(2).minCoeff(), -1e-12);
    EXPECT_LT(top_speed(drop), 0.1);
  }
}

/// A drop of R = 0.2 cm of water, laid on a plane without hysteresis: height and mean contact radius at
/// rest over those of Young-Laplace (integrated elsewhere: the sources of data/scenes/resting_*.json).
struct RestingError {
  double height, radius;
};
RestingError resting_error(double angle_degrees, double height, double radius) {
  Scene scene = default_scene();
  scene.solids.emplace_back();
  scene.solids[0].advancing_angle = scene.solids[0].receding_angle = angle_degrees * M_PI / 180;
  scene.time_step = 1.0 / 960;
  scene.mesh.edge_min = 0.02;
  scene.mesh.edge_max = 0.06;
  scene.drops.emplace_back();
  scene.drops[0].center = Vector3d(0, 0, 0.2);
  Simulation simulation(scene);
  while (simulation.time() < 0.8) simulation.step();
  const Drop& drop = simulation.drops().front();
  EXPECT_LT(top_speed(drop), 0.1);
  double top = 0;
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i)
    if (drop.connectivity().degree(i) > 0) top = std::max(top, drop.positions()(2, i));
  return {top / height - 1, std::sqrt(wetted_area(drop) / M_PI) / radius - 1};
}

TEST(Simulation, ALiquidWithoutTensionLandsWithFiniteNumbers) {
  Scene scene = three_drops_on_a_plate();
  scene.liquid.surface_tension = 0;
  Simulation simulation(scene);
  for (int n = 0; n < 20; ++n) simulation.step();  // throws NumericsError otherwise
  for (const Drop& drop : simulation.drops()) EXPECT_TRUE(std::isfinite(top_speed(drop)));
}

TEST(Simulation, ADumbbellPinchesIntoSoundDropsAndTheLedgerAddsUp) {
  Scene scene = default_scene();
  scene.gravity.setZero();
  scene.time_step = 5e-4;
  scene.mesh.edge_min = 0.02;
  scene.mesh.edge_max = 0.06;
  std::vector<Drop> drops;
  drops.emplace_back(make_dumbbell(1.2, 0.2, 0.05, 0.04));
  const double volume = drops.front().target_volume();
  Simulation simulation(scene, std::move(drops));
  std::size_t cuts = 0;
  for (int n = 0; n < 60; ++n) {
    cuts += simulation.step().cuts;
    EXPECT_NEAR(simulation.target_volume() / volume, 1, 1e-12);
    EXPECT_NEAR(simulation.volume() / volume, 1, 5e-3);
    for (const Drop& drop : simulation.drops()) EXPECT_TRUE(inspect(to_mesh_data(drop.mesh())).sound) << n;
  }
  EXPECT_GE(cuts, 1u);
  EXPECT_GE(simulation.drops().size(), 2u);
}

TEST(Simulation, CalibratedDropsRestAtYoungLaplace) {
  for (const auto& [angle, height, radius] : {std::tuple{60.0, 0.167592241, 0.334000777},
                                              {90.0, 0.225321022, 0.267454373},
                                              {120.0, 0.274691987, 0.209967817}}) {
    const RestingError error = resting_error(angle, height, radius);
    EXPECT_LT(std::abs(error.height), 0.01) << angle;
    EXPECT_LT(std::abs(error.radius), 0.02) << angle;
  }
}

}  // namespace
}  // namespace meniscus
