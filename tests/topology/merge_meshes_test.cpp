// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/topology/merge_meshes.h"

#include "meniscus/core/error.h"
#include "meniscus/geometry/inspect.h"
#include "support/boolean_cases.h"

#include <gtest/gtest.h>

namespace meniscus {
namespace {

using boolean_cases::ball;
using boolean_cases::cube;
using boolean_cases::volume;

/// vx = 2 x + 1 and the drop's number on every vertex.
MeshData with_attributes(MeshData mesh, int drop) {
  mesh.attributes = {{"vx", ScalarType::float64, {}}, {"drop", ScalarType::int32, {}}};
  for (const auto& p : mesh.points) {
    mesh.attributes[0].values.push_back(2 * p[0] + 1);
    mesh.attributes[1].values.push_back(drop);
  }
  return mesh;
}

std::optional<MeshData> unite(const std::vector<MeshData>& meshes) {
  MeshMergeReport report;
  return merge_meshes(meshes, BooleanOperation::unite, {}, report);
}

TEST(MergeMeshes, CarriesLinearAttributesExactly) {
  const auto merged = unite({with_attributes(ball(4), 7), with_attributes(ball(3, {1.1, 0.2, 0.1}), 3)});
  ASSERT_TRUE(merged);
  for (std::size_t v = 0; v < merged->points.size(); ++v) {
    EXPECT_NEAR(merged->attribute("vx")->values[v], 2 * merged->points[v][0] + 1, 1e-13);
    EXPECT_EQ(merged->attribute("drop")->values[v], 3) << "one number a component";
  }
}

TEST(MergeMeshes, DropsApartKeepTheirNumbers) {
  const auto merged = unite({with_attributes(ball(2), 7), with_attributes(ball(2, {5, 0, 0}), 3)});
  ASSERT_TRUE(merged);
  for (std::size_t v = 0; v < merged->points.size(); ++v)
    EXPECT_EQ(merged->attribute("drop")->values[v], merged->points[v][0] < 2 ? 7 : 3);
}

TEST(MergeMeshes, TheOrderOfManyDoesNotMatter) {
  std::vector<MeshData> row;
  for (int k = 0; k < 9; ++k) row.push_back(ball(3, {0.9 * k, 0.05 * k, 0.02 * k * k}, 0.6));
  const auto forth = unite(row);
  std::reverse(row.begin(), row.end());
  const auto back = unite(row);
  ASSERT_TRUE(forth && back);
  EXPECT_TRUE(inspect(*forth).sound);
  EXPECT_EQ(inspect(*forth).components, 1u);
  EXPECT_NEAR(volume(*forth), volume(*back), 1e-12 * volume(*back));
}

TEST(MergeMeshes, TheFirstLessTheRest) {
  MeshMergeReport report;
  const auto rest = merge_meshes({cube({0, 0, 0}, {4, 4, 4}), cube({1, 0.1, 2}), cube({-1, 0, 2}), cube({0, 0, 9})},
                                 BooleanOperation::subtract, {}, report);
  ASSERT_TRUE(rest) << report.message;
  EXPECT_NEAR(volume(*rest), 64 - 2 * 0.5, 1e-12);
}

TEST(MergeMeshes, WhatAllHaveInCommon) {
  MeshMergeReport report;
  const std::vector<MeshData> bars = {cube({0, 0, 0}, {3, 1, 1}), cube({0, 0, 0}, {1, 3, 1.5}),
                                      cube({0, 0, 0}, {2, 2, 0.5})};
  const auto common = merge_meshes(bars, BooleanOperation::intersect, {}, report);
  ASSERT_TRUE(common);
  EXPECT_NEAR(volume(*common), 0.5, 1e-13);
  const auto none = merge_meshes({cube(), cube({5, 0, 0}), cube()}, BooleanOperation::intersect, {}, report);
  ASSERT_TRUE(none);
  EXPECT_TRUE(none->triangles.empty());
}

TEST(MergeMeshes, AirShutInIsKeptOrDropped) {
  const MeshData a = boolean_cases::cup();
  const MeshData b = boolean_cases::moved(boolean_cases::rotated(a, 3.141592653589793, {0, 0, 1}), {0.9, 0.02, 0.03});
  MeshMergeReport report;
  BooleanOptions options;
  const auto kept = merge_meshes({a, b}, BooleanOperation::unite, options, report);
  options.keep_cavities = false;
  const auto filled = merge_meshes({a, b}, BooleanOperation::unite, options, report);
  ASSERT_TRUE(kept && filled);
  EXPECT_EQ(inspect(*kept).components, 2u);
  EXPECT_EQ(inspect(*filled).components, 1u);
  EXPECT_TRUE(inspect(*filled).sound);
  EXPECT_GT(volume(*filled), volume(*kept) + 0.3);
}

TEST(MergeMeshes, UnsoundInputsThrowWithTheDefect) {
  MeshData open = cube();
  open.triangles.pop_back();
  EXPECT_THROW(unite({cube({3, 0, 0}), open}), GeometryError);
  EXPECT_THROW(unite({}), UsageError);
}

TEST(Divide, PlanesShareTheVolumeOut) {
  MeshData mesh = with_attributes(ball(6), 1);
  for (const double height : {-2.0, -0.5, 0.0, 1e-9, 0.3, 0.99, 2.0}) {
    SCOPED_TRACE(height);
    const Eigen::Vector3d normal(0.2, -0.4, 3);
    MeshMergeReport report;
    const auto parts = divide(mesh, half_space(mesh, normal, height * normal.norm()), {}, report);
    ASSERT_TRUE(parts) << report.message;
    double sum = 0;
    for (const auto* part : {&parts->first, &parts->second}) {
      if (part->triangles.empty()) continue;
      EXPECT_TRUE(inspect(*part).sound);
      sum += volume(*part);
      const double side = part == &parts->first ? 1 : -1;  // the first lies below
      for (const auto& p : part->points)
        EXPECT_LE(side * (normal.normalized().dot(Eigen::Vector3d::Map(p.data())) - height), 1e-14);
      for (std::size_t v = 0; v < part->points.size(); ++v)
        EXPECT_NEAR(part->attribute("vx")->values[v], 2 * part->points[v][0] + 1, 1e-12);
    }
    EXPECT_NEAR(sum, volume(mesh), 1e-13 * volume(mesh));
  }
}

TEST(Divide, ByAMesh) {
  const MeshData block = cube({0, 0, 0}, {2, 2, 2});
  const MeshData cutter = ball(5, {1, 0.1, 0.2}, 0.7);
  MeshMergeReport report;
  const auto parts = divide(with_attributes(block, 4), cutter, {}, report);
  ASSERT_TRUE(parts) << report.message;
  EXPECT_NEAR(volume(parts->first), boolean_cases::common_volume(block, cutter), 1e-10);
  EXPECT_NEAR(volume(parts->first) + volume(parts->second), 8, 1e-12);
  for (const auto& value : parts->second.attribute("drop")->values) EXPECT_EQ(value, 4);
}

TEST(RepairSoup, MendsAndKeepsAttributes) {
  MeshData mesh = with_attributes(ball(3), 2);
  mesh.triangles.pop_back();                              // a hole
  std::swap(mesh.triangles[5][0], mesh.triangles[5][1]);  // a face the wrong way round
  mesh.triangles.push_back({1, 1, 2});                    // no face at all
  const MeshData mended = repair_soup(mesh);
  EXPECT_TRUE(inspect(mended).sound);
  EXPECT_NEAR(volume(mended), volume(ball(3)), 1e-13);
  for (std::size_t v = 0; v < mended.points.size(); ++v)
    EXPECT_EQ(mended.attribute("vx")->values[v], 2 * mended.points[v][0] + 1);
}

}  // namespace
}  // namespace meniscus
