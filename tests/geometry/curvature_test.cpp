// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/geometry/curvature.h"

#include "meniscus/core/mesh_data.h"
#include "meniscus/geometry/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace meniscus {
namespace {

constexpr double pi = 3.14159265358979323846;
const Eigen::Vector3d origin = Eigen::Vector3d::Zero();

/// |K - exact| over the surface: its root mean square by lumped area, and its maximum.
struct CurvatureError {
  double l2 = 0, max = 0;
};

CurvatureError curvature_error(const Mesh& mesh, const std::function<double(const Eigen::Vector3d&)>& exact) {
  Connectivity connectivity;
  connectivity.rebuild(mesh);
  SurfaceGeometry geometry;
  geometry.compute(positions(mesh), connectivity);
  const auto curvature = mean_curvature(geometry, positions(mesh), connectivity);
  CurvatureError error;
  for (const auto v : mesh.vertices()) {
    const double e = std::abs(curvature[v] - exact(to_eigen(mesh.point(v))));
    error.max = std::max(error.max, e);
    error.l2 += e * e * geometry.lumped_area(v) / geometry.area();
  }
  error.l2 = std::sqrt(error.l2);
  return error;
}

/// K of the ellipsoid x^2/a^2 + y^2/b^2 + z^2/c^2 = 1: the divergence of its unit normal.
double ellipsoid_curvature(const Eigen::Vector3d& axes, const Eigen::Vector3d& x) {
  const Eigen::Array3d inverse = axes.array().square().inverse();
  const double g = std::sqrt((x.array().square() * inverse.square()).sum());  // |grad| / 2
  return inverse.sum() / g - (x.array().square() * inverse.cube()).sum() / (g * g * g);
}

/// A torus about z from an m x n grid of squares, each cut in two.
Mesh grid_torus(double major, double minor, std::uint32_t m, std::uint32_t n) {
  MeshData data;
  for (std::uint32_t i = 0; i < m; ++i)
    for (std::uint32_t j = 0; j < n; ++j) {
      const double u = 2 * pi * i / m, v = 2 * pi * j / n, r = major + minor * std::cos(v);
      data.points.push_back({r * std::cos(u), r * std::sin(u), minor * std::sin(v)});
      const auto at = [=](std::uint32_t p, std::uint32_t q) { return (p % m) * n + q % n; };
      data.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      data.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return to_mesh(data);
}

double torus_curvature(double major, double minor, const Eigen::Vector3d& x) {
  const double r = std::hypot(x.x(), x.y());
  return 1 / minor + (r - major) / (minor * r);
}

double order(double coarse, double fine) { return std::log2(coarse / fine); }

TEST(Curvature, Sphere) {
  const auto error = [](int n) {
    return curvature_error(make_icosphere({1, 2, 3}, 0.5, n), [](auto&) { return 4.0; });
  };
  const CurvatureError coarse = error(10), fine = error(20);
  EXPECT_LT(fine.max, 1e-2 * 4);
  std::printf("sphere l2 %g %g order %g max %g %g order %g\n", coarse.l2, fine.l2, order(coarse.l2, fine.l2),
              coarse.max, fine.max, order(coarse.max, fine.max));
}

TEST(Curvature, Ellipsoid) {
  const Eigen::Vector3d axes(1, 1.2, 0.9);
  const auto error = [&](double h) {
    return curvature_error(make_ellipsoid(origin, axes, h),
                           [&](const Eigen::Vector3d& x) { return ellipsoid_curvature(axes, x); });
  };
  const CurvatureError coarse = error(0.12), fine = error(0.06);
  std::printf("ellipsoid l2 %g %g order %g max %g %g order %g\n", coarse.l2, fine.l2, order(coarse.l2, fine.l2),
              coarse.max, fine.max, order(coarse.max, fine.max));
}

TEST(Curvature, Torus) {
  const auto error = [&](std::uint32_t n) {
    return curvature_error(grid_torus(1, 0.4, 5 * n, 2 * n),
                           [](const Eigen::Vector3d& x) { return torus_curvature(1, 0.4, x); });
  };
  const CurvatureError coarse = error(10), fine = error(20);
  std::printf("torus l2 %g %g order %g max %g %g order %g\n", coarse.l2, fine.l2, order(coarse.l2, fine.l2), coarse.max,
              fine.max, order(coarse.max, fine.max));
}

}  // namespace
}  // namespace meniscus
