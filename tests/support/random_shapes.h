// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/geometry/shapes.h"
#include "meniscus/geometry/surface_geometry.h"
#include "meniscus/state/drop.h"
#include "meniscus/topology/remesh.h"

#include <cmath>
#include <random>

/// Random shapes and bands for remeshing; a seed names a case for ever.
namespace meniscus::random_shapes {

/// The same numbers on every platform, unlike std::uniform_real_distribution.
class Numbers {
 public:
  explicit Numbers(unsigned seed) : generator_(seed) {}
  double between(double low, double high) { return low + (high - low) * (generator_() / 4294967296.0); }
  double log_between(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }
  int below(int n) { return static_cast<int>(generator_() % static_cast<unsigned>(n)); }
  Eigen::Vector3d vector(double most) {
    const double x = between(-most, most), y = between(-most, most), z = between(-most, most);
    return {x, y, z};
  }

 private:
  std::mt19937 generator_;
};

inline double mean_edge(const Mesh& mesh) {
  double sum = 0;
  for (const auto e : mesh.edges()) {
    const auto h = mesh.halfedge(e);
    sum += (to_eigen(mesh.point(mesh.target(h))) - to_eigen(mesh.point(mesh.source(h)))).norm();
  }
  return sum / mesh.number_of_edges();
}

/// Moves each vertex by up to `amount` mean edges along its normal and in each tangential direction.
inline void perturb(Mesh& mesh, double amount, Numbers& numbers) {
  const double h = mean_edge(mesh);
  Connectivity connectivity;
  connectivity.rebuild(mesh);
  SurfaceGeometry geometry;
  geometry.compute(positions(std::as_const(mesh)), connectivity);
  for (const auto v : mesh.vertices()) {
    const Eigen::Vector3d n = geometry.normal(v);
    Eigen::Vector3d along = numbers.vector(1);
    along -= along.dot(n) * n;
    mesh.point(v) = to_point(to_eigen(mesh.point(v)) + h * amount * (numbers.between(-1, 1) * n + along));
  }
}

/// A sphere with vertices moved along the surface only: irregular, but as round as before.
inline Mesh irregular_sphere(double radius, int frequency, double amount, unsigned seed) {
  Mesh mesh = make_icosphere(Eigen::Vector3d::Zero(), radius, frequency);
  Numbers numbers(seed);
  const double h = mean_edge(mesh);
  for (const auto v : mesh.vertices())
    mesh.point(v) = to_point((to_eigen(mesh.point(v)) + numbers.vector(amount * h)).normalized() * radius);
  return mesh;
}

inline Mesh bumpy_sphere(const Eigen::Vector3d& center, double edge) {
  Mesh mesh = make_sphere(center, 1, edge);
  for (const auto v : mesh.vertices()) {
    const Eigen::Vector3d x = to_eigen(mesh.point(v)) - center;
    mesh.point(v) =
        to_point(center + x * (1 + 0.15 * std::sin(5 * x.x()) * std::sin(4 * x.y() + 1) * std::cos(6 * x.z())));
  }
  return mesh;
}

/// A sphere, ellipsoid, torus, dumbbell or bumpy sphere of random size, with up to 0.3 edges of noise.
inline Mesh shape(Numbers& numbers) {
  const double edge = numbers.between(0.06, 0.25);
  const int kind = numbers.below(5);
  const Eigen::Vector3d center = numbers.vector(1);
  const double a = numbers.between(0, 1), b = numbers.between(0, 1), c = numbers.between(0, 1);
  Mesh mesh = kind == 0   ? make_sphere(center, 0.3 + 0.7 * a, edge)
              : kind == 1 ? make_ellipsoid(center, {0.3 + 0.9 * a, 0.3 + 0.7 * b, 0.2 + 0.8 * c}, edge)
              : kind == 2 ? make_torus(center, 0.6 + 0.4 * a, 0.1 + 0.3 * b, edge)
              : kind == 3 ? make_dumbbell(3.2 + 0.8 * a, 0.4 + 0.3 * b, 0.05 + 0.2 * c, edge)
                          : bumpy_sphere(center, edge);
  perturb(mesh, numbers.between(0, 0.3), numbers);
  return mesh;
}

/// A band about the mesh's mean edge, from a quarter of it to ten times it; with smoothing or without.
inline RemeshOptions options_for(const Mesh& mesh, Numbers& numbers) {
  RemeshOptions options;
  options.band.edge_min = mean_edge(mesh) * numbers.log_between(0.25, 2.5);
  options.band.edge_max = options.band.edge_min * numbers.between(2.05, 4);
  options.max_passes = 1 + numbers.below(6);
  options.smoothing = numbers.below(2) == 0 ? 0 : numbers.between(0, 0.6);
  return options;
}

}  // namespace meniscus::random_shapes
