// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/geometry/inspect.h"
#include "meniscus/geometry/measure.h"
#include "meniscus/geometry/rigid_motion.h"
#include "meniscus/geometry/shapes.h"
#include "meniscus/operators/pressure.h"
#include "meniscus/simulation/oscillation.h"
#include "meniscus/simulation/simulation.h"
#include "meniscus/state/contact_line.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>
#include <Eigen/Geometry>

#include <cmath>
#include <numeric>
#include <utility>

namespace meniscus {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double degree = M_PI / 180;

Scene scene_in_flight(double edge_min = 0.02) {
  Scene scene = default_scene();
  scene.model = Level::pressure;
  scene.mesh.edge_min = edge_min;
  scene.mesh.edge_max = 3 * edge_min;
  scene.time_step = 1.0 / 960;
  return scene;
}

/// A drop of R = 0.2 cm laid on a plane.
Scene scene_on_plate(double receding_deg, double advancing_deg, double edge_min) {
  Scene scene = scene_in_flight(edge_min);
  scene.solids.emplace_back();
  scene.solids[0].receding_angle = receding_deg * degree;
  scene.solids[0].advancing_angle = advancing_deg * degree;
  scene.drops.emplace_back();
  scene.drops[0].center = Vector3d(0, 0, 0.2);
  return scene;
}

Simulation simulate(const Scene& scene, Drop drop) {
  std::vector<Drop> drops;
  drops.push_back(std::move(drop));
  return Simulation(scene, std::move(drops));
}

void run(Simulation& simulation, double time) {
  while (simulation.time() < time - 1e-9) simulation.step();
}

double height(const Drop& drop) {
  double top = 0;
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i)
    if (drop.connectivity().degree(i) > 0) top = std::max(top, drop.positions()(2, i));
  return top;
}

Vector3d spin(Drop& drop) {
  drop.workspace().geometry.compute(std::as_const(drop).positions(), drop.connectivity());
  return fit_rigid_motion(std::as_const(drop).positions(), std::as_const(drop).velocities(), drop.workspace().geometry)
      .rotation;
}

TEST(PressureLevel, FallsFreelyWhateverTheMesh) {
  for (const double edge_min : {0.02, 0.05}) {
    Simulation simulation = simulate(scene_in_flight(edge_min), Drop(make_icosphere({0, 0, 0}, 0.2, 8)));
    const Vector3d start = solid_centroid(simulation.drops().front().mesh());
    run(simulation, 0.1);
    // Each step moves by the new velocity: n (n + 1)/2 g dt^2.
    const double steps = static_cast<double>(simulation.num_steps()), dt = 1.0 / 960;
    const Vector3d way = solid_centroid(simulation.drops().front().mesh()) - start;
    EXPECT_NEAR(way.z() / (-0.5 * 981 * dt * dt * steps * (steps + 1)), 1, 1e-3) << edge_min;
    EXPECT_LT(std::hypot(way.x(), way.y()), 1e-3 * std::abs(way.z()));
  }
}

TEST(PressureLevel, ModeTwoRunsAtRayleighsFrequencyAtLargeSteps) {
  StepOptions options;
  options.level = Level::pressure;
  options.gravity.setZero();
  options.liquid.viscosity = 0;
  options.remesh = false;
  const OscillationResult result = measure_oscillation(16, 0.05, 1.0 / 960, 80, options);  // 2,562 vertices
  EXPECT_NEAR(result.angular_frequency / result.rayleigh, 1, 0.02);
  EXPECT_GT(result.kept_per_period, 0.9);  // backward Euler keeps 0.46
}

TEST(PressureLevel, AFlyingDropKeepsItsMomentumAndVolume) {
  Scene scene = scene_in_flight();
  scene.gravity.setZero();
  Drop drop = oscillating_drop(8, 0.2, 0.2);
  drop.velocities().colwise() += Vector3d(3, -2, 7);
  Simulation simulation = simulate(scene, std::move(drop));
  const Vector3d start = solid_centroid(simulation.drops().front().mesh());
  run(simulation, 0.1);
  const Drop& end = simulation.drops().front();
  EXPECT_LT((solid_centroid(end.mesh()) - start - 0.1 * Vector3d(3, -2, 7)).norm(), 2e-3 * 0.1 * 8);
  EXPECT_NEAR(end.volume() / end.target_volume(), 1, 1e-3);
}

TEST(PressureLevel, AFlyingDropKeepsItsAngularMomentum) {
  Scene scene = scene_in_flight();
  scene.gravity.setZero();
  for (const DropShape shape : {DropShape::sphere, DropShape::ellipsoid}) {
    DropSpec spec;
    spec.shape = shape;
    spec.semi_axes = Vector3d(0.2, 0.2, 0.16);
    spec.angular_velocity = Vector3d(0, 0, 30);
    scene.drops = {spec};
    Simulation simulation(scene);
    const auto momentum = [](Drop drop) {  // about the axis of symmetry: I_zz omega
      double inertia = 0;
      const auto x = std::as_const(drop).positions();
      for (const auto& [a, b, c] : drop.connectivity().triangles()) {
        if (a == Connectivity::removed) continue;
        const Vector3d p = x.col(a), q = x.col(b), r = x.col(c), s = p + q + r;
        const double v = p.dot(q.cross(r)) / 120;
        for (const Vector3d& y : {p, q, r, s}) inertia += v * (y.x() * y.x() + y.y() * y.y());
      }
      return inertia * spin(drop).z();
    };
    const double before = momentum(simulation.drops().front());
    run(simulation, 0.05);
    EXPECT_NEAR(momentum(simulation.drops().front()) / before, 1, 0.01);
  }
}

TEST(PressureLevel, RestsAtYoungLaplace) {
  // Height and contact radius for R = 0.2 cm: see data/scenes/resting_90.json.
  Simulation simulation(scene_on_plate(90, 90, 0.02));
  run(simulation, 0.4);
  const Drop& drop = simulation.drops().front();
  const double scale = std::cbrt(drop.target_volume() / (4.0 / 3 * M_PI * 0.008));
  EXPECT_LT(top_speed(drop), 0.1);
  EXPECT_NEAR(height(drop) / (0.225321022 * scale), 1, 0.005);
  EXPECT_NEAR(std::sqrt(wetted_area(drop) / M_PI) / (0.267454373 * scale), 1, 0.005);
}

TEST(PressureLevel, ADropThatSticksDoesNotCreep) {
  Scene scene = scene_on_plate(30, 90, 0.03);
  scene.gravity = Vector3d(981, 0, 0);  // the plane stands upright
  scene.time_step = 1.0 / 240;
  DropSpec& drop = scene.drops[0];
  scene.solids[0].name = "pane";
  drop.shape = DropShape::cap;
  drop.on = "pane";
  drop.radius = 0.12;
  drop.angle = 60 * degree;
  Simulation simulation(scene);
  run(simulation, 0.5);
  const Vector3d settled = solid_centroid(simulation.drops().front().mesh());
  run(simulation, 1);
  EXPECT_LT((solid_centroid(simulation.drops().front().mesh()) - settled).norm(), 1e-5);
}

TEST(PressureLevel, ALargeDropSlidesDown) {
  Scene scene = scene_on_plate(60, 90, 0.04);
  scene.gravity = Vector3d(981, 0, 0);
  scene.drops[0].radius = 0.3;
  scene.drops[0].center.z() = 0.29;
  Simulation simulation(scene);
  run(simulation, 0.3);
  EXPECT_GT(solid_centroid(simulation.drops().front().mesh()).x(), 0.5);
}

TEST(PressureLevel, TurningTheWorldTurnsTheResult) {
  const Matrix3d turn = Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const auto after = [](const Matrix3d& R) {
    Scene scene = scene_on_plate(60, 90, 0.01);  // no edge leaves the band in these steps: ties would be broken by
    scene.mesh.edge_max = 0.2;                   // rounding, and differ
    scene.drops.clear();
    scene.solids[0].normal = R * Vector3d::UnitZ();
    scene.gravity = R * Vector3d(300, 0, -900);
    Drop drop(make_icosphere({0, 0, 0.199}, 0.2, 6));
    Columns x = drop.positions();
    for (Eigen::Index i = 0; i < x.cols(); ++i) x.col(i) = R * Vector3d(x.col(i));
    Simulation simulation = simulate(scene, std::move(drop));
    for (int k = 0; k < 4; ++k) simulation.step();
    return simulation;
  };
  const Simulation upright = after(Matrix3d::Identity()), turned = after(turn);
  const Drop &a = upright.drops().front(), &b = turned.drops().front();
  ASSERT_EQ(a.num_rows(), b.num_rows());
  EXPECT_LT((turn * Eigen::Matrix3Xd(a.positions()) - b.positions()).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(PressureLevel, NumberingOfVerticesDoesNotMatter) {
  const MeshData data = to_mesh_data(make_icosphere({0, 0, 0.199}, 0.2, 6));
  const std::size_t n = data.points.size();
  MeshData shuffled = data;  // vertex i becomes 5 i mod n; n = 362 has no factor 5
  for (std::size_t i = 0; i < n; ++i) shuffled.points[5 * i % n] = data.points[i];
  for (auto& triangle : shuffled.triangles)
    for (auto& v : triangle) v = static_cast<std::uint32_t>(5 * std::size_t{v} % n);
  const auto after = [](const MeshData& mesh) {
    Scene scene = scene_on_plate(60, 90, 0.02);
    scene.mesh.wetted_weight = 1;  // so that no edge leaves the band in these steps
    Simulation simulation = simulate(scene, Drop(to_mesh(mesh)));
    for (int k = 0; k < 4; ++k) simulation.step();
    return simulation;
  };
  const Simulation one = after(data), other = after(shuffled);
  const auto x = one.drops().front().positions(), y = other.drops().front().positions();
  ASSERT_EQ(x.cols(), y.cols());
  for (std::size_t i = 0; i < n; ++i)
    EXPECT_LT((x.col(static_cast<Eigen::Index>(i)) - y.col(static_cast<Eigen::Index>(5 * i % n))).norm(), 1e-6);
}

TEST(PressureLevel, LandsOnSolidsOfEveryShape) {
  std::vector<SolidSpec> solids(5);
  solids[0].shape = SolidShape::sphere;
  solids[0].center = Vector3d(0, 0, -0.5);
  solids[0].radius = 0.5;
  solids[1].shape = SolidShape::box;
  solids[1].center = Vector3d(0, 0, -0.5);
  solids[1].size = Vector3d(2, 2, 1);
  solids[2].shape = SolidShape::cylinder;
  solids[2].from = Vector3d(-1, 0, -0.3);
  solids[2].to = Vector3d(1, 0, -0.3);
  solids[2].radius = 0.3;
  solids[3] = solids[2];
  solids[3].shape = SolidShape::capsule;
  solids[4].shape = SolidShape::mesh;
  solids[4].file = MENISCUS_DATA_DIR "/meshes/drop.off";  // its top is at z = 0.233
  solids[4].scale = 2.5;
  solids[4].translation = Vector3d(0, 0, -0.58);
  for (const SolidSpec& solid : solids) {
    Scene scene = scene_on_plate(60, 80, 0.03);
    scene.solids = {solid};
    scene.solids[0].receding_angle = 60 * degree;
    scene.solids[0].advancing_angle = 80 * degree;
    scene.drops[0].radius = 0.15;
    scene.drops[0].center = Vector3d(0, 0, 0.2);
    Simulation simulation(scene);
    run(simulation, 0.15);
    ASSERT_FALSE(simulation.drops().empty());
    const Drop& drop = simulation.drops().front();
    EXPECT_GT(wetted_area(drop), 0.02) << static_cast<int>(solid.shape);
    EXPECT_NEAR(simulation.volume() / simulation.target_volume(), 1, 1e-3) << static_cast<int>(solid.shape);
    EXPECT_TRUE(inspect(to_mesh_data(drop.mesh())).sound) << static_cast<int>(solid.shape);
    for (std::uint32_t v = 0; v < drop.num_rows(); ++v)
      if (drop.connectivity().degree(v) > 0) {
        EXPECT_GT(simulation.solids()[0].query(drop.positions().col(v), simulation.time()).distance, -0.01);
      }
  }
}

TEST(PressureLevel, AMovingPlateCarriesItsDropAlong) {
  Scene scene = scene_on_plate(30, 90, 0.04);
  scene.drops[0].radius = 0.1;
  scene.drops[0].center.z() = 0.099;
  scene.solids[0].velocity = Vector3d(2, 0, 1);
  Simulation simulation(scene);
  run(simulation, 0.3);
  const Drop& drop = simulation.drops().front();
  EXPECT_NEAR(solid_centroid(drop.mesh()).x(), 0.6, 0.1);
  for (std::uint32_t v = 0; v < drop.num_rows(); ++v)
    if (drop.connectivity().degree(v) > 0 && is_colliding(drop.contact()[v])) {
      EXPECT_NEAR(drop.positions()(2, v), 0.3, 1e-6);
    }
}

TEST(PressureLevel, StaysSoundAtAnyTimeStep) {
  for (const double rate : {15.0, 60.0, 240.0}) {
    Scene scene = scene_on_plate(50, 70, 0.04);
    scene.time_step = 1 / rate;
    scene.drops[0].center.z() = 0.4;
    Simulation simulation(scene);
    run(simulation, 0.3);
    for (const Drop& drop : simulation.drops()) EXPECT_TRUE(inspect(to_mesh_data(drop.mesh())).sound) << rate;
    EXPECT_NEAR(simulation.volume() / simulation.target_volume(), 1, 1e-3) << rate;
  }
}

TEST(PressureLevel, WithoutTensionOrGravityNothingBreaks) {
  Scene scene = scene_on_plate(60, 90, 0.05);
  scene.liquid.surface_tension = 0;
  Simulation heavy(scene);
  for (int n = 0; n < 20; ++n) heavy.step();
  EXPECT_TRUE(std::isfinite(top_speed(heavy.drops().front())));
  scene.gravity.setZero();
  scene.drops[0].center.z() = 0.3;
  Simulation still(scene);
  const Eigen::Matrix3Xd before = still.drops().front().positions();
  still.step();
  if (before.cols() == still.drops().front().positions().cols()) {
    EXPECT_LT(top_speed(still.drops().front()), 1e-9);
  }
}

TEST(PressureLevel, ATetrahedronFalls) {
  Mesh mesh;
  const auto a = mesh.add_vertex(Point(0, 0, 0)), b = mesh.add_vertex(Point(0.1, 0, 0)),
             c = mesh.add_vertex(Point(0, 0.1, 0)), d = mesh.add_vertex(Point(0, 0, 0.1));
  mesh.add_face(a, c, b);
  mesh.add_face(a, b, d);
  mesh.add_face(b, c, d);
  mesh.add_face(a, d, c);
  Simulation simulation = simulate(scene_in_flight(0.05), Drop(std::move(mesh)));
  const double start = solid_centroid(simulation.drops().front().mesh()).z();
  for (int n = 0; n < 10; ++n) simulation.step();
  ASSERT_EQ(simulation.drops().size(), 1u);
  const double fall = -0.5 * 981.0 * 100 / (960 * 960);  // and up to a tenth more with one substep a step
  EXPECT_NEAR(solid_centroid(simulation.drops().front().mesh()).z() - start, fall, 0.1 * std::abs(fall));
}

TEST(PressureLevel, ADumbbellPinchesAndTheLedgerAddsUp) {
  Scene scene = scene_in_flight();
  scene.gravity.setZero();
  scene.time_step = 1.0 / 480;
  Simulation simulation = simulate(scene, Drop(make_dumbbell(1.2, 0.2, 0.05, 0.04)));
  const double volume = simulation.target_volume();
  std::size_t cuts = 0, most_drops = 1;
  for (int n = 0; n < 40; ++n) {
    cuts += simulation.step().cuts;
    most_drops = std::max(most_drops, simulation.drops().size());  // the halves swing back and may merge again
    EXPECT_NEAR(simulation.target_volume() / volume, 1, 1e-12);
    for (const Drop& drop : simulation.drops()) EXPECT_TRUE(inspect(to_mesh_data(drop.mesh())).sound) << n;
  }
  EXPECT_GE(cuts, 1u);
  EXPECT_GE(most_drops, 2u);
  EXPECT_NEAR(simulation.volume() / volume, 1, 5e-3);
}

TEST(PressureLevel, SameBitsWithOneThreadAndTwo) {
  const auto after = [](std::size_t threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    Scene scene = scene_on_plate(50, 70, 0.04);
    scene.drops.push_back(scene.drops[0]);
    scene.drops[1].center = Vector3d(0.8, 0, 0.25);
    Simulation simulation(scene);
    run(simulation, 0.04);
    return simulation;
  };
  const Simulation one = after(1), two = after(2);
  ASSERT_EQ(one.drops().size(), two.drops().size());
  for (std::size_t d = 0; d < one.drops().size(); ++d) {
    EXPECT_EQ(one.drops()[d].positions(), two.drops()[d].positions());
    EXPECT_EQ(one.drops()[d].velocities(), two.drops()[d].velocities());
  }
}

/// What was taken back beside a solid that moves may lie deep in it; no substep is short enough to change that.
TEST(PressureStep, AVertexThatWasTooDeepInASolidDoesNotShortenTheSubstep) {
  Drop drop(make_icosphere({0, 0, 0.19}, 0.2, 8));
  PressureOptions options;
  options.edge_min = 0.02;
  const std::vector<Solid> solids{Solid::plane({0, 0, 0}, {0, 0, 1})};
  const double depth = 0.01;
  ASSERT_GT(depth, 0.2 * options.edge_min);
  PressureStep step(drop, solids, 0, options);
  EXPECT_TRUE(step.solve(1e-4));
}

TEST(PressureStep, ASubstepThatGoesTooDeepIntoASolidIsRefused) {
  Drop drop(make_icosphere({0, 0, 0.21}, 0.2, 8));
  drop.velocities().colwise() += Vector3d(0, 0, -20);
  PressureOptions options;
  options.edge_min = 0.02;
  const std::vector<Solid> solids{Solid::plane({0, 0, 0}, {0, 0, 1})};
  PressureStep step(drop, solids, 0, options);
  EXPECT_FALSE(step.solve(1e-3)) << "0.02 cm, of which 0.01 in the solid";
  EXPECT_TRUE(step.solve(5e-4));
}

}  // namespace
}  // namespace meniscus
