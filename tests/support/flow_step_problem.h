// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/mesh_data.h"
#include "meniscus/geometry/flow_matrix.h"
#include "meniscus/geometry/shapes.h"
#include "meniscus/geometry/solve_spd.h"

#include <Eigen/Dense>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

/// Systems of one step of curvature flow on hard meshes, with dense references.
namespace meniscus::flow_step {

inline double uniform(std::mt19937& generator) { return static_cast<double>(generator()) / 2147483648.0 - 1; }

/// A sphere whose vertices are moved by up to `amount` edge lengths in each direction.
inline Mesh perturbed_sphere(int frequency, double amount, unsigned seed) {
  Mesh mesh = make_icosphere(Eigen::Vector3d(1, 2, 3), 0.2, frequency);
  std::mt19937 generator(seed);
  auto x = positions(mesh);
  const double edge = 0.24 / frequency;
  for (Eigen::Index i = 0; i < x.size(); ++i) x(i) += amount * edge * uniform(generator);
  return mesh;
}

/// Two cones base to base: their tips have `valence` neighbours each.
inline Mesh double_cone(int valence) {
  MeshData data;
  for (int k = 0; k < valence; ++k) {
    const double angle = 2 * 3.14159265358979 * k / valence;
    data.points.push_back({std::cos(angle), std::sin(angle), 0.1 * std::sin(3 * angle)});
  }
  data.points.push_back({0, 0, 1});
  data.points.push_back({0, 0, -0.7});
  const auto n = static_cast<std::uint32_t>(valence);
  for (std::uint32_t k = 0; k < n; ++k) {
    data.triangles.push_back({k, (k + 1) % n, n});
    data.triangles.push_back({(k + 1) % n, k, n + 1});
  }
  return to_mesh(data);
}

/// One implicit step on a mesh, with random right-hand sides and a start of zero.
struct Problem {
  Connectivity connectivity;
  SurfaceGeometry geometry;
  RingMatrix matrix;
  std::vector<Lanes> rhs, solution;
  std::vector<std::uint8_t> fixed;

  Problem(const Mesh& mesh, double ratio, bool clamp = false) {
    connectivity.rebuild(mesh);
    assemble(mesh, ratio, clamp);
  }

  /// s = ratio h^2, h^2 about the area a face.
  void assemble(const Mesh& mesh, double ratio, bool clamp) {
    geometry.compute(positions(mesh), connectivity);
    assemble_flow_matrix(connectivity, geometry, ratio * 2 * geometry.area() / double(mesh.number_of_faces()), clamp,
                         matrix);
    std::mt19937 generator(7);
    rhs.assign(connectivity.num_rows(), Lanes{});
    for (std::size_t i = 0; i < rhs.size(); ++i)
      if (connectivity.degree(static_cast<std::uint32_t>(i)) > 0)
        rhs[i] = Lanes{uniform(generator), uniform(generator), uniform(generator), 0};
    solution.assign(rhs.size(), Lanes{});
    fixed.assign(rhs.size(), 0);
  }

  SolveReport solve(SpdSolver& solver, SolverMethod method, double tolerance = 1e-12, int max_iterations = 5000,
                    bool pattern_changed = true) {
    SolverOptions options;
    options.method = method;
    options.tolerance = tolerance;
    options.max_iterations = max_iterations;
    return solver.solve(connectivity, matrix, rhs.data(), solution.data(), fixed.data(), pattern_changed, options);
  }
  SolveReport solve(SolverMethod method, double tolerance = 1e-12, int max_iterations = 5000) {
    SpdSolver solver;
    return solve(solver, method, tolerance, max_iterations);
  }

  /// The matrix as the header describes it, read from the rings one by one.
  Eigen::MatrixXd dense() const {
    const auto n = static_cast<Eigen::Index>(rhs.size());
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
    for (std::uint32_t v = 0; v < n; ++v) {
      A(v, v) += matrix.diagonal[v];
      const Ring ring = connectivity.ring(v);
      const double* const weight = ring.degree > Connectivity::width
                                       ? matrix.long_weight[connectivity.long_ring(v)].data()
                                       : &matrix.weight[8 * std::size_t{v}];
      for (int k = 0; k < ring.degree; ++k) A(v, ring.neighbour[k]) -= weight[k];
    }
    return A;
  }

  static Eigen::MatrixX3d columns_of(const std::vector<Lanes>& lanes) {
    Eigen::MatrixX3d X(static_cast<Eigen::Index>(lanes.size()), 3);
    for (std::size_t i = 0; i < lanes.size(); ++i) X.row(static_cast<Eigen::Index>(i)) = to_eigen(lanes[i]);
    return X;
  }

  /// The solution by dense LDL^T of the system without the fixed rows and columns.
  Eigen::MatrixX3d reference() const {
    std::vector<Eigen::Index> moving;
    for (std::size_t i = 0; i < fixed.size(); ++i)
      if (!fixed[i]) moving.push_back(static_cast<Eigen::Index>(i));
    const Eigen::MatrixXd A = dense();
    Eigen::MatrixX3d X = Eigen::MatrixX3d::Zero(A.rows(), 3);
    const Eigen::MatrixX3d B = columns_of(rhs);
    const Eigen::MatrixXd reduced = A(moving, moving), b = B(moving, Eigen::all);
    const Eigen::MatrixXd x = reduced.ldlt().solve(b);
    X(moving, Eigen::all) = x;
    return X;
  }

  /// |x - reference| / |reference|.
  double error() const {
    const Eigen::MatrixX3d X = reference();
    return (columns_of(solution) - X).norm() / X.norm();
  }
};

}  // namespace meniscus::flow_step
