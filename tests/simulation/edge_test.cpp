// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/simulation/simulation.h"
#include "meniscus/state/contact_line.h"
#include "support/judge.h"

#include <gtest/gtest.h>

#include <cmath>

namespace meniscus {
namespace {

using Eigen::Vector3d;

constexpr double post_radius = 0.3;

/// A weightless drop on top of a post of this advancing angle (the receding one is 20 below), with the cap angle
/// `degrees` if it just covers the top.
Simulation drop_on_a_post(double advancing, double degrees) {
  Scene scene = default_scene();
  scene.gravity.setZero();
  scene.time_step = 1.0 / 960;
  scene.mesh.edge_min = 0.03;
  scene.mesh.edge_max = 0.09;
  scene.topology.self_merge = true;  // what runs over an edge folds there
  SolidSpec& post = scene.solids.emplace_back();
  post.name = "post";
  post.shape = SolidShape::cylinder;
  post.from = Vector3d(0, 0, -1);
  post.to = Vector3d::Zero();
  post.radius = post_radius;
  post.edge_radius = 0.02;
  post.advancing_angle = advancing * pi / 180;
  post.receding_angle = (advancing - 20) * pi / 180;
  const double c = std::cos(degrees * pi / 180), s = std::sin(degrees * pi / 180);
  DropSpec& drop = scene.drops.emplace_back();
  drop.shape = DropShape::cap;
  drop.on = "post";
  drop.radius = 0.97 * post_radius / s * std::cbrt((2 - 3 * c + c * c * c) / 4);
  drop.angle = degrees * pi / 180;
  return Simulation(scene);
}

double lowest_line(const Drop& drop) {
  double z = INFINITY;
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i)
    if (drop.contact()[i] == Contact::line && drop.connectivity().degree(i) > 0)
      z = std::min(z, drop.positions()(2, i));
  return z;
}

TEST(SolidEdge, TheLineStaysOnTheRimWithinGibbsAngles) {
  // 80 to 80 + 90 degrees: at 120 the top's line would run, the side's would not.
  Simulation simulation = drop_on_a_post(80, 120);
  while (simulation.time() < 0.5) {
    simulation.step();
    for (const Drop& drop : simulation.drops()) ASSERT_EQ(judge::defect(drop.mesh()), "") << simulation.time();
  }
  ASSERT_EQ(simulation.drops().size(), 1u);
  const Drop& drop = simulation.drops().front();
  EXPECT_GE(lowest_line(drop), -0.02 - 1e-9);  // on the rounded edge
  EXPECT_NEAR(wetted_area(drop) / (pi * post_radius * post_radius), 1, 0.08);
}

TEST(SolidEdge, PastGibbsAngleTheLineRunsDownTheSide) {
  // 25 + 90 < 130.
  Simulation simulation = drop_on_a_post(25, 130);
  while (simulation.time() < 0.2) {
    simulation.step();
    for (const Drop& drop : simulation.drops()) ASSERT_EQ(judge::defect(drop.mesh()), "") << simulation.time();
  }
  EXPECT_LT(lowest_line(simulation.drops().front()), -0.05);
}

}  // namespace
}  // namespace meniscus
