// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/state/drop.h"

#include "meniscus/core/error.h"
#include "meniscus/geometry/shapes.h"

#include <CGAL/boost/graph/Euler_operations.h>

#include <gtest/gtest.h>

#include <cmath>
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

/// The box takes four vertices at a time, unless some are removed.
TEST(Drop, ItsBoxHoldsExactlyItsVertices) {
  for (int corners = 4; corners <= 13; ++corners) {  // a double pyramid: corners + 2 vertices
    Mesh mesh;
    const VertexIndex top = mesh.add_vertex({0.3, -0.2, 1.5}), bottom = mesh.add_vertex({0.1, 0.4, -1.25});
    std::vector<VertexIndex> rim;
    for (int k = 0; k < corners; ++k) {
      const double angle = 2 * M_PI * k / corners;
      rim.push_back(mesh.add_vertex({2 * std::cos(angle), 3 * std::sin(angle), 0.01 * k}));
    }
    for (int k = 0; k < corners; ++k) {
      const VertexIndex a = rim[k], b = rim[(k + 1) % corners];
      mesh.add_face(a, b, top);
      mesh.add_face(b, a, bottom);
    }
    Drop drop{std::move(mesh)};
    const auto expect_exact = [&] {
      Eigen::AlignedBox3d exact;
      for (const auto v : drop.mesh().vertices()) exact.extend(to_eigen(drop.mesh().point(v)));
      const Eigen::AlignedBox3d box = bounding_box(drop);
      EXPECT_EQ(box.min(), exact.min()) << corners;
      EXPECT_EQ(box.max(), exact.max()) << corners;
    };
    expect_exact();
    if (corners < 5) continue;
    const VertexIndex gone = rim[0];  // (2, 0, 0), the only one so far out
    CGAL::Euler::collapse_edge(drop.mesh().edge(drop.mesh().halfedge(gone, rim[1])), drop.mesh());
    drop.connectivity().rebuild(drop.mesh());
    ASSERT_EQ(drop.mesh().number_of_removed_vertices(), 1u);
    expect_exact();
  }
}

TEST(KeptState, TellsHowFarVerticesMovedAndWhetherContactChanged) {
  Drop drop = ball();  // 92 vertices
  KeptState kept;
  kept.keep(drop);
  EXPECT_EQ(kept.moved(drop, 1), 0);
  drop.positions().col(7) += Eigen::Vector3d(0.03, 0, -0.04);
  drop.positions().col(60) += Eigen::Vector3d(0, 0.01, 0);
  EXPECT_NEAR(kept.moved(drop, 1), 0.05, 1e-15);
  EXPECT_EQ(kept.moved(drop, 0.04), std::numeric_limits<double>::infinity());
  EXPECT_TRUE(kept.has_contact_of(drop));
  drop.contact()[3] = Contact::line;
  EXPECT_FALSE(kept.has_contact_of(drop));
  kept.keep(drop);
  EXPECT_TRUE(kept.has_contact_of(drop));
  drop.contact()[3] = Contact::wetted;
  EXPECT_FALSE(kept.has_contact_of(drop));
  drop.set_slack(1);
  kept.restore(drop);
  EXPECT_TRUE(kept.has_contact_of(drop));
  EXPECT_EQ(drop.slack(), 0) << "it was tried elsewhere since it was looked at";
  for (const Eigen::Index at : {0, 50, 91}) {
    Drop lost = ball();
    kept.keep(lost);
    lost.positions()(1, at) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(kept.moved(lost, 1), std::numeric_limits<double>::infinity()) << at;
  }
}

TEST(KeptState, HoldsASmallerDropAfterALargerOne) {
  Drop large = ball(), small(make_icosphere({1, 0, 0}, 0.1, 1));
  KeptState kept;
  kept.keep(large);
  kept.keep(small);
  ASSERT_EQ(kept.positions().cols(), small.positions().cols());
  const Eigen::Matrix3Xd before = small.positions();
  small.positions().row(0).array() += 5;
  kept.restore(small);
  EXPECT_EQ(Eigen::Matrix3Xd(small.positions()), before);
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
