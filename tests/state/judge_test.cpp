// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/state/judge.h"

#include "meniscus/geometry/shapes.h"

#include <CGAL/boost/graph/Euler_operations.h>
#include <gtest/gtest.h>

#include <limits>

namespace meniscus {
namespace {

Mesh ball(const Eigen::Vector3d& center = {0, 0, 0}) { return make_icosphere(center, 1, 3); }

TEST(Judge, PassesWhatIsSound) {
  EXPECT_EQ(judge::defect(ball()), "");
  EXPECT_EQ(judge::defect(make_torus({0, 0, 0}, 1, 0.4, 0.2)), "");
  EXPECT_EQ(judge::defect(Drop(ball())), "");
  const judge::Soup soup = judge::soup_of(make_box({0, 0, 0}, {1, 2, 3}, 0.5));
  ASSERT_EQ(judge::components_of(soup).size(), 1u);
  EXPECT_NEAR(judge::volume_of(soup, judge::components_of(soup)[0]), 6, 1e-12);
}

TEST(Judge, FindsAHole) {
  Mesh mesh = ball();
  CGAL::Euler::remove_face(mesh.halfedge(FaceIndex(4)), mesh);
  EXPECT_NE(judge::topology_defect(mesh).find("has no opposite"), std::string::npos);
}

TEST(Judge, FindsWhatLooksInward) {
  Mesh mesh = ball();
  for (auto& point : mesh.points()) point = Point(-point.x(), point.y(), point.z());
  EXPECT_NE(judge::topology_defect(mesh).find("volume"), std::string::npos);
}

TEST(Judge, AllowsABubbleInTheLiquidAndNowhereElse) {
  const auto with_bubble_at = [](double x) {
    Mesh bubble = ball(), mesh = ball();
    for (auto& p : bubble.points()) p = Point(x - 0.3 * p.x(), 0.3 * p.y(), 0.3 * p.z());
    mesh += bubble;
    return mesh;
  };
  EXPECT_EQ(judge::defect(with_bubble_at(0.2)), "");
  EXPECT_NE(judge::topology_defect(with_bubble_at(2)).find("volume"), std::string::npos);
}

TEST(Judge, FindsANumberThatIsNone) {
  Mesh mesh = ball();
  mesh.point(VertexIndex(7)) = Point(0, std::numeric_limits<double>::quiet_NaN(), 0);
  EXPECT_NE(judge::topology_defect(mesh).find("not finite"), std::string::npos);
}

TEST(Judge, FindsAFold) {
  Mesh mesh = ball();
  mesh.point(VertexIndex(20)) = CGAL::ORIGIN - 1.5 * (mesh.point(VertexIndex(20)) - CGAL::ORIGIN);
  EXPECT_EQ(judge::topology_defect(mesh), "");
  EXPECT_NE(judge::defect(mesh), "") << "a spike goes through the other side";
}

TEST(Judge, FindsTwoShellsThatCross) {
  Mesh mesh = ball();
  mesh += ball({1.5, 0.1, 0.2});
  EXPECT_EQ(judge::topology_defect(mesh), "");
  EXPECT_EQ(judge::defect(mesh), "the surface meets itself");
}

TEST(Judge, FindsStaleConnectivity) {
  Drop drop(ball());
  CGAL::Euler::flip_edge(drop.mesh().halfedge(EdgeIndex(5)), drop.mesh());
  EXPECT_NE(judge::connectivity_defect(drop), "");
  drop.connectivity().rebuild(drop.mesh());
  EXPECT_EQ(judge::connectivity_defect(drop), "");
}

}  // namespace
}  // namespace meniscus
