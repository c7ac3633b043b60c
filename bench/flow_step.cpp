// SPDX-License-Identifier: GPL-3.0-or-later
// One implicit step of curvature flow, (M + s L) X = B with three columns: assembly and each solver,
// from zero, beside Eigen's conjugate gradients with incomplete Cholesky and CHOLMOD used plainly.
// Values change at every repetition, so that every factor is computed anew; "kept" patterns keep the
// symbolic part, "changed" ones do not.
//
//   bench_flow_step [--quick] [--csv FILE] [--only TRIANGLES]
#include "meniscus/core/version.h"
#include "meniscus/geometry/flow_matrix.h"
#include "meniscus/geometry/shapes.h"
#include "support/chart_table.h"

#include <CGAL/boost/graph/Euler_operations.h>
#include <fmt/format.h>
#include <Eigen/CholmodSupport>
#include <Eigen/Geometry>
#include <Eigen/Sparse>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fstream>
#include <random>
#include <string>

namespace {

using namespace meniscus;
using Eigen::Vector3d;
using Sparse = Eigen::SparseMatrix<double>;

/// CPU milliseconds of this thread so far.
double cpu_ms() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

double mean_edge(const Mesh& mesh) {
  double sum = 0;
  for (const auto e : mesh.edges())
    sum += (to_eigen(mesh.point(mesh.vertex(e, 0))) - to_eigen(mesh.point(mesh.vertex(e, 1)))).norm();
  return sum / static_cast<double>(mesh.number_of_edges());
}

/// The cotangent of the angle opposite to h in its face.
double cotangent(const Mesh& mesh, HalfedgeIndex h) {
  const Vector3d o = to_eigen(mesh.point(mesh.target(mesh.next(h))));
  const Vector3d u = to_eigen(mesh.point(mesh.source(h))) - o, w = to_eigen(mesh.point(mesh.target(h))) - o;
  return u.dot(w) / u.cross(w).norm();
}

/// Vertices moved by up to 0.35 edges along the sphere and a little off it, then edges flipped until
/// few weights are negative: valences from 4 to 9, as after remeshing.
void make_irregular(Mesh& mesh) {
  std::mt19937 generator(1);
  const double h = mean_edge(mesh);
  const auto uniform = [&] { return 2 * (static_cast<double>(generator()) / 4294967296.0) - 1; };
  for (const auto v : mesh.vertices()) {
    const Vector3d p = to_eigen(mesh.point(v)), jitter(uniform(), uniform(), uniform());
    mesh.point(v) = to_point(Vector3d((p + 0.35 * h * jitter).normalized() * (1 + 0.02 * h * uniform())));
  }
  for (int pass = 0; pass < 4; ++pass)
    for (const auto e : mesh.edges()) {
      const auto h0 = mesh.halfedge(e), h1 = mesh.opposite(h0);
      const auto a = mesh.target(mesh.next(h0)), b = mesh.target(mesh.next(h1));
      if (cotangent(mesh, h0) + cotangent(mesh, h1) < 0 && mesh.halfedge(a, b) == Mesh::null_halfedge())
        CGAL::Euler::flip_edge(h0, mesh);
    }
}

/// The same step for everyone: positions that change a little, their geometry, matrix and right-hand side.
struct Step {
  Mesh mesh;
  Eigen::Matrix3Xd rest;
  Connectivity connectivity;
  SurfaceGeometry geometry;
  RingMatrix matrix;
  std::vector<Lanes> rhs, solution;
  double s = 0;

  explicit Step(Mesh m) : mesh(std::move(m)), rest(positions(mesh)) {
    connectivity.rebuild(mesh);
    rhs.resize(connectivity.num_rows());
    solution.resize(connectivity.num_rows());
  }
  void move(int repetition) {
    positions(mesh) = rest;
    positions(mesh).row(0) *= 1 + 0.01 * std::sin(repetition);
    geometry.compute(positions(std::as_const(mesh)), connectivity);
  }
  void assemble() {
    assemble_flow_matrix(connectivity, geometry, s, false, matrix);
    curvature_right_hand_side(connectivity, matrix, positions(std::as_const(mesh)), rhs.data());
  }
};

/// What others' solvers start from: triplets to a sparse matrix, and the right-hand side as columns.
Sparse sparse_matrix(const Step& step) {
  const auto n = static_cast<Eigen::Index>(step.connectivity.num_rows());
  std::vector<Eigen::Triplet<double>> triplets;
  triplets.reserve(static_cast<std::size_t>(7 * n));
  for (std::uint32_t v = 0; v < n; ++v) triplets.emplace_back(v, v, step.geometry.lumped_area(v));
  const auto& triangles = step.connectivity.triangles();
  for (std::size_t f = 0; f < triangles.size(); ++f)
    for (std::size_t c = 0; c < 3; ++c) {
      const auto i = triangles[f][(c + 1) % 3], j = triangles[f][(c + 2) % 3];
      const double w = 0.5 * step.s * step.geometry.faces()[f].cotangent[c];
      triplets.emplace_back(i, i, w);
      triplets.emplace_back(j, j, w);
      triplets.emplace_back(i, j, -w);
      triplets.emplace_back(j, i, -w);
    }
  Sparse A(n, n);
  A.setFromTriplets(triplets.begin(), triplets.end());
  return A;
}

Eigen::MatrixX3d dense_rhs(const Step& step) {
  Eigen::MatrixX3d B(static_cast<Eigen::Index>(step.rhs.size()), 3);
  for (std::size_t i = 0; i < step.rhs.size(); ++i) B.row(static_cast<Eigen::Index>(i)) = to_eigen(step.rhs[i]);
  return B;
}

/// Times in ms, iterations and residual of one way to do the step, over the repetitions.
struct Series {
  std::string method, pattern;
  std::vector<double> ms;
  double iterations = 0, residual = 0;
  std::string note;

  double median() {
    std::nth_element(ms.begin(), ms.begin() + static_cast<std::ptrdiff_t>(ms.size() / 2), ms.end());
    return ms[ms.size() / 2];
  }
};

const char* short_name(SolverMethod method) {
  switch (method) {
    case SolverMethod::automatic:
      return "automatic";
    case SolverMethod::conjugate_gradient_jacobi:
      return "jacobi";
    case SolverMethod::conjugate_gradient_incomplete_cholesky:
      return "incomplete_cholesky";
    case SolverMethod::cholesky:
      return "cholesky";
  }
  return "";
}

constexpr double tolerance = 1e-6;

void run_ours(Step& step, SpdSolver& solver, SolverMethod method, bool pattern_changed, bool warm, Series& series) {
  if (!warm) std::fill(step.solution.begin(), step.solution.end(), Lanes{});
  SolverOptions options;
  options.method = method;
  options.tolerance = tolerance;
  const double start = cpu_ms();
  const SolveReport report = solver.solve(step.connectivity, step.matrix, step.rhs.data(), step.solution.data(),
                                          nullptr, pattern_changed, options);
  series.ms.push_back(cpu_ms() - start);
  series.iterations = report.iterations;
  series.residual = report.relative_residual;
  series.note = report.converged ? short_name(report.method) : "FAILED";
}

template <class Solver>
void run_eigen(const Step& step, Series& series) {
  const double start = cpu_ms();
  const Sparse A = sparse_matrix(step);
  const Eigen::MatrixX3d B = dense_rhs(step);
  Solver solver;
  if constexpr (std::is_base_of_v<Eigen::IterativeSolverBase<Solver>, Solver>) solver.setTolerance(tolerance);
  solver.compute(A);
  const Eigen::MatrixX3d X = solver.solve(B);
  series.ms.push_back(cpu_ms() - start);
  if constexpr (std::is_base_of_v<Eigen::IterativeSolverBase<Solver>, Solver>)
    series.iterations = static_cast<double>(solver.iterations());
  series.residual = (B - A * X).norm() / B.norm();
}

std::vector<Series> measure(Step& step, int repetitions) {
  constexpr std::array methods{SolverMethod::conjugate_gradient_jacobi,
                               SolverMethod::conjugate_gradient_incomplete_cholesky, SolverMethod::cholesky,
                               SolverMethod::automatic};
  std::vector<Series> all{{"assembly", "kept", {}, 0, 0, ""}};
  for (const char* pattern : {"kept", "changed", "warm"})
    for (const auto method : methods) all.push_back({short_name(method), pattern, {}, 0, 0, ""});
  all.push_back({"eigen_cg_incomplete_cholesky", "changed", {}, 0, 0, ""});
  all.push_back({"eigen_cholmod_decomposition", "changed", {}, 0, 0, ""});
  all.push_back({"eigen_cholmod_supernodal_llt", "changed", {}, 0, 0, ""});
  std::vector<SpdSolver> solvers(12);
  std::vector<std::vector<Lanes>> last(4, step.solution);
  for (int repetition = 0; repetition <= repetitions; ++repetition) {  // the first one is not counted
    step.move(repetition);
    const double start = cpu_ms();
    step.assemble();
    all[0].ms.push_back(cpu_ms() - start);
    for (std::size_t turn = 0; turn < 12; ++turn) {  // taking turns, so that all meet the same caches
      const std::size_t k = turn / 4 * 4 + (turn + static_cast<std::size_t>(repetition)) % 4;
      const bool warm = k >= 8;
      if (warm) std::swap(step.solution, last[k - 8]);
      run_ours(step, solvers[k], methods[k % 4], (k >= 4 && !warm) || repetition == 0, warm, all[1 + k]);
      if (warm) std::swap(step.solution, last[k - 8]);
    }
    run_eigen<Eigen::ConjugateGradient<Sparse, Eigen::Lower | Eigen::Upper, Eigen::IncompleteCholesky<double>>>(
        step, all[13]);
    run_eigen<Eigen::CholmodDecomposition<Sparse>>(step, all[14]);
    run_eigen<Eigen::CholmodSupernodalLLT<Sparse>>(step, all[15]);
    if (repetition == 0)
      for (Series& series : all) series.ms.clear();
  }
  return all;
}

}  // namespace

int main(int argc, char** argv) {
  bool quick = false;
  int only = 0;
  std::string csv_name;
  for (int i = 1; i < argc; ++i) {
    if (!std::strcmp(argv[i], "--quick"))
      quick = true;
    else if (!std::strcmp(argv[i], "--csv") && i + 1 < argc)
      csv_name = argv[++i];
    else if (!std::strcmp(argv[i], "--only") && i + 1 < argc)
      only = std::atoi(argv[++i]);
    else {
      fmt::print(stderr, "usage: {} [--quick] [--csv FILE] [--only TRIANGLES]\n", argv[0]);
      return 2;
    }
  }
  std::string csv =
      "date,machine,version,mesh,triangles,gamma_dt_over_h2,method,pattern,ms,iterations,relative_residual,used\n";
  const std::string id = fmt::format("{},{},{}", bench::today(), bench::machine(), version());
  for (const int frequency : quick ? std::vector{8, 16} : std::vector{8, 16, 32, 71})
    for (const bool irregular : {false, true}) {
      if (only != 0 && only != 20 * frequency * frequency) continue;
      Mesh mesh = make_icosphere({0, 0, 0}, 1, frequency);
      if (irregular) make_irregular(mesh);
      const double h = mean_edge(mesh);
      Step step(std::move(mesh));
      for (const double ratio : quick ? std::vector{1.0, 100.0} : std::vector{1.0, 3.0, 10.0, 30.0, 100.0}) {
        step.s = ratio * h * h;
        fmt::print("{} sphere, {} triangles, gamma dt = {} h^2\n", irregular ? "irregular" : "smooth",
                   step.connectivity.triangles().size(), ratio);
        for (Series& series : measure(step, quick ? 3 : frequency <= 16 ? 40 : frequency <= 32 ? 16 : 12)) {
          const double ms = series.median();
          fmt::print("  {:<30} {:<8} {:10.3f} ms {:5.0f} iterations  {:8.1e}  {}\n", series.method, series.pattern, ms,
                     series.iterations, series.residual, series.note);
          csv += fmt::format("{},{},{},{},{},{},{:.4f},{},{:.2e},{}\n", id, irregular ? "irregular" : "smooth",
                             step.connectivity.triangles().size(), ratio, series.method, series.pattern, ms,
                             series.iterations, series.residual, series.note);
        }
        std::fflush(stdout);
      }
    }
  if (!csv_name.empty()) {
    std::ofstream file(csv_name);
    file << csv;
    if (!file.flush()) {
      fmt::print(stderr, "{}: cannot be written\n", csv_name);
      return 3;
    }
  }
  return 0;
}
