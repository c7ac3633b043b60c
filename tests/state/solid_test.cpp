// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/state/solid.h"

#include "meniscus/core/error.h"
#include "meniscus/geometry/shapes.h"

#include <CGAL/squared_distance_3.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <thread>

namespace meniscus {
namespace {

using Eigen::Vector3d;
const Vector3d origin = Vector3d::Zero();

double coordinate() { return *rc::gen::inRange(-3000, 3001) * 1e-3; }
Vector3d any_point() { return {coordinate(), coordinate(), coordinate()}; }

/// What holds of every solid at every point: the nearest point is as far as said and lies on the
/// surface, and the normal is a unit vector along the way from it.
void check_contact(const Solid& solid, const Vector3d& x, double time = 0) {
  const SolidContact c = solid.query(x, time);
  RC_ASSERT(std::abs((x - c.point).norm() - std::abs(c.distance)) < 1e-12);
  RC_ASSERT(std::abs(c.normal.norm() - 1) < 1e-12);
  RC_ASSERT((x - c.point - c.distance * c.normal).norm() < 1e-9);
  RC_ASSERT(std::abs(solid.query(c.point, time).distance) < 1e-9);
}

/// The normal is the gradient of the distance, by central differences; false near the medial axis,
/// where they have no limit.
bool normal_is_gradient(const Solid& solid, const Vector3d& x) {
  const double h = 1e-5;
  const SolidContact c = solid.query(x, 0);
  Vector3d gradient;
  for (int d = 0; d < 3; ++d) {
    const Vector3d step = h * Vector3d::Unit(d);
    const SolidContact above = solid.query(x + step, 0), below = solid.query(x - step, 0);
    if ((above.normal - below.normal).norm() > 1e-2) return false;
    gradient[d] = (above.distance - below.distance) / (2 * h);
  }
  RC_ASSERT((gradient - c.normal).norm() < 1e-3);
  return true;
}

const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).toRotationMatrix();

std::vector<Solid> analytic_solids() {
  return {Solid::plane({0, 0, 0.3}, {1, 2, 2}),
          Solid::sphere({0.1, 0, 0}, 1),
          Solid::box({0, 0.2, 0}, {1, 2, 3}),
          Solid::box({0, 0.2, 0}, {1, 2, 3}, turn),
          Solid::cylinder({0, 0, -1}, {0.5, 1, 1}, 0.7),
          Solid::capsule({0, 0, -1}, {0.5, 1, 1}, 0.7)};
}

RC_GTEST_PROP(Solid, NearestPointAndNormalFit, ()) {
  const Vector3d x = any_point();
  for (const auto& solid : analytic_solids()) check_contact(solid, x);
}

RC_GTEST_PROP(Solid, NormalIsTheGradient, ()) {
  const Vector3d x = any_point();
  int checked = 0;
  for (const auto& solid : analytic_solids()) checked += normal_is_gradient(solid, x);
  RC_ASSERT(checked >= 1);  // a plane has no medial axis
}

RC_GTEST_PROP(Solid, DistancesInClosedForm, ()) {
  const Vector3d x = any_point();
  RC_ASSERT(std::abs(Solid::plane({0, 0, 1}, {0, 0, 5}).query(x, 0).distance - (x.z() - 1)) < 1e-14);
  RC_ASSERT(std::abs(Solid::sphere({1, 0, 0}, 2).query(x, 0).distance - ((x - Vector3d(1, 0, 0)).norm() - 2)) < 1e-14);
  const Eigen::Array3d q = x.array().abs() - Eigen::Array3d(1, 0.5, 2);
  const double box = q.max(0.0).matrix().norm() + std::min(q.maxCoeff(), 0.0);
  RC_ASSERT(std::abs(Solid::box(origin, {2, 1, 4}).query(x, 0).distance - box) < 1e-14);
  RC_ASSERT(std::abs(Solid::box(origin, {2, 1, 4}, turn).query(turn * x, 0).distance - box) < 1e-14);
  const Eigen::Array2d p(std::hypot(x.x(), x.y()) - 0.7, std::abs(x.z()) - 1.5);
  const double cylinder = p.max(0.0).matrix().norm() + std::min(p.maxCoeff(), 0.0);
  RC_ASSERT(std::abs(Solid::cylinder({0, 0, -1.5}, {0, 0, 1.5}, 0.7).query(x, 0).distance - cylinder) < 1e-14);
  const double on_axis = std::min(1.5, std::max(-1.5, x.z()));
  const double capsule = (x - Vector3d(0, 0, on_axis)).norm() - 0.7;
  RC_ASSERT(std::abs(Solid::capsule({0, 0, -1.5}, {0, 0, 1.5}, 0.7).query(x, 0).distance - capsule) < 1e-14);
}

TEST(Solid, ChoicesWhereNothingIsUnique) {
  const SolidContact center = Solid::sphere({1, 2, 3}, 2).query({1, 2, 3}, 0);
  EXPECT_EQ(center.distance, -2);
  EXPECT_EQ(center.normal.norm(), 1);
  const SolidContact cube = Solid::box(origin, {2, 2, 2}).query(origin, 0);
  EXPECT_EQ(cube.normal, Vector3d(1, 0, 0));
  const SolidContact corner = Solid::box(origin, {2, 2, 2}).query({1, -1, 1}, 0);
  EXPECT_EQ(corner.distance, 0);
  EXPECT_EQ(corner.normal, Vector3d(1, 0, 0));
  EXPECT_EQ(Solid::box(origin, {2, 2, 2}).query({2, 2, 0}, 0).normal, Vector3d(1, 1, 0) / std::sqrt(2));
  const SolidContact axis = Solid::cylinder({0, 0, -5}, {0, 0, 5}, 1).query(origin, 0);
  EXPECT_EQ(axis.distance, -1);
  EXPECT_EQ(axis.normal.z(), 0);
}

TEST(Solid, MeshBoxHasTheBoxDistance) {
  // Points at, beside and beyond faces, edges and corners, inside and out: the sign is the test.
  const Solid mesh = Solid::mesh(to_mesh_data(make_box(origin, {2, 1, 4}, 0.5)));
  const Solid box = Solid::box(origin, {2, 1, 4});
  const std::array<double, 8> shares{0, 0.3, 0.5, 0.98, 0.9999999, 1.0000001, 1.02, 1.5};
  for (const double a : shares)
    for (const double b : shares)
      for (const double c : shares)
        for (const double sign : {-1.0, 1.0}) {
          const Vector3d x(sign * a, sign * b * 0.5, -sign * c * 2);
          const SolidContact found = mesh.query(x, 0), exact = box.query(x, 0);
          EXPECT_NEAR(found.distance, exact.distance, 1e-13) << x.transpose();
          EXPECT_EQ(found.distance < 0, exact.distance < 0) << x.transpose();
          if (exact.distance > 1e-6) {
            EXPECT_NEAR((found.normal - exact.normal).norm(), 0, 1e-7);
          }
        }
}

/// A spike and a waist: nearest to many points is a tip or an edge, where one face's normal alone misleads.
TEST(Solid, MeshSignAtSharpAndReflexEdges) {
  const Mesh cone = make_surface_of_revolution({[](double s) { return Eigen::Vector2d(0.2 * s, s - 1); },
                                                [](double s) { return Eigen::Vector2d(0.2 * (1 - s), 0); }},
                                               0.1);  // a spike pointing down, its tip at -1
  const Solid spike = Solid::mesh(to_mesh_data(cone));
  for (int k = 0; k < 64; ++k) {
    const double angle = k * 0.1;
    const Vector3d around(std::cos(angle), std::sin(angle), 0);
    EXPECT_GT(spike.query(Vector3d(0, 0, -1.05) + 0.01 * around, 0).distance, 0);  // nearest to the tip
    EXPECT_GT(spike.query(Vector3d(0, 0, 0.05) + 0.23 * around, 0).distance, 0);   // nearest to the rim
    EXPECT_LT(spike.query(Vector3d(0, 0, -0.9) + 0.01 * around, 0).distance, 0);
  }
  const Mesh hourglass = make_surface_of_revolution(
      {[](double s) { return Eigen::Vector2d(s, -1); }, [](double s) { return Eigen::Vector2d(1 - 0.8 * s, s - 1); },
       [](double s) { return Eigen::Vector2d(0.2 + 0.8 * s, s); }, [](double s) { return Eigen::Vector2d(1 - s, 1); }},
      0.1);
  const Solid waist = Solid::mesh(to_mesh_data(hourglass));
  for (int k = 0; k < 64; ++k) {
    const Vector3d around(std::cos(k * 0.1), std::sin(k * 0.1), 0);
    const SolidContact in = waist.query(0.1 * around, 0), out = waist.query(0.25 * around, 0);
    EXPECT_LT(in.distance, 0);
    EXPECT_GT(out.distance, 0);
    EXPECT_GT(in.normal.dot(around), 0.8);
    EXPECT_GT(out.normal.dot(around), 0.5);
  }
}

RC_GTEST_PROP(Solid, MeshSphereTellsInsideFromOutside, ()) {
  static const double radius = 1.2, edge = 0.1;
  static const Solid mesh = Solid::mesh(to_mesh_data(make_sphere({0.1, 0.2, 0.3}, radius, edge)));
  const Vector3d x = any_point();
  const double exact = (x - Vector3d(0.1, 0.2, 0.3)).norm() - radius;
  const double sagitta = edge * edge / (2 * radius);  // how far faces lie inside the sphere
  const double found = mesh.query(x, 0).distance;
  RC_ASSERT(found >= exact - 1e-12);
  RC_ASSERT(found <= exact + sagitta);
  check_contact(mesh, x);
}

RC_GTEST_PROP(Solid, MeshNormalIsTheGradient, ()) {
  static const Solid mesh = Solid::mesh(to_mesh_data(make_torus(origin, 1.5, 0.6, 0.3)));
  normal_is_gradient(mesh, any_point());
  check_contact(mesh, any_point());
}

/// Near the surface a list of triangles is asked, beyond a tree: the same distance, and nothing near is passed over.
RC_GTEST_PROP(Solid, WhatIsNearAMeshIsNotPassedOver, ()) {
  static const Solid mesh = Solid::mesh(to_mesh_data(make_torus(origin, 1.5, 0.6, 0.2)));
  static const double sagitta = 0.2 * 0.2 / (2 * 0.6);
  const Vector3d x = any_point();
  const double exact = std::hypot(std::hypot(x.x(), x.y()) - 1.5, x.z()) - 0.6;
  const double found = mesh.query(x, 0).distance;
  RC_ASSERT(std::abs(found - exact) <= sagitta);  // faces lie inside of the tube and outside of the hole
  for (const double margin : {0.0, 0.05, 0.3}) RC_ASSERT(mesh.is_near(x, 0, margin) || found > margin);
}

/// Quick answers leave most triangles out; the nearest is as near as the nearest of all, flat and thin ones included.
RC_GTEST_PROP(Solid, TheNearestTriangleOfAMeshIsTheNearestOfAll, ()) {
  static const Mesh surface = [] {
    Mesh mesh = make_torus(origin, 1.5, 0.6, 0.3);
    for (const auto v : mesh.vertices()) {  // squeezed to a sixtieth along z, and turned out of the axes
      const Vector3d p = to_eigen(mesh.point(v));
      mesh.point(v) = to_point(turn * Vector3d(p.x(), p.y(), p.z() / 60));
    }
    return mesh;
  }();
  static const Solid solid = Solid::mesh(to_mesh_data(surface));
  const auto corner = *rc::gen::inRange<std::uint32_t>(0, static_cast<std::uint32_t>(surface.number_of_vertices()));
  const double distance = std::pow(10.0, *rc::gen::inRange(-9, 1));  // from on the surface, but for rounding, to far
  const Vector3d x = to_eigen(surface.point(VertexIndex(corner))) + distance * any_point();
  double least2 = std::numeric_limits<double>::infinity();
  for (const auto f : surface.faces()) {
    const auto h = surface.halfedge(f);
    const Kernel::Triangle_3 triangle(surface.point(surface.source(h)), surface.point(surface.target(h)),
                                      surface.point(surface.target(surface.next(h))));
    least2 = std::min(least2, CGAL::squared_distance(to_point(x), triangle));
  }
  RC_ASSERT(std::abs(std::abs(solid.query(x, 0).distance) - std::sqrt(least2)) < 1e-12);
}

TEST(Solid, MeshVerticesLieOnItsSurface) {
  const MeshData data = to_mesh_data(make_torus(origin, 1.5, 0.6, 0.3));
  const Solid mesh = Solid::mesh(data);
  for (const auto& p : data.points) {
    const Vector3d x = Vector3d::Map(p.data());
    const SolidContact c = mesh.query(x, 0);
    EXPECT_NEAR(c.distance, 0, 1e-15);
    const double r = std::hypot(x.x(), x.y());
    const Vector3d exact = (x - Vector3d(x.x(), x.y(), 0) * (1.5 / r)) / 0.6;
    EXPECT_GT(c.normal.dot(exact), 0.97);
  }
}

RC_GTEST_PROP(Solid, MovesAsAWhole, ()) {
  const Vector3d x = any_point(), velocity = any_point();
  const double time = *rc::gen::inRange(-20, 21) * 0.1;
  for (Solid solid : analytic_solids()) {
    const SolidContact still = solid.query(x - velocity * time, 7);
    solid.set_velocity(velocity);
    const SolidContact moved = solid.query(x, time);
    RC_ASSERT(moved.distance == still.distance);
    RC_ASSERT(moved.normal == still.normal);
    RC_ASSERT((moved.point - still.point - velocity * time).norm() < 1e-14);
    RC_ASSERT(solid.velocity(time) == velocity);
  }
}

TEST(Solid, FollowsKeys) {
  Solid solid = Solid::plane(origin, {0, 0, 1});
  solid.set_keys({{1, {0, 0, 1}}, {2, {0, 0, 3}}, {4, {0, 0, 0}}});
  const auto height = [&](double time) { return -solid.query(origin, time).distance; };
  EXPECT_EQ(height(-5), 1);
  EXPECT_EQ(height(1), 1);
  EXPECT_EQ(height(1.5), 2);
  EXPECT_EQ(height(2), 3);
  EXPECT_EQ(height(3), 1.5);
  EXPECT_EQ(height(9), 0);
  const auto speed = [&](double time) { return solid.velocity(time).z(); };
  EXPECT_EQ(speed(0.5), 0);
  EXPECT_EQ(speed(1), 0);
  EXPECT_EQ(speed(1.5), 2);
  EXPECT_EQ(speed(2), 2);
  EXPECT_EQ(speed(2.5), -1.5);
  EXPECT_EQ(speed(4), -1.5);
  EXPECT_EQ(speed(4.5), 0);
  for (const double time : {0.2, 1.3, 2.7, 5.0})  // the derivative of the position
    EXPECT_NEAR((height(time + 1e-4) - height(time - 1e-4)) / 2e-4, speed(time), 1e-9);
}

RC_GTEST_PROP(Solid, IsNearNeverMisses, ()) {
  static const Solid mesh = Solid::mesh(to_mesh_data(make_torus(origin, 1, 0.4, 0.3)));
  auto solids = analytic_solids();
  solids.push_back(mesh);
  const Vector3d x = any_point(), velocity = any_point();
  const double margin = *rc::gen::inRange(0, 100) * 1e-2, time = 0.3;
  for (auto& solid : solids) {
    solid.set_velocity(velocity);
    const Eigen::AlignedBox3d box(x - Vector3d(0.1, 0.2, 0.3), x + Vector3d(0.3, 0.2, 0.1));
    if (solid.query(x, time).distance <= margin) RC_ASSERT(solid.is_near(box, time, margin));
    if (solid.query(x, time).distance <= 0) RC_ASSERT(solid.is_near(x, time, 0));
    RC_ASSERT(!solid.is_near(Eigen::AlignedBox3d(), time, margin));
  }
}

/// The distance's gradient at x by central differences.
Vector3d gradient(const Solid& solid, const Vector3d& x) {
  constexpr double h = 1e-6;
  Vector3d g;
  for (int k = 0; k < 3; ++k)
    g[k] = (solid.query(x + h * Vector3d::Unit(k), 0).distance - solid.query(x - h * Vector3d::Unit(k), 0).distance) /
           (2 * h);
  return g;
}

TEST(Solid, RoundedEdgesTurnTheNormalWithTheSurface) {
  const double r = 0.1;
  for (const Solid& solid :
       {Solid::box(origin, {2, 2, 2}, Eigen::Matrix3d::Identity(), r), Solid::cylinder({0, 0, -1}, {0, 0, 1}, 1, r)}) {
    // Across the edge x = z = 1, y = 0: a quarter circle of radius r about (0.9, 0, 0.9).
    for (const double degrees : {1.0, 30.0, 45.0, 77.0, 89.0}) {
      const Vector3d n(std::cos(degrees * M_PI / 180), 0, std::sin(degrees * M_PI / 180));
      const Vector3d center(1 - r, 0, 1 - r), on = center + r * n;
      for (const double height : {-0.5 * r, 0.0, 0.3}) {
        const SolidContact contact = solid.query(on + height * n, 0);
        EXPECT_NEAR(contact.distance, height, 1e-12);
        EXPECT_NEAR((contact.point - on).norm(), 0, 1e-12);
        EXPECT_NEAR((contact.normal - n).norm(), 0, 1e-12);
      }
    }
    for (const Vector3d& x : {Vector3d(1.05, 0.1, 0.98), Vector3d(0.95, 0.1, 0.97), Vector3d(0.2, 0.1, 1.2)})
      EXPECT_NEAR((gradient(solid, x) - solid.query(x, 0).normal).norm(), 0, 1e-5);
  }
  EXPECT_THROW(Solid::box(origin, {1, 1, 1}, Eigen::Matrix3d::Identity(), -0.1), UsageError);
}

TEST(Solid, ADiscHoldsLiquidOnOneSide) {
  const Solid disc = Solid::disc({1, 2, 3}, {0, 0, -2}, 0.5);
  const SolidContact below = disc.query({1.2, 2.1, 2.6}, 0);
  EXPECT_NEAR(below.distance, 0.4, 1e-15);
  EXPECT_NEAR((below.point - Vector3d(1.2, 2.1, 3)).norm(), 0, 1e-15);
  EXPECT_EQ(below.normal, Vector3d(0, 0, -1));
  EXPECT_NEAR(disc.query({1.2, 2.1, 3.1}, 0).distance, -0.1, 1e-15);  // behind: inside
  EXPECT_GT(disc.query({1.2, 2.1, 4}, 0).distance, 0);                // far behind: not
  EXPECT_NEAR(disc.query({1.8, 2, 3.4}, 0).distance, 0.5, 1e-15);     // 3-4-5 from the rim
  EXPECT_NEAR((disc.rim_point({1.4, 2, 3}, 0, 1) - Vector3d(1.5, 2, 3)).norm(), 0, 1e-15);
  EXPECT_EQ(disc.rim_point({1.1, 2, 3}, 0, 1), Vector3d(1.1, 2, 3));
  EXPECT_EQ(disc.rim_point({1.4, 2, 3}, 0, 0.1), Vector3d(1.4, 2, 3)) << "an island, not the middle of an edge";
}

TEST(Solid, IsNearRejects) {
  const Eigen::AlignedBox3d box(Vector3d(0, 0, 2), Vector3d(1, 1, 3));
  EXPECT_FALSE(Solid::plane(origin, {0, 0, 1}).is_near(box, 0, 1.9));
  EXPECT_TRUE(Solid::plane(origin, {0, 0, 1}).is_near(box, 0, 2));
  EXPECT_FALSE(Solid::sphere(origin, 1).is_near(box, 0, 0.9));
  Solid rising = Solid::sphere(origin, 1);
  rising.set_velocity({0, 0, 1});
  EXPECT_TRUE(rising.is_near(box, 1, 0));
}

TEST(Solid, RefusesNonsense) {
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  for (const double bad : {0.0, -1.0, nan, inf}) {
    EXPECT_THROW(Solid::sphere(origin, bad), UsageError);
    EXPECT_THROW(Solid::box(origin, {1, bad, 1}), UsageError);
    EXPECT_THROW(Solid::cylinder(origin, {0, 0, 1}, bad), UsageError);
    EXPECT_THROW(Solid::capsule(origin, {0, 0, 1}, bad), UsageError);
  }
  EXPECT_THROW(Solid::plane(origin, origin), UsageError);
  EXPECT_THROW(Solid::plane({nan, 0, 0}, {0, 0, 1}), UsageError);
  EXPECT_THROW(Solid::cylinder({1, 2, 3}, {1, 2, 3}, 1), UsageError);
  EXPECT_THROW(Solid::capsule({1, 2, 3}, {1, 2, inf}, 1), UsageError);
  EXPECT_THROW(Solid::box(origin, {1, 1, 1}, -Eigen::Matrix3d::Identity()), UsageError);
  Solid solid = Solid::sphere(origin, 1);
  EXPECT_THROW(solid.set_velocity({nan, 0, 0}), UsageError);
  EXPECT_THROW(solid.set_keys({{1, origin}, {1, origin}}), UsageError);
  EXPECT_THROW(solid.set_keys({{nan, origin}}), UsageError);
}

TEST(Solid, RefusesMeshesThatBoundNothing) {
  MeshData open = to_mesh_data(make_box(origin, {1, 1, 1}, 1));
  MeshData inward = open;
  open.triangles.pop_back();
  for (auto& t : inward.triangles) std::swap(t[0], t[1]);
  EXPECT_THROW(Solid::mesh(open), GeometryError);
  EXPECT_THROW(Solid::mesh(inward), GeometryError);
  EXPECT_THROW(Solid::mesh({}), GeometryError);
  try {
    Solid::mesh(open);
  } catch (const GeometryError& error) {
    EXPECT_NE(std::string(error.what()).find("hole"), std::string::npos);
    EXPECT_EQ(error.vertices().size(), 3u);
  }
}

TEST(Solid, QueriesRunInParallel) {
  const Solid mesh = Solid::mesh(to_mesh_data(make_torus(origin, 1, 0.4, 0.1)));
  const auto sum = [&] {
    double total = 0;
    for (int k = 0; k < 2000; ++k)
      total += mesh.query({std::cos(0.37 * k), std::sin(0.91 * k), std::cos(1.7 * k)}, 0).distance;
    return total;
  };
  std::array<double, 4> sums{};
  std::vector<std::thread> threads;  // before anything else has queried it
  for (auto& result : sums) threads.emplace_back([&result, &sum] { result = sum(); });
  for (auto& thread : threads) thread.join();
  for (const double result : sums) EXPECT_EQ(result, sum());
}

}  // namespace
}  // namespace meniscus
