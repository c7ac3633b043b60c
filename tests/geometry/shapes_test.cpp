// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/geometry/shapes.h"

#include "meniscus/core/error.h"
#include "meniscus/core/mesh_data.h"

#include <CGAL/boost/graph/helpers.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <functional>
#include <limits>

namespace meniscus {
namespace {

constexpr double pi = 3.14159265358979323846;
const Eigen::Vector3d origin = Eigen::Vector3d::Zero();

struct Measures {
  double volume = 0, area = 0, shortest = 1e300, mean = 0, longest = 0, least_angle = pi;
};

Measures measures(const Mesh& mesh) {
  Measures m;
  for (const auto f : mesh.faces()) {
    std::array<Eigen::Vector3d, 3> p;
    int c = 0;
    for (const auto v : mesh.vertices_around_face(mesh.halfedge(f))) p[c++] = to_eigen(mesh.point(v));
    m.volume += p[0].dot(p[1].cross(p[2])) / 6;
    m.area += 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).norm();
    for (c = 0; c < 3; ++c) {
      const Eigen::Vector3d u = p[(c + 1) % 3] - p[c], w = p[(c + 2) % 3] - p[c];
      m.least_angle = std::min(m.least_angle, std::atan2(u.cross(w).norm(), u.dot(w)));
    }
  }
  for (const auto e : mesh.edges()) {
    const double length = (to_eigen(mesh.point(mesh.vertex(e, 0))) - to_eigen(mesh.point(mesh.vertex(e, 1)))).norm();
    m.shortest = std::min(m.shortest, length);
    m.longest = std::max(m.longest, length);
    m.mean += length / mesh.number_of_edges();
  }
  return m;
}

int euler_characteristic(const Mesh& mesh) {
  return int(mesh.number_of_vertices()) - int(mesh.number_of_edges()) + int(mesh.number_of_faces());
}

/// Closed, of the given Euler characteristic, edges within [0.5, 1.6] of the target, no thin triangle.
void expect_good(const Mesh& mesh, double edge_length, int characteristic = 2, double least_angle_deg = 25) {
  EXPECT_TRUE(CGAL::is_closed(mesh));
  EXPECT_TRUE(mesh.is_valid(false));
  EXPECT_EQ(euler_characteristic(mesh), characteristic);
  const Measures m = measures(mesh);
  EXPECT_GT(m.volume, 0);
  EXPECT_GE(m.shortest, 0.5 * edge_length);
  EXPECT_LE(m.longest, 1.6 * edge_length);
  EXPECT_GE(m.least_angle * 180 / pi, least_angle_deg);
}

/// The observed order of |measure(h) - exact| between h and h / 4.
double order(const std::function<double(double)>& measure, double exact, double h) {
  return std::log2(std::abs(measure(h) - exact) / std::abs(measure(h / 4) - exact)) / 2;
}

using Maker = std::function<Mesh(double)>;
void expect_second_order(const Maker& make, double volume, double area, double h) {
  EXPECT_NEAR(order([&](double e) { return measures(make(e)).volume; }, volume, h), 2, 0.3);
  EXPECT_NEAR(order([&](double e) { return measures(make(e)).area; }, area, h), 2, 0.3);
}

TEST(Shapes, IcosphereCountsAndValence) {
  for (const int n : {1, 2, 3, 7}) {
    const Mesh mesh = make_icosphere({1, 2, 3}, 0.5, n);
    EXPECT_EQ(mesh.number_of_vertices(), 10u * n * n + 2);
    EXPECT_EQ(mesh.number_of_faces(), 20u * n * n);
    EXPECT_TRUE(CGAL::is_closed(mesh));
    int five = 0;
    for (const auto v : mesh.vertices()) {
      EXPECT_NEAR((to_eigen(mesh.point(v)) - Eigen::Vector3d(1, 2, 3)).norm(), 0.5, 1e-15);
      const auto degree = mesh.degree(v);
      EXPECT_TRUE(degree == 5 || degree == 6);
      five += degree == 5;
    }
    EXPECT_EQ(five, 12);
    EXPECT_GT(measures(make_icosphere(origin, 0.5, n)).volume, 0);
  }
}

TEST(Shapes, SphereTakesTheNearestMeanEdge) {
  for (const double edge : {0.9, 0.31, 0.1, 0.043}) {
    const Mesh mesh = make_sphere(origin, 1, edge);
    const int n = static_cast<int>(std::lround(std::sqrt(mesh.number_of_faces() / 20.0)));
    const double error = std::abs(measures(mesh).mean - edge);
    EXPECT_LE(error, std::abs(measures(make_icosphere(origin, 1, n + 1)).mean - edge));
    if (n > 1) {
      EXPECT_LE(error, std::abs(measures(make_icosphere(origin, 1, n - 1)).mean - edge));
    }
    if (edge < 0.5) expect_good(mesh, edge, 2, 45);
  }
  EXPECT_EQ(make_sphere(origin, 1, 100).number_of_faces(), 20u);
}

TEST(Shapes, SphereConverges) {
  expect_second_order([](double h) { return make_sphere(origin, 1.5, h); }, 4 * pi / 3 * 3.375, 4 * pi * 2.25, 0.3);
}

TEST(Shapes, EllipsoidsConverge) {
  // Areas of spheroids: 2 pi a^2 (1 + c/(a e) asin e) for c > a, 2 pi a^2 (1 + (1 - e^2)/e atanh e) for c < a.
  const double e = std::sqrt(1 - 1 / 9.0), prolate = 2 * pi * (1 + 3 / e * std::asin(e));
  const double oblate = 2 * pi * 9 * (1 + (1 - e * e) / e * std::atanh(e));
  expect_second_order([](double h) { return make_ellipsoid(origin, {1, 1, 3}, h); }, 4 * pi, prolate, 0.25);
  expect_second_order([](double h) { return make_ellipsoid(origin, {3, 1, 3}, h); }, 12 * pi, oblate, 0.25);
}

TEST(Shapes, EllipsoidsAreGood) {
  for (const Eigen::Vector3d& axes : {Eigen::Vector3d(1, 1, 3), {3, 1, 1}, {2, 0.7, 2}, {1, 1.2, 1.4}, {1, 1.5, 4}}) {
    const Mesh mesh = make_ellipsoid({1, 0, 0}, axes, 0.15);
    expect_good(mesh, 0.15, 2, 20);
    for (const auto v : mesh.vertices())
      EXPECT_NEAR((to_eigen(mesh.point(v)) - Eigen::Vector3d(1, 0, 0)).cwiseQuotient(axes).norm(), 1, 1e-12);
  }
}

TEST(Shapes, BoxIsExact) {
  const Mesh mesh = make_box({1, 2, 3}, {1, 0.5, 2}, 0.25);
  expect_good(mesh, 0.25, 2, 44.9);
  EXPECT_EQ(mesh.number_of_faces(), 4u * (4 * 2 + 2 * 8 + 8 * 4));
  const Measures m = measures(mesh);
  EXPECT_NEAR(m.volume, 1, 1e-13);
  EXPECT_NEAR(m.area, 2 * (0.5 + 1 + 2), 1e-13);
  EXPECT_EQ(make_box(origin, {1, 1, 1}, 10).number_of_faces(), 12u);
}

TEST(Shapes, CapConvergesAndSitsOnItsPlane) {
  for (const double degrees : {20.0, 90.0, 150.0}) {
    const double angle = degrees * pi / 180, a = 1, radius = a / std::sin(angle),
                 height = radius * (1 - std::cos(angle));
    const double volume = pi * height * height * (3 * radius - height) / 3;
    const double area = 2 * pi * radius * height + pi * a * a;
    const Maker cap = [&](double h) { return make_cap({1, 2, 3}, {0, 0, 2}, a, angle, h); };
    expect_second_order(cap, volume, area, 0.2);
    const Mesh mesh = cap(0.1);
    expect_good(mesh, 0.1);
    const Eigen::Vector3d ball(1, 2, 3 - radius * std::cos(angle));
    for (const auto v : mesh.vertices()) {
      const Eigen::Vector3d x = to_eigen(mesh.point(v));
      if (x.z() == 3)
        EXPECT_LE((x - Eigen::Vector3d(1, 2, 3)).norm(), a + 1e-12);
      else
        EXPECT_NEAR((x - ball).norm(), radius, 1e-11);
      EXPECT_GE(x.z(), 3);
    }
  }
}

TEST(Shapes, CapTurnsWithItsAxis) {
  for (const Eigen::Vector3d& axis : {Eigen::Vector3d(0, 0, -1), {1, 1, 0}, {-1, 2, -3}}) {
    const Mesh mesh = make_cap(origin, axis, 1, 2, 0.2);
    expect_good(mesh, 0.2);
    for (const auto v : mesh.vertices()) EXPECT_GE(to_eigen(mesh.point(v)).dot(axis), -1e-12);
  }
}

TEST(Shapes, TorusConverges) {
  expect_second_order([](double h) { return make_torus(origin, 1, 0.4, h); }, 2 * pi * pi * 0.16, 4 * pi * pi * 0.4,
                      0.2);
  expect_good(make_torus({3, 2, 1}, 1, 0.4, 0.1), 0.1, 0);
  expect_good(make_torus({3, 2, 1}, 1, 0.7, 0.1), 0.1, 0);
}

TEST(Shapes, DumbbellConverges) {
  // Half of it, from the neck up: cylinder, fillet (r = across - sqrt(f^2 - t^2)), ball cut off below.
  const double length = 4, ball = 0.6, neck = 0.15, c = length / 2 - ball, f = 0.6, across = neck + f;
  const double drop = std::sqrt((ball + f) * (ball + f) - across * across), z = c - drop;
  const double t = drop * f / (ball + f), cut = drop * ball / (ball + f);  // heights where fillet and ball end
  const double root = t * std::sqrt(f * f - t * t) + f * f * std::asin(t / f);
  const double fillet_volume = pi * ((across * across + f * f) * t - t * t * t / 3 - across * root);
  const double ball_volume = pi * (2.0 / 3 * ball * ball * ball + ball * ball * cut - cut * cut * cut / 3);
  const double volume = 2 * (pi * neck * neck * z + fillet_volume + ball_volume);
  const double tilt = std::asin(t / f);
  const double area =
      2 * (2 * pi * neck * z + 2 * pi * f * (across * tilt - f * std::sin(tilt)) + 2 * pi * ball * (ball + cut));
  expect_second_order([&](double h) { return make_dumbbell(length, ball, neck, h); }, volume, area, 0.12);
  expect_good(make_dumbbell(length, ball, neck, 0.05), 0.05);
  expect_good(make_dumbbell(2.6, 0.6, 0.3, 0.05), 0.05);  // a neck without cylinder
}

TEST(Shapes, RevolutionKeepsCorners) {
  const auto line = [](Eigen::Vector2d a, Eigen::Vector2d b) {
    return [=](double s) -> Eigen::Vector2d { return a + s * (b - a); };
  };
  const Mesh cylinder =
      make_surface_of_revolution({line({0, 0}, {1, 0}), line({1, 0}, {1, 2}), line({1, 2}, {0, 2})}, 0.1);
  expect_good(cylinder, 0.1);
  const int m = 63;  // round(2 pi / 0.1) sides: the volume is that of the prism, all but the offsets between rings
  EXPECT_NEAR(measures(cylinder).volume, m * std::sin(2 * pi / m) * 0.5 * 2, 0.01);
}

TEST(Shapes, CoarsestStillClose) {
  EXPECT_TRUE(CGAL::is_closed(make_cap(origin, {0, 0, 1}, 1, 1, 100)));
  EXPECT_TRUE(CGAL::is_closed(make_torus(origin, 1, 0.5, 100)));
  EXPECT_TRUE(CGAL::is_closed(make_dumbbell(4, 1, 0.2, 100)));
  EXPECT_TRUE(CGAL::is_closed(make_ellipsoid(origin, {1, 1, 3}, 100)));
}

TEST(Shapes, SameBitsTwice) {
  const MeshData a = to_mesh_data(make_cap(origin, {1, 2, 3}, 1, 2, 0.1));
  const MeshData b = to_mesh_data(make_cap(origin, {1, 2, 3}, 1, 2, 0.1));
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.triangles, b.triangles);
}

TEST(Shapes, RefuseNonsense) {
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  for (const double bad : {0.0, -1.0, nan, inf}) {
    EXPECT_THROW(make_icosphere(origin, bad, 3), UsageError);
    EXPECT_THROW(make_sphere(origin, 1, bad), UsageError);
    EXPECT_THROW(make_ellipsoid(origin, {1, bad, 1}, 0.1), UsageError);
    EXPECT_THROW(make_box(origin, {1, 1, bad}, 0.1), UsageError);
    EXPECT_THROW(make_cap(origin, {0, 0, 1}, bad, 1, 0.1), UsageError);
    EXPECT_THROW(make_cap(origin, {0, 0, 1}, 1, bad, 0.1), UsageError);
    EXPECT_THROW(make_torus(origin, 1, bad, 0.1), UsageError);
    EXPECT_THROW(make_dumbbell(4, 1, bad, 0.1), UsageError);
    EXPECT_THROW(make_surface_of_revolution({[](double s) { return Eigen::Vector2d(s, s); }}, bad), UsageError);
  }
  EXPECT_THROW(make_icosphere(origin, 1, 0), UsageError);
  EXPECT_THROW(make_icosphere({nan, 0, 0}, 1, 2), UsageError);
  EXPECT_THROW(make_cap(origin, {0, 0, 0}, 1, 1, 0.1), UsageError);
  EXPECT_THROW(make_cap(origin, {0, 0, 1}, 1, 3.2, 0.1), UsageError);
  EXPECT_THROW(make_torus(origin, 1, 1, 0.1), UsageError);
  EXPECT_THROW(make_dumbbell(2, 1, 0.2, 0.1), UsageError);
  EXPECT_THROW(make_surface_of_revolution({}, 0.1), UsageError);
  EXPECT_THROW(make_surface_of_revolution({[](double s) { return Eigen::Vector2d(s, s); }}, 0.1), UsageError);
}

TEST(Shapes, RefuseTooManyFacesBeforeAllocating) {
  for (const double edge : {1e-5, 1e-12, 1e-300}) {
    EXPECT_THROW(make_sphere(origin, 1, edge), UsageError);
    EXPECT_THROW(make_ellipsoid(origin, {1, 2, 3}, edge), UsageError);
    EXPECT_THROW(make_box(origin, {1, 1, 1}, edge), UsageError);
    EXPECT_THROW(make_cap(origin, {0, 0, 1}, 1, 1, edge), UsageError);
    EXPECT_THROW(make_torus(origin, 1, 0.5, edge), UsageError);
    EXPECT_THROW(make_dumbbell(4, 1, 0.2, edge), UsageError);
  }
}

}  // namespace
}  // namespace meniscus
