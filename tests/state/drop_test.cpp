// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/state/drop.h"

#include "meniscus/core/error.h"
#include "meniscus/geometry/shapes.h"

#include <CGAL/boost/graph/Euler_operations.h>

#include <gtest/gtest.h>

#include <limits>
#include <type_traits>

namespace meniscus {
namespace {

Drop ball(double radius = 0.2) { return Drop(make_icosphere({0, 0, 0}, radius, 3)); }

TEST(Drop, ViewsAreThePropertyMapsThemselves) {
  Drop drop = ball();
  drop.positions()(1, 5) = 42;
  EXPECT_EQ(drop.mesh().point(VertexIndex(5)).y(), 42);
  drop.velocities()(2, 3) = -7;
  const Drop& constant = drop;
  EXPECT_EQ(constant.velocities()(2, 3), -7);
}

TEST(Drop, CopiesShareNothingAndMovesKeepTheViews) {
  Drop drop = ball();
  Drop copy(drop);
  copy.velocities()(0, 0) = 1;
  copy.positions()(0, 0) = 99;
  EXPECT_EQ(drop.velocities()(0, 0), 0);
  EXPECT_NE(drop.positions()(0, 0), 99);
  const Drop moved(std::move(copy));
  EXPECT_EQ(moved.velocities()(0, 0), 1);
  EXPECT_EQ(moved.positions()(0, 0), 99);
}

TEST(Drop, GarbageCollectionKeepsWhatIsAlive) {
  Drop drop = ball();
  for (Eigen::Index i = 0; i < drop.velocities().cols(); ++i) drop.velocities()(0, i) = drop.positions()(2, i);
  Mesh& mesh = drop.mesh();
  const auto edge = *mesh.edges().begin();
  ASSERT_TRUE(CGAL::Euler::does_satisfy_link_condition(edge, mesh));
  CGAL::Euler::collapse_edge(edge, mesh);
  drop.connectivity().rebuild(mesh);
  const double volume = drop.volume();
  EXPECT_FALSE(drop.collect_garbage(0.5));
  EXPECT_TRUE(drop.collect_garbage(0));
  EXPECT_EQ(drop.num_rows(), 91u);
  EXPECT_NEAR(drop.volume(), volume, 1e-15);
  for (Eigen::Index i = 0; i < drop.velocities().cols(); ++i)
    EXPECT_EQ(drop.velocities()(0, i), drop.positions()(2, i));
}

TEST(Drop, RefusesWhatIsNoDrop) {
  EXPECT_THROW(Drop{Mesh()}, GeometryError);
  Mesh open = make_icosphere({0, 0, 0}, 1, 2);
  CGAL::Euler::remove_face(open.halfedge(*open.faces().begin()), open);
  EXPECT_THROW(Drop{open}, GeometryError);
  Mesh infinite = make_icosphere({0, 0, 0}, 1, 2);
  infinite.point(VertexIndex(4)) = Point(0, std::numeric_limits<double>::infinity(), 0);
  EXPECT_THROW(Drop{infinite}, GeometryError);
  MeshData inward = to_mesh_data(make_icosphere({0, 0, 0}, 1, 2));
  for (auto& triangle : inward.triangles) std::swap(triangle[0], triangle[1]);
  EXPECT_THROW(Drop{to_mesh(inward)}, GeometryError);
}

TEST(DropData, DropsComeBackFromTheirSoup) {
  std::vector<Drop> drops{ball(), Drop(make_icosphere({1, 0, 0}, 0.1, 2))};
  drops[0].set_id(7);
  drops[1].set_id(3);
  drops[0].velocities().setRandom();
  drops[1].set_target_volume(0.005);
  drops[1].contact()[2] = Contact::line;
  const std::vector<Drop> back = to_drops(to_mesh_data(drops));
  ASSERT_EQ(back.size(), 2u);  // in the order of their ids
  EXPECT_EQ(back[0].id(), 3);
  EXPECT_EQ(back[1].id(), 7);
  EXPECT_EQ(back[0].target_volume(), 0.005);
  EXPECT_EQ(back[0].contact()[2], Contact::line);
  EXPECT_EQ(back[1].positions(), std::as_const(drops[0]).positions());
  EXPECT_EQ(back[1].velocities(), std::as_const(drops[0]).velocities());
}

TEST(DropData, WithoutIdsEachComponentIsADrop) {
  std::vector<Drop> drops{ball(), Drop(make_icosphere({1, 0, 0}, 0.1, 2))};
  MeshData data = to_mesh_data(drops);
  data.attributes.clear();
  data.comments.clear();
  EXPECT_EQ(to_drops(data).size(), 2u);
}

TEST(DropData, AFaceBetweenTwoDropsIsAnError) {
  MeshData data = to_mesh_data({ball()});
  for (auto& attribute : data.attributes)
    if (attribute.name == "drop") attribute.values[0] = 1;
  EXPECT_THROW(to_drops(data), GeometryError);
}

TEST(Drop, AVectorThatGrowsMovesItsDrops) {
  static_assert(std::is_nothrow_move_constructible_v<Drop> && std::is_nothrow_move_assignable_v<Drop>,
                "or else each growth copies meshes and throws kept factors away");
  std::vector<Drop> drops;
  drops.push_back(ball());
  const double* const data = std::as_const(drops[0]).positions().data();
  drops.reserve(drops.capacity() + 1);
  EXPECT_EQ(std::as_const(drops[0]).positions().data(), data);
}

TEST(Drop, ACopySolvesAsItsOriginalDoes) {
  Drop drop = ball();
  EXPECT_TRUE(drop.flow_pattern_changed());
  Drop copy(drop);
  EXPECT_FALSE(copy.flow_pattern_changed()) << "which would choose another solver, and other last bits";
}

}  // namespace
}  // namespace meniscus
