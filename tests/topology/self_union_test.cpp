// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/topology/self_union.h"

#include "meniscus/geometry/measure.h"
#include "meniscus/geometry/shapes.h"
#include "support/judge.h"

#include <gtest/gtest.h>

#include <array>

namespace meniscus {
namespace {

using Eigen::Vector3d;

/// A plate of 2 x 2 x 0.2 into whose top a square dent with these corners runs to a tip. With the tip under the plate
/// (z < 0) the top goes through the underside.
MeshData dented_plate(double x_min, double x_max, double y_min, double y_max, const Vector3d& tip) {
  MeshData plate;
  const auto square = [&](double x0, double x1, double y0, double y1, double z) {
    plate.points.push_back({x0, y0, z});
    plate.points.push_back({x1, y0, z});
    plate.points.push_back({x1, y1, z});
    plate.points.push_back({x0, y1, z});
  };
  square(-1, 1, -1, 1, 0);                           // 0-3: the underside
  square(-1, 1, -1, 1, 0.2);                         // 4-7: the top
  square(x_min, x_max, y_min, y_max, 0.2);           // 8-11: the dent
  plate.points.push_back({tip[0], tip[1], tip[2]});  // 12
  plate.triangles = {{0, 2, 1}, {0, 3, 2}};
  for (std::uint32_t k = 0; k < 4; ++k) {
    const std::uint32_t next = (k + 1) % 4;
    plate.triangles.push_back({k, next, 4 + next});
    plate.triangles.push_back({k, 4 + next, 4 + k});
    plate.triangles.push_back({4 + k, 4 + next, 8 + next});
    plate.triangles.push_back({4 + k, 8 + next, 8 + k});
    plate.triangles.push_back({8 + k, 8 + next, 12});
  }
  return plate;
}

/// What the dent takes, a little higher than the plate.
MeshData dent(double x_min, double x_max, double y_min, double y_max, const Vector3d& tip) {
  const double above = 0.5, share = 1 + above / (0.2 - tip.z());  // the pyramid goes on, beyond the top
  MeshData pyramid;
  for (const auto& [x, y] : {std::pair(x_min, y_min), {x_max, y_min}, {x_max, y_max}, {x_min, y_max}}) {
    const Vector3d corner = tip + share * (Vector3d(x, y, 0.2) - tip);
    pyramid.points.push_back({corner[0], corner[1], corner[2]});
  }
  pyramid.points.push_back({tip[0], tip[1], tip[2]});
  pyramid.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 0, 4}, {2, 1, 4}, {3, 2, 4}, {0, 3, 4}};
  return pyramid;
}

MeshData data_of(const BooleanResult& result) {
  MeshData data;
  data.points = result.points;
  data.triangles = result.triangles;
  return data;
}

Eigen::AlignedBox3d everywhere() { return {Vector3d::Constant(-10), Vector3d::Constant(10)}; }

struct Dent {
  const char* name;
  double x_min, x_max, y_min, y_max;
  Vector3d tip;

  friend void PrintTo(const Dent& dent, std::ostream* out) { *out << dent.name; }
};

class SidesOfAFilm : public testing::TestWithParam<Dent> {};

TEST_P(SidesOfAFilm, ThatWentThroughEachOtherLeaveAHole) {
  const auto& [name, x_min, x_max, y_min, y_max, tip] = GetParam();
  const MeshData film = dented_plate(x_min, x_max, y_min, y_max, tip);
  ASSERT_EQ(judge::topology_defect(to_mesh(film)), "");
  ASSERT_NE(judge::defect(to_mesh(film)), "");
  const BooleanResult found = unite_with_itself(view_of(film), everywhere(), false);
  ASSERT_TRUE(found.ok()) << found.message;
  EXPECT_EQ(found.outcome, BooleanOutcome::crossing);
  EXPECT_EQ(judge::defect(to_mesh(data_of(found))), "");
  // The same solid: the plate without the pyramid, which goes all the way through.
  const MeshData plate = to_mesh_data(make_box({0, 0, 0.1}, {2, 2, 0.2}, 10)),
                 pyramid = dent(x_min, x_max, y_min, y_max, tip);
  const BooleanResult wanted = boolean(view_of(plate), view_of(pyramid), BooleanOperation::subtract);
  ASSERT_TRUE(wanted.ok()) << wanted.message;
  EXPECT_NEAR(found.volume, wanted.volume, 1e-12);
  const Mesh mesh = to_mesh(data_of(found));
  EXPECT_EQ(static_cast<int>(mesh.number_of_vertices()) - static_cast<int>(mesh.number_of_edges()) +
                static_cast<int>(mesh.number_of_faces()),
            0)
      << "a torus";
}

INSTANTIATE_TEST_SUITE_P(SelfUnion, SidesOfAFilm,
                         testing::Values(Dent{"across_an_edge", -0.5, 0.5, -0.5, 0.5, {0.013, 0.007, -0.1}},
                                         Dent{"within_one_face", 0.3, 0.6, -0.6, -0.3, {0.47, -0.41, -0.1}}),
                         [](const auto& dent) { return dent.param.name; });

TEST(SelfUnion, RefusesWhatIsInsideOutByMoreThanATenth) {
  const MeshData film = dented_plate(-0.5, 0.5, -0.5, 0.5, {0.013, 0.007, -0.9});
  const BooleanResult found = unite_with_itself(view_of(film), everywhere(), false);
  EXPECT_EQ(found.refusal, BooleanRefusal::rounding);
  EXPECT_EQ(found.message, "a part of the surface is inside out");
}

TEST(SelfUnion, OverlapsAndHolesAtOnce) {
  const Vector3d tip(0.013, 0.007, -0.1);
  Mesh surface = to_mesh(dented_plate(-0.5, 0.5, -0.5, 0.5, tip));
  const Mesh ball = make_icosphere({1.03, 0.02, 0.11}, 0.37, 4);
  surface += ball;
  const Drop drop(surface);
  const BooleanResult found = unite_with_itself(view_of(drop), everywhere(), false);
  ASSERT_TRUE(found.ok()) << found.message;
  EXPECT_EQ(judge::defect(to_mesh(data_of(found))), "");
  const MeshData plate = to_mesh_data(make_box({0, 0, 0.1}, {2, 2, 0.2}, 10)),
                 pyramid = dent(-0.5, 0.5, -0.5, 0.5, tip), ball_data = to_mesh_data(ball);
  const MeshData with_hole = data_of(boolean(view_of(plate), view_of(pyramid), BooleanOperation::subtract));
  EXPECT_NEAR(found.volume, boolean(view_of(with_hole), view_of(ball_data), BooleanOperation::unite).volume, 1e-12);
}

}  // namespace
}  // namespace meniscus
