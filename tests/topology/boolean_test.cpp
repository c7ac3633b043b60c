// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/topology/boolean.h"

#include "meniscus/geometry/measure.h"
#include "meniscus/geometry/shapes.h"
#include "support/judge.h"
#include "support/random_shapes.h"

#include <gtest/gtest.h>

#include <limits>

namespace meniscus {
namespace {

MeshData data_of(const BooleanResult& result) {
  MeshData data;
  data.points = result.points;
  data.triangles = result.triangles;
  return data;
}

std::string defect(const BooleanResult& result) {
  if (!result.ok()) return "refused: " + result.message;
  return judge::defect(to_mesh(data_of(result)));
}

TEST(Boolean, InclusionAndExclusionOfTwoBalls) {
  const MeshData a = to_mesh_data(make_icosphere({0, 0, 0}, 1, 8)),
                 b = to_mesh_data(make_icosphere({0.7, 0.3, 0.2}, 0.8, 7));
  const BooleanResult both = boolean(view_of(a), view_of(b), BooleanOperation::unite);
  const BooleanResult common = boolean(view_of(a), view_of(b), BooleanOperation::intersect);
  const BooleanResult rest = boolean(view_of(a), view_of(b), BooleanOperation::subtract);
  for (const auto* result : {&both, &common, &rest}) {
    EXPECT_EQ(defect(*result), "");
    EXPECT_EQ(result->outcome, BooleanOutcome::crossing);
  }
  EXPECT_NEAR(both.volume + common.volume, both.volume_a + both.volume_b, 1e-12);
  EXPECT_NEAR(rest.volume + common.volume, both.volume_a, 1e-12);
}

TEST(Boolean, RowsSayWhereTheyComeFrom) {
  const MeshData a = to_mesh_data(make_icosphere({0, 0, 0}, 1, 5)),
                 b = to_mesh_data(make_icosphere({1.2, 0.1, 0.2}, 0.8, 4));
  const BooleanResult result = boolean(view_of(a), view_of(b), BooleanOperation::unite);
  ASSERT_EQ(result.points.size(), result.kept_a.size() + result.kept_b.size() + result.seam.size());
  for (std::size_t i = 0; i < result.kept_a.size(); ++i) EXPECT_EQ(result.points[i], a.points[result.kept_a[i]]);
  for (std::size_t i = 0; i < result.kept_b.size(); ++i)
    EXPECT_EQ(result.points[result.kept_a.size() + i], b.points[result.kept_b[i]]);
  for (std::size_t k = 0; k < result.seam.size(); ++k) {
    const Eigen::Vector3d at = Eigen::Vector3d::Map(result.points[result.first_seam_row() + k].data());
    const auto place = [](const MeshData& data, const SurfacePoint& on) {
      Eigen::Vector3d p = Eigen::Vector3d::Zero();
      for (int c = 0; c < 3; ++c) p += on.weights[c] * Eigen::Vector3d::Map(data.points[on.corners[c]].data());
      return p;
    };
    EXPECT_LT((place(a, result.seam[k].on_a) - at).norm(), 1e-14);
    EXPECT_LT((place(b, result.seam[k].on_b) - at).norm(), 1e-14);
  }
}

TEST(Boolean, MeshesThatDoNotMeetAreKeptOrDroppedWhole) {
  const MeshData a = to_mesh_data(make_icosphere({0, 0, 0}, 1, 4)), far = to_mesh_data(make_icosphere({3, 0, 0}, 1, 3)),
                 in = to_mesh_data(make_icosphere({0.1, 0, 0}, 0.3, 2));
  EXPECT_FALSE(surfaces_meet(view_of(a), view_of(far)));
  EXPECT_FALSE(surfaces_meet(view_of(a), view_of(in)));
  const BooleanResult both = boolean(view_of(a), view_of(far), BooleanOperation::unite);
  EXPECT_EQ(both.outcome, BooleanOutcome::disjoint);
  EXPECT_EQ(defect(both), "");
  EXPECT_EQ(both.triangles.size(), a.triangles.size() + far.triangles.size());
  EXPECT_TRUE(boolean(view_of(a), view_of(far), BooleanOperation::intersect).triangles.empty());
  const BooleanResult nested = boolean(view_of(in), view_of(a), BooleanOperation::unite);
  EXPECT_EQ(nested.outcome, BooleanOutcome::a_inside_b);
  EXPECT_EQ(nested.triangles, a.triangles);
  const BooleanResult hollow = boolean(view_of(a), view_of(in), BooleanOperation::subtract);
  EXPECT_NEAR(hollow.volume, hollow.volume_a - hollow.volume_b, 1e-14);
}

TEST(Boolean, FacesThatLieFlatUpToNumbersNextToZero) {
  // As wetted faces on a plane do: their height, the least number above zero, has no reciprocal.
  constexpr double hardly = std::numeric_limits<double>::denorm_min();
  MeshData a, b;
  a.points = {{0, 0, 0}, {1, 0, hardly}, {0, 1, 0}, {1, 1, hardly}};
  a.triangles = {{0, 1, 2}, {1, 3, 2}};
  b = a;
  for (auto& p : b.points) p = {p[0] + 0.5, p[1], hardly - p[2]};  // the slopes cross at x = 0.75
  EXPECT_TRUE(surfaces_meet(view_of(a), view_of(b)));
  for (auto& p : b.points) p[0] += 5;
  EXPECT_FALSE(surfaces_meet(view_of(a), view_of(b)));
}

TEST(Boolean, SameBitsWhereverMemoryLies) {
  // Caps on one plane have faces in common with it, so that CGAL unites them; its order of new faces follows addresses.
  random_shapes::Numbers numbers(1);
  for (int pair = 0; pair < 12; ++pair) {
    const auto cap = [&](double x, double y) {
      const double radius = numbers.between(0.15, 0.25), angle = numbers.between(0.8, 2.2);
      return to_mesh_data(make_cap({x, y, 0}, {0, 0, 1}, radius, angle, 0.05));
    };
    const double x = numbers.between(0.2, 0.35), y = numbers.between(-0.1, 0.1);
    const MeshData a = cap(0, 0), b = cap(x, y);
    const BooleanResult first = boolean(view_of(a), view_of(b), BooleanOperation::unite);
    ASSERT_TRUE(first.ok()) << first.message;
    std::vector<std::vector<char>> blocks;  // of all sizes, so that what comes next lies elsewhere
    for (int run = 0; run < 4; ++run) {
      for (int k = 0; k < 200; ++k) {
        blocks.emplace_back(static_cast<std::size_t>(16 + numbers.below(3000)));
        if (k % 2 == 0) blocks.erase(blocks.begin() + numbers.below(static_cast<int>(blocks.size())));
      }
      const BooleanResult again = boolean(view_of(a), view_of(b), BooleanOperation::unite);
      EXPECT_EQ(again.points, first.points);
      EXPECT_EQ(again.triangles, first.triangles);
      ASSERT_EQ(again.seam.size(), first.seam.size());
      for (std::size_t k = 0; k < first.seam.size(); ++k) {
        EXPECT_EQ(again.seam[k].on_a.corners, first.seam[k].on_a.corners);
        EXPECT_EQ(again.seam[k].on_b.corners, first.seam[k].on_b.corners);
      }
    }
  }
}

}  // namespace
}  // namespace meniscus
