// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/geometry/measure.h"

#include "meniscus/geometry/shapes.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace meniscus {
namespace {

constexpr double pi = 3.14159265358979323846;

MeshData scaled(MeshData data, double factor) {
  for (auto& p : data.points)
    for (auto& x : p) x *= factor;
  return data;
}

TEST(Measure, Box) {
  const Mesh box = make_box({3, -2, 5}, {1, 2, 4}, 1);
  EXPECT_NEAR(enclosed_volume(box), 8, 1e-13);
  EXPECT_NEAR(surface_area(box), 28, 1e-13);
  EXPECT_NEAR((solid_centroid(box) - Eigen::Vector3d(3, -2, 5)).norm(), 0, 1e-14);
  const EdgeLengths edges = edge_lengths(box);
  EXPECT_NEAR(edges.min, 1, 1e-15);
  EXPECT_NEAR(edges.max, std::sqrt(2), 1e-15);
  EXPECT_NEAR(edges.mean, (2 + std::sqrt(2)) / 3, 1e-14);  // a third of all sides are diagonals
  const Angles corners = angles(box, 50 * pi / 180);
  EXPECT_NEAR(corners.least, pi / 4, 1e-15);
  EXPECT_NEAR(corners.greatest, pi / 2, 1e-15);
  EXPECT_EQ(corners.share_below, 1);
  EXPECT_EQ(angles(box, 40 * pi / 180).share_below, 0);
}

TEST(Measure, CentroidOfACap) {
  // A half ball's centre of mass lies 3 R / 8 above its plane.
  const Mesh half = make_cap({1, 2, 3}, {0, 0, 1}, 1, pi / 2, 0.03);
  EXPECT_NEAR((solid_centroid(half) - Eigen::Vector3d(1, 2, 3.375)).norm(), 0, 2e-4);
}

TEST(Measure, InsideOutIsNegative) {
  MeshData data = to_mesh_data(make_box({0, 0, 0}, {1, 1, 1}, 1));
  for (auto& t : data.triangles) std::swap(t[0], t[1]);
  EXPECT_NEAR(enclosed_volume(data), -1, 1e-15);
  EXPECT_NEAR(solid_centroid(data).norm(), 0, 1e-15);
}

TEST(Measure, MeshAndSoupAgree) {
  const Mesh mesh = make_torus({1, 2, 3}, 1, 0.3, 0.1);
  const MeshData data = to_mesh_data(mesh);
  EXPECT_EQ(enclosed_volume(mesh), enclosed_volume(data));
  EXPECT_EQ(surface_area(mesh), surface_area(data));
  EXPECT_EQ(edge_lengths(mesh).mean, edge_lengths(data).mean);
  EXPECT_EQ(angles(mesh).least, angles(data).least);
  EXPECT_EQ(solid_centroid(mesh), solid_centroid(data));
}

TEST(Measure, NothingIsZero) {
  const MeshData none;
  EXPECT_EQ(enclosed_volume(none), 0);
  EXPECT_EQ(surface_area(none), 0);
  EXPECT_EQ(edge_lengths(none).min, 0);
  EXPECT_EQ(angles(none).greatest, 0);
  EXPECT_EQ(solid_centroid(none), Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(enclosed_volume(Mesh()), 0);
}

TEST(Measure, FaultyTrianglesDoNotCount) {
  MeshData data = to_mesh_data(make_box({0, 0, 0}, {1, 1, 1}, 1));
  data.points.push_back({std::nan(""), 0, 0});
  data.triangles.push_back({0, 1, 8});
  data.triangles.push_back({0, 1, 1});
  data.triangles.push_back({0, 1, 4000000000u});
  EXPECT_NEAR(enclosed_volume(data), 1, 1e-15);
  EXPECT_NEAR(surface_area(data), 6, 1e-14);
  EXPECT_EQ(edge_lengths(data).min, 1);
}

RC_GTEST_PROP(Measure, PowersOfTwoScaleExactly, ()) {
  const int exponent = *rc::gen::inRange(-300, 300);
  const double factor = std::ldexp(1.0, exponent);
  const MeshData small = to_mesh_data(make_icosphere({0.5, 0, 0}, 1, 2));
  const MeshData large = scaled(small, factor);
  RC_ASSERT(edge_lengths(large).mean == factor * edge_lengths(small).mean);
  RC_ASSERT(surface_area(large) == factor * factor * surface_area(small));
  RC_ASSERT(enclosed_volume(large) == factor * factor * factor * enclosed_volume(small));
  RC_ASSERT(angles(large).least == angles(small).least);
}

TEST(Measure, HugeCoordinatesOverflowOnlyInTheResult) {
  const MeshData data = scaled(to_mesh_data(make_icosphere({0, 0, 0}, 1, 2)), 1e300);
  EXPECT_GT(edge_lengths(data).min, 1e299);
  EXPECT_TRUE(std::isfinite(edge_lengths(data).max));
  EXPECT_TRUE(std::isinf(enclosed_volume(data)));
  EXPECT_GT(angles(data).least, 0.7);
}

}  // namespace
}  // namespace meniscus
