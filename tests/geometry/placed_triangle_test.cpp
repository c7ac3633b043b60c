// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/geometry/placed_triangle.h"

#include "meniscus/geometry/self_intersection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace meniscus {
namespace {

using Eigen::Vector3d;
using Triple = std::array<std::uint32_t, 3>;

PlacedTriangle placed(const std::vector<Vector3d>& points, const Triple& t) {
  return {t, {points[t[0]], points[t[1]], points[t[2]]}};
}

bool has_area(const std::vector<Vector3d>& points, const Triple& t) {
  return !CGAL::collinear(to_point(points[t[0]]), to_point(points[t[1]]), to_point(points[t[2]]));
}

int shared(const Triple& s, const Triple& t) {
  return static_cast<int>(
      std::count_if(s.begin(), s.end(), [&](auto v) { return std::find(t.begin(), t.end(), v) != t.end(); }));
}

/// Pairs of triangles of a few points on a lattice, so that most lie in one plane, on one line or on each other
/// somewhere; `place` puts a lattice point into space.
template <class Place>
void expect_exact_answers(std::uint64_t seed, Place place) {
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<int> lattice(-2, 2);
  std::array<int, 3> met{}, parted{};  // by the number of shared corners
  for (int round = 0; round < 20000; ++round) {
    std::vector<Vector3d> points;
    for (int k = 0; k < 6; ++k) {
      const int x = lattice(random), y = lattice(random), z = lattice(random);
      points.push_back(place(Vector3d(x, y, z), random));
    }
    Triple order{0, 1, 2}, other{static_cast<std::uint32_t>(round % 5), 4, 5};
    if (round % 5 == 4) other = {1, 0, 5};
    std::shuffle(order.begin(), order.end(), random);
    std::shuffle(other.begin(), other.end(), random);
    if (!has_area(points, order) || !has_area(points, other)) continue;
    const auto at = [&](std::uint32_t v) { return to_point(points[v]); };
    const bool expected = meet_elsewhere(at, order, other);
    ASSERT_EQ(meet(placed(points, order), placed(points, other)), expected) << "round " << round;
    ASSERT_EQ(meet(placed(points, other), placed(points, order)), expected) << "round " << round;
    ++(expected ? met : parted)[static_cast<std::size_t>(shared(order, other))];
  }
  for (const int count : {met[0], met[1], parted[0], parted[1], parted[2]}) EXPECT_GT(count, 50);
}

TEST(PlacedTriangle, MeetAsExactly) {
  expect_exact_answers(1, [](const Vector3d& x, auto&) { return x; });
}

TEST(PlacedTriangle, MeetAsExactlyInOnePlane) {
  expect_exact_answers(2, [](const Vector3d& x, auto&) { return Vector3d(x[0], x[1], 0); });
}

/// In a plane that rounding bends, far from the origin.
TEST(PlacedTriangle, MeetAsExactlyNextToAPlane) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  expect_exact_answers(
      3, [&](const Vector3d& x, auto&) { return Vector3d(turn * Vector3d(x[0], x[1], 0) + Vector3d(100, -30, 7)); });
}

/// Off a plane by what rounding may add to a product, and flat like a sliver.
TEST(PlacedTriangle, MeetAsExactlyAtTheLimitOfRounding) {
  for (const double height : {1e-16, 1e-14, 1e-12, 1e-9, 1e-6})
    for (const double flat : {1.0, 1e-3, 1e-6, 1e-9})
      expect_exact_answers(4, [&](const Vector3d& x, auto& random) {
        std::uniform_real_distribution<double> off(-height, height);
        return Vector3d(x[0] + off(random), flat * x[1] + off(random) * flat, off(random));
      });
}

TEST(PlacedTriangle, TheSameCornersMeet) {
  const std::vector<Vector3d> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_TRUE(meet(placed(points, {0, 1, 2}), placed(points, {2, 1, 0})));
}

TEST(PlacedTriangle, HoldsItsBox) {
  const PlacedTriangle t({0, 1, 2}, {Vector3d(0, 3, -1), Vector3d(1, 0, 0), Vector3d(-2, 1, 5)});
  EXPECT_EQ(t.box().min(), Vector3d(-2, 0, -1));
  EXPECT_EQ(t.box().max(), Vector3d(1, 3, 5));
}

}  // namespace
}  // namespace meniscus
