// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/topology/merge.h"
#include "meniscus/topology/face_changes.h"

#include "meniscus/geometry/shapes.h"
#include "meniscus/state/contact_line.h"
#include "meniscus/state/ledger.h"
#include "meniscus/topology/self_union.h"
#include "meniscus/topology/split.h"
#include "support/judge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

using Eigen::Vector3d;

constexpr double pi = 3.14159265358979323846;

MergeOptions options_for(double edge_min, double edge_max) {
  MergeOptions options;
  options.remesh.band.edge_min = edge_min;
  options.remesh.band.edge_max = edge_max;
  return options;
}

Drop ball(const Vector3d& center, double radius, const Vector3d& velocity) {
  Drop drop(make_icosphere(center, radius, 8));
  for (Eigen::Index i = 0; i < drop.velocities().cols(); ++i) drop.velocities().col(i) = velocity;
  return drop;
}

double shortest_edge(const Drop& drop) {
  double least = 1e300;
  for (const auto e : drop.mesh().edges())
    least = std::min(least, std::sqrt(CGAL::squared_distance(drop.mesh().point(drop.mesh().vertex(e, 0)),
                                                             drop.mesh().point(drop.mesh().vertex(e, 1)))));
  return least;
}

/// Balls of radius 1 at a distance, flying at each other off centre.
class TwoBalls : public testing::TestWithParam<double> {};

TEST_P(TwoBalls, BecomeOneSoundDropWithBothLedgers) {
  const Drop a = ball({0, 0, 0}, 1, {3, 1, 0}),
             b = ball(GetParam() * Vector3d(0.8, 0.53, 0.28).normalized(), 1, {-3, 0, 2});
  Ledger wanted = measure_ledger(a);
  wanted += measure_ledger(b);
  Remesher remesher;
  MergeReport report;
  const auto united = merge_drops(a, b, options_for(0.08, 0.24), remesher, report);
  ASSERT_TRUE(united.has_value());
  ASSERT_EQ(united->size(), 1u);
  const Drop& drop = united->front();
  EXPECT_EQ(judge::defect(drop), "");
  EXPECT_EQ(report.merges, 1u);
  EXPECT_DOUBLE_EQ(drop.target_volume(), a.target_volume() + b.target_volume());
  const Ledger found = measure_ledger(drop);
  EXPECT_NEAR(found.volume / wanted.volume, 1, 1e-9);
  EXPECT_LT((found.momentum - wanted.momentum).norm(), 1e-12 * wanted.volume * 3);
  EXPECT_LT((found.center() - wanted.center()).norm(), 1e-12);
  EXPECT_LT((found.angular_momentum - wanted.angular_momentum).norm(), 1e-10 * wanted.volume * 3);
  EXPECT_GT(shortest_edge(drop), 0.2 * 0.08) << "slivers are left at the seam";
}

INSTANTIATE_TEST_SUITE_P(Distances, TwoBalls, testing::Values(1.985, 1.97, 1.95, 1.8, 1.5, 1.1, 0.6));

TEST(MergeDrops, OverlapIsTheCommonVolume) {
  // Two caps of height h = 0.1 on balls of radius 1: 2 pi h^2 (3 - h)/3, less what icospheres of 1,280 faces lack.
  const Drop a = ball({0, 0, 0}, 1, Vector3d::Zero()), b = ball({1.8, 0, 0}, 1, Vector3d::Zero());
  Remesher remesher;
  MergeReport report;
  ASSERT_TRUE(merge_drops(a, b, options_for(0.08, 0.24), remesher, report).has_value());
  EXPECT_NEAR(report.overlap, 2 * pi * 0.01 * 2.9 / 3, 0.01);
}

/// A ball, one vertex of it pushed in so that a ball that covers the place shuts the tip of the pit in.
std::vector<Drop> balls_with_a_pit(double depth) {
  Drop a = ball({0, 0, 0}, 1, Vector3d::Zero());
  const Vector3d pole = std::as_const(a).positions().col(0);
  a.positions().col(0) *= 1 - depth;
  MergeOptions options = options_for(0.08, 0.24);
  options.keep_air = true;
  Remesher remesher;
  MergeReport report;
  return *merge_drops(a, ball(1.8 * pole, 1, Vector3d::Zero()), options, remesher, report);
}

TEST(MergeDrops, AirIsKeptUnlessItIsSmallerThanTheMeshHolds) {
  // What lies deeper than the 0.2 to which the other ball reaches is a cone of that height: 0.3 and 0.05 here.
  for (const auto& [depth, components] : {std::pair(0.5, 2u), std::pair(0.25, 1u)}) {
    const std::vector<Drop> united = balls_with_a_pit(depth);
    ASSERT_EQ(united.size(), 1u);
    EXPECT_EQ(judge::defect(united.front()), "");
    EXPECT_EQ(connected_components(united.front().mesh()).size(), components) << "depth " << depth;
  }
}

TEST(MergeDrops, ApartIsNotMerged) {
  Remesher remesher;
  MergeReport report;
  EXPECT_FALSE(merge_drops(ball({0, 0, 0}, 1, Vector3d::Zero()), ball({2.1, 0, 0}, 1, Vector3d::Zero()),
                           options_for(0.08, 0.24), remesher, report)
                   .has_value());
  EXPECT_EQ(report.merges + report.refused, 0u);
}

TEST(MergeDrops, SameInputSameBits) {
  const auto merged = [] {
    Remesher remesher;
    MergeReport report;
    return merge_drops(ball({0, 0, 0}, 1, {1, 0, 0}), ball({1.7, 0.3, 0.2}, 1, {-1, 0, 0}), options_for(0.08, 0.24),
                       remesher, report)
        ->front();
  };
  const Drop one = merged(), two = merged();
  EXPECT_EQ(one.positions(), two.positions());
  EXPECT_EQ(one.velocities(), two.velocities());
}

/// Two overlapping balls as one surface.
Drop crossing_balls() {
  Mesh mesh = make_icosphere({0, 0, 0}, 1, 8);
  mesh += make_icosphere({1.31, 0.42, 0.17}, 1, 8);
  return Drop(std::move(mesh));
}

TEST(SelfUnion, OfTwoBallsInOneSurfaceIsTheirUnion) {
  const Drop both = crossing_balls();
  const Mesh a = make_icosphere({0, 0, 0}, 1, 8), b = make_icosphere({1.31, 0.42, 0.17}, 1, 8);
  const MeshData data_a = to_mesh_data(a), data_b = to_mesh_data(b);
  const BooleanResult wanted = boolean(view_of(data_a), view_of(data_b), BooleanOperation::unite);
  const BooleanResult found = unite_with_itself(view_of(both), bounding_box(both), false);
  ASSERT_TRUE(found.ok()) << found.message;
  EXPECT_EQ(found.triangles.size(), wanted.triangles.size());
  EXPECT_NEAR(found.volume, wanted.volume, 1e-12);
}

TEST(MendFolds, UniteADropThatCrossesItself) {
  Drop drop = crossing_balls();
  const Eigen::Matrix3Xd before = drop.positions();
  MergeOptions options = options_for(0.08, 0.24);
  options.self_merge = true;
  Remesher remesher;
  MergeReport report;
  const auto mended = mend_folds(drop, {before}, options, remesher, report);
  ASSERT_TRUE(mended.has_value());
  ASSERT_EQ(mended->size(), 1u);
  EXPECT_EQ(judge::defect(mended->front()), "");
  EXPECT_EQ(report.folds, 1u);
}

std::vector<std::uint8_t> violent_faces(Drop& drop, const Eigen::Matrix3Xd& before) {
  std::vector<std::uint8_t> violent;
  find_face_changes(drop, before, violent);
  return violent;
}

TEST(MendFolds, TakesBackWhatFoldsOverItsNeighbours) {
  // A vertex flies through the surface beside it: no union helps, so it goes back, carried along by the drop.
  Drop drop = ball({0, 0, 0}, 1, {1, 0, 0});
  const Eigen::Matrix3Xd before = drop.positions();
  const Vector3d way(0.01, 0, 0);
  drop.positions().colwise() += way;
  const std::uint32_t v = 40, w = drop.connectivity().ring(v).neighbour[0];
  drop.positions().col(v) += 2.2 * (before.col(w) - before.col(v));
  ASSERT_NE(judge::defect(drop), "");
  watch_faces(drop, violent_faces(drop, before));
  MergeOptions options = options_for(0.08, 0.24);
  ASSERT_TRUE(may_fold(drop, options));
  Remesher remesher;
  MergeReport report;
  EXPECT_FALSE(mend_folds(drop, {before}, options, remesher, report).has_value());
  EXPECT_EQ(judge::defect(drop), "");
  EXPECT_GT(report.taken_back, 0u);
  EXPECT_LT((drop.positions() - before).colwise().norm().maxCoeff(), 0.2);
}

TEST(MendFolds, MomentumOfWhatIsTakenBackIsGivenToNobody) {
  const Vector3d velocity(0, 1e4, 0);
  Drop drop = ball({0, 0, 0}, 1, velocity);
  const Eigen::Matrix3Xd before = drop.positions();
  const std::uint32_t v = 40, w = drop.connectivity().ring(v).neighbour[0];
  const Vector3d flight = 2.2 * (before.col(w) - before.col(v));
  drop.positions().col(v) += flight;
  drop.velocities().col(v) += 1000 * before.col(v) + 1000 * flight;
  watch_faces(drop, violent_faces(drop, before));
  Remesher remesher;
  MergeReport report;
  EXPECT_FALSE(mend_folds(drop, {before}, options_for(0.08, 0.24), remesher, report).has_value());
  EXPECT_EQ(judge::defect(drop), "");
  EXPECT_GT(report.taken_back, 0u);
  const Vector3d there = before.col(v);
  double fastest = 0;
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i)
    if (before.col(i).dot(there) < 0) fastest = std::max(fastest, (drop.velocities().col(i) - velocity).norm());
  EXPECT_LT(fastest, 0.1);
}

TEST(MendFolds, WhatIsTakenBackGoesAlongWithTheSolidThatHoldsIt) {
  // Half of the ball lies on a solid that moves on by `way`; a vertex of the other half flies through the surface.
  Drop drop = ball({0, 0, 0}, 1, {0, 3, 0});
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i)
    if (drop.positions()(2, i) < 0) drop.contact()[i] = Contact::wetted;
  const Eigen::Matrix3Xd before = drop.positions();
  const Vector3d way(0.4, 0, 0), velocity(2, 0, 0);
  drop.positions().colwise() += way;
  const auto flies = [&](std::uint32_t v) { return drop.contact()[v] == Contact::free && before(2, v) > 0.2; };
  std::uint32_t v = 0;
  while (!flies(v)) ++v;
  const std::uint32_t w = drop.connectivity().ring(v).neighbour[0];
  drop.positions().col(v) += 2.2 * (before.col(w) - before.col(v));
  ASSERT_NE(judge::defect(drop), "");
  watch_faces(drop, violent_faces(drop, before));
  Remesher remesher;
  MergeReport report;
  EXPECT_FALSE(mend_folds(drop, {before, way, velocity}, options_for(0.08, 0.24), remesher, report).has_value());
  EXPECT_EQ(judge::defect(drop), "");
  EXPECT_GT(report.taken_back, 0u);
  EXPECT_LT(((drop.positions() - before).colwise() - way).colwise().norm().maxCoeff(), 0.2);
  EXPECT_NEAR((drop.velocities().col(v) - 0.5 * (velocity + Vector3d(0, 3, 0))).norm(), 0, 1e-12);
}

TEST(MendFolds, WhatIsTakenBackToAboveTheSolidThatItHasJustMetIsFreeAgain) {
  // The ball came down by 0.4 in a substep and lies flat on the plane z = -1, where a vertex folds over its neighbours.
  Drop drop = ball({0, 0, 0}, 1, {0, 0, -3});
  const Eigen::Matrix3Xd before = drop.positions();
  drop.positions().row(2).array() -= 0.4;
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i) {
    if (drop.positions()(2, i) >= -1) continue;
    drop.positions()(2, i) = -1;
    drop.contact()[i] = Contact::wetted;
    drop.contact_solid()[i] = 0;
    drop.contact_normals().col(i) = Vector3d::UnitZ();
  }
  mark_contact_line(drop);
  std::uint32_t v = 0;
  while (!(before(2, v) < -0.7 && before(2, v) > -0.85)) ++v;
  const std::uint32_t w = drop.connectivity().ring(v).neighbour[0];
  const Vector3d side = drop.positions().col(w) - drop.positions().col(v);
  drop.positions().col(v) += 2.2 * side;
  ASSERT_NE(judge::defect(drop), "");
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i) drop.seam_watch()[i] = 5;
  Remesher remesher;
  MergeReport report;
  EXPECT_FALSE(mend_folds(drop, {before}, options_for(0.08, 0.24), remesher, report).has_value());
  EXPECT_EQ(judge::defect(drop), "");
  EXPECT_EQ(drop.contact()[v], Contact::free);
  EXPECT_EQ(drop.contact_solid()[v], -1);
  EXPECT_GT(drop.positions()(2, v), -1);
}

TEST(MendFolds, ACalmDropIsNotWatched) {
  Drop drop = ball({0, 0, 0}, 1, {1, 0, 0});
  const Eigen::Matrix3Xd before = drop.positions();
  drop.positions().colwise() += Vector3d(0.5, 0, 0);
  watch_faces(drop, violent_faces(drop, before));
  EXPECT_FALSE(may_fold(drop, options_for(0.08, 0.24)));
}

}  // namespace
}  // namespace meniscus
