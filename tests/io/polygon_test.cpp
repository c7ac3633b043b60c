// SPDX-License-Identifier: GPL-3.0-or-later
#include "io_test_helpers.h"

#include <rapidcheck.h>
#include <rapidcheck/gtest.h>
#include <Eigen/Geometry>

#include <cmath>

namespace meniscus::test {
namespace {

using Points = std::vector<std::array<double, 3>>;

std::string off_of(const Points& points, const std::vector<std::size_t>& corners) {
  std::ostringstream out;
  out.precision(17);
  out << "OFF\n" << points.size() << " 1 0\n";
  for (const auto& [x, y, z] : points) out << x << ' ' << y << ' ' << z << '\n';
  out << corners.size();
  for (const auto corner : corners) out << ' ' << corner;
  return out.str() + '\n';
}

MeshData cut(const Points& points, std::vector<std::size_t> corners = {}) {
  for (std::size_t i = 0; corners.size() < points.size(); ++i) corners.push_back(i);
  return parse(MeshFormat::off, off_of(points, corners));
}

Eigen::Vector3d vector_area(const MeshData& data, const std::array<std::uint32_t, 3>& t) {
  const Eigen::Vector3d a(data.points[t[0]].data()), b(data.points[t[1]].data()), c(data.points[t[2]].data());
  return 0.5 * (b - a).cross(c - a);
}

struct Areas {
  double absolute = 0;  ///< sum of the triangles' areas
  double enclosed = 0;  ///< length of the sum of their vector areas: the polygon's own area
  double least = 1e300;
};

/// For a planar polygon, absolute == enclosed exactly if all triangles turn the same way: no overlap.
Areas areas(const MeshData& data) {
  Areas result;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& t : data.triangles) {
    const Eigen::Vector3d area = vector_area(data, t);
    sum += area;
    result.absolute += area.norm();
    result.least = std::min(result.least, area.norm());
  }
  result.enclosed = sum.norm();
  return result;
}

void expect_covers(const MeshData& data, double area) {
  const Areas result = areas(data);
  EXPECT_NEAR(result.absolute, area, 1e-12 * area);
  EXPECT_NEAR(result.enclosed, area, 1e-12 * area);
  EXPECT_GT(result.least, 0);
}

TEST(Polygon, QuadsAndConvexPolygonsAreCovered) {
  expect_covers(cut({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}), 2);
  Points ring;
  for (int i = 0; i < 100; ++i) ring.push_back({std::cos(i * M_PI / 50), 3, std::sin(i * M_PI / 50)});
  const MeshData data = cut(ring);
  EXPECT_EQ(data.triangles.size(), 98U);
  expect_covers(data, 50 * std::sin(M_PI / 50));
}

TEST(Polygon, ConcavePolygonsAreCoveredOnceInEveryPlaneAndDirection) {
  const std::vector<std::pair<double, double>> arrow{{0, 0}, {4, -3}, {0, 5}, {-4, -3}};
  for (std::size_t start = 0; start < 4; ++start)
    for (const bool reversed : {false, true})
      for (std::size_t axis = 0; axis < 3; ++axis) {
        Points points;
        for (std::size_t i = 0; i < 4; ++i) {
          const auto& [u, v] = arrow[(start + (reversed ? 4 - i : i)) % 4];
          points.emplace_back();
          points.back()[(axis + 1) % 3] = u;
          points.back()[(axis + 2) % 3] = v;
          points.back()[axis] = 7;
        }
        expect_covers(cut(points), 20);
      }
}

TEST(Polygon, CollinearCornersGiveNoFlatTriangle) {
  expect_covers(cut({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}}), 4);
}

TEST(Polygon, AHoleReachedByABridgeStaysOpen) {
  const Points points{{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}, {1, 1, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}};
  expect_covers(cut(points, {0, 1, 2, 3, 0, 4, 7, 6, 5, 4}), 8);
}

TEST(Polygon, CombsOfManyTeethAreCovered) {
  Points points;
  const int teeth = 400;
  for (int i = 0; i < teeth; ++i) {
    points.push_back({2.0 * i, 0.001, 0});
    points.push_back({2.0 * i + 1, 10, 0});
  }
  points.push_back({2.0 * teeth, -1, 0});
  points.push_back({-1, -1, 0});
  const MeshData data = cut(points);
  EXPECT_EQ(data.triangles.size(), points.size() - 2);
  const Areas result = areas(data);
  EXPECT_NEAR(result.absolute, result.enclosed, 1e-9 * result.enclosed);
}

RC_GTEST_PROP(Polygon, StarShapedPolygonsAreCoveredOnce, ()) {
  const auto n = *rc::gen::inRange(4, 40);
  const Eigen::Quaterniond turn =
      Eigen::Quaterniond(1.0, *rc::gen::inRange(-9, 10), *rc::gen::inRange(-9, 10), *rc::gen::inRange(-9, 10))
          .normalized();
  Points points;
  double area = 0, first = 0, last = 0;
  for (int i = 0; i < n; ++i) {
    const double radius = *rc::gen::inRange(1, 50), angle = 2 * M_PI * i / n;
    const Eigen::Vector3d p = turn * Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), 100);
    points.push_back({p.x(), p.y(), p.z()});
    area += 0.5 * last * radius * std::sin(2 * M_PI / n);
    first = i == 0 ? radius : first;
    last = radius;
  }
  area += 0.5 * last * first * std::sin(2 * M_PI / n);
  const MeshData data = cut(points);
  RC_ASSERT(data.triangles.size() == points.size() - 2);
  const Areas result = areas(data);
  RC_ASSERT(std::abs(result.absolute - area) < 1e-10 * area);
  RC_ASSERT(std::abs(result.enclosed - area) < 1e-10 * area);
}

TEST(Polygon, EveryCornerCountGivesItsTriangles) {
  const double nan = std::nan("");
  const std::vector<Points> odd{
      {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}},             // a bow tie
      {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {1, 0, 0}},  // flat
      {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}},             // one point
      {{0, 0, 0}, {1, 0, 0}, {1, nan, 0}, {0, 1, 0}},
      {{0, 0, 0}, {1e308, 0, 0}, {1e308, 1e308, 0}, {-1e308, 1e308, 0}},
      {{0, 0, 0}, {1e-300, 0, 0}, {2e-301, 2e-301, 0}, {0, 1e-300, 0}},
      {{0, 3, 0}, {2, -3, 0}, {-3, 1, 0}, {3, 1, 0}, {-2, -3, 0}},  // a pentagram
  };
  for (const auto& points : odd) {
    const MeshData data = cut(points);
    EXPECT_EQ(data.triangles.size(), points.size() - 2);
    EXPECT_EQ(data.source_face, std::vector<std::uint32_t>(points.size() - 2, 0));
  }
}

TEST(Polygon, SourceFacesSayWhereTrianglesCameFrom) {
  const std::string points = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  EXPECT_TRUE(parse(MeshFormat::obj, points + "f 1 2 3\nf 1 3 4\n").source_face.empty());
  EXPECT_EQ(parse(MeshFormat::obj, points + "f 1 2 3\nf 1 3 4\nf 4 3 2 1\nf 1 2 4\n").source_face,
            (std::vector<std::uint32_t>{0, 1, 2, 2, 3}));
  EXPECT_EQ(parse(MeshFormat::obj, points + "f 4 3 2 1\nf 1 2 4\nf 1 2 3 4\n").source_face,
            (std::vector<std::uint32_t>{0, 0, 1, 2, 2}));
}

TEST(Polygon, TooManyCornersToCutAreRefused) {
  Points points;
  for (int i = 0; i < 10001; ++i) points.push_back({1.0 * i, i % 2 == 0 ? 0.0 : 1.0, 0});
  points.push_back({5000, -1, 0});
  const std::string error = file_error([&] { cut(points); });
  EXPECT_TRUE(has(error, ": face 0 is a polygon of 10002 corners that is not convex")) << error;
}

}  // namespace
}  // namespace meniscus::test
