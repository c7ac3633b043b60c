// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/core/error.h"
#include "meniscus/simulation/simulation.h"
#include "meniscus/state/contact_line.h"

#include <gtest/gtest.h>

#include <cmath>

namespace meniscus {
namespace {

using Eigen::Vector3d;

Scene scattered(int count, const std::string& on = "") {
  Scene scene = default_scene();
  scene.mesh.edge_min = 0.03;
  scene.mesh.edge_max = 0.09;
  scene.drops.emplace_back();
  DropSpec& spec = scene.drops.front();
  spec.shape = DropShape::scatter;
  spec.count = count;
  spec.size = Vector3d(3, 3, 3);
  spec.radius_min = 0.06;
  spec.radius_max = 0.3;
  spec.on = on;
  return scene;
}

std::vector<Drop> drops_of(const Scene& scene) { return make_drops(scene, make_solids(scene)); }

/// The least distance from a vertex of one drop to one of another.
double least_gap(const std::vector<Drop>& drops) {
  double least = INFINITY;
  for (std::size_t a = 0; a < drops.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      for (std::uint32_t i = 0; i < drops[a].num_rows(); ++i)
        least =
            std::min(least, (drops[b].positions().colwise() - drops[a].positions().col(i)).colwise().norm().minCoeff());
  return least;
}

TEST(Scatter, BallsKeepTheirGapAndTheirBounds) {
  Scene scene = scattered(30);
  scene.drops[0].gap = 0.05;
  const std::vector<Drop> drops = drops_of(scene);
  ASSERT_EQ(drops.size(), 30u);
  EXPECT_GE(least_gap(drops), 0.05);
  double least = INFINITY, greatest = 0;
  for (const Drop& drop : drops) {
    const double radius = std::cbrt(3 * drop.volume() / (4 * pi));
    least = std::min(least, radius);
    greatest = std::max(greatest, radius);
    EXPECT_LE(drop.positions().cwiseAbs().maxCoeff(), 1.5 + 0.3);
  }
  EXPECT_GT(least, 0.85 * 0.06);  // coarse meshes hold less than their balls
  EXPECT_LT(greatest, 0.3);
  EXPECT_GT(greatest, 2 * least);
}

TEST(Scatter, TheSeedDecidesEverything) {
  Scene scene = scattered(10);
  const std::vector<Drop> first = drops_of(scene), again = drops_of(scene);
  scene.drops[0].seed = 2;
  const std::vector<Drop> other = drops_of(scene);
  for (std::size_t d = 0; d < first.size(); ++d) EXPECT_EQ(first[d].positions(), again[d].positions());
  EXPECT_NE(first[0].positions().col(0), other[0].positions().col(0));
}

TEST(Scatter, TheFirstPlaceIsTheSameOnEveryMachine) {
  // mt19937_64(1) starts with 2469588189546311528, 2516265689700432462, 8323445853463659930, ...
  Scene scene = scattered(1);
  scene.drops[0].radius_max = scene.drops[0].radius_min;
  const std::vector<Drop> drops = drops_of(scene);
  Vector3d middle = Vector3d::Zero();
  for (std::uint32_t i = 0; i < drops[0].num_rows(); ++i) middle += drops[0].positions().col(i) / drops[0].num_rows();
  const auto expected = [](double draw) { return 3 * (draw / 0x1p64 - 0.5); };
  EXPECT_NEAR(middle.x(), expected(2516265689700432462.0), 1e-9);  // the first draw was the radius
  EXPECT_NEAR(middle.y(), expected(8323445853463659930.0), 1e-9);
}

TEST(Scatter, CapsSitOnCurvedSolidsAtTheirAngle) {
  Scene scene = scattered(20, "ball");
  scene.solids.emplace_back();
  scene.solids[0].name = "ball";
  scene.solids[0].shape = SolidShape::sphere;
  scene.solids[0].radius = 2;
  scene.mesh.edge_min = 0.02;
  scene.mesh.edge_max = 0.06;
  scene.drops[0].size = Vector3d(5, 5, 5);
  const std::vector<Solid> solids = make_solids(scene);
  const std::vector<Drop> drops = make_drops(scene, solids);
  EXPECT_GT(least_gap(drops), 0);
  for (const Drop& drop : drops) {
    std::size_t touching = 0;
    for (std::uint32_t i = 0; i < drop.num_rows(); ++i) {
      EXPECT_GE(solids[0].query(drop.positions().col(i), 0).distance, -1e-9);
      touching += is_colliding(drop.contact()[i]);
    }
    EXPECT_GT(touching, 3u);
    EXPECT_GT(wetted_area(drop), 0);
    EXPECT_NEAR(mean_contact_angle(drop).value_or(0), pi / 2, 0.4);  // by the normals of coarse faces
  }
}

TEST(Scatter, OtherSolidsAreKeptFree) {
  Scene scene = scattered(20);
  scene.solids.emplace_back();  // the half space below z = 0
  for (const Drop& drop : drops_of(scene)) EXPECT_GT(drop.positions().row(2).minCoeff(), 0);
}

TEST(Scatter, TooManyAreRefused) {
  Scene scene = scattered(2000);
  scene.drops[0].radius_min = 0.25;
  EXPECT_THROW(drops_of(scene), UsageError);
}

}  // namespace
}  // namespace meniscus
