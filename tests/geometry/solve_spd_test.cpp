// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/geometry/solve_spd.h"

#include "support/flow_step_problem.h"

#include <CGAL/boost/graph/Euler_operations.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <random>

namespace meniscus {
namespace {

using namespace flow_step;

constexpr SolverMethod jacobi = SolverMethod::conjugate_gradient_jacobi;
constexpr SolverMethod incomplete = SolverMethod::conjugate_gradient_incomplete_cholesky;
constexpr SolverMethod cholesky = SolverMethod::cholesky;
constexpr SolverMethod all_methods[] = {SolverMethod::automatic, jacobi, incomplete, cholesky};

bool same_bits(const std::vector<Lanes>& a, const std::vector<Lanes>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Lanes)) == 0;
}

TEST(SpdSolver, AgreesWithDenseFactorisation) {
  EXPECT_TRUE(rc::check([] {
    const double ratio = std::pow(10.0, *rc::gen::inRange(-2, 4));
    const bool clamp = *rc::gen::arbitrary<bool>();
    const int frequency = *rc::gen::inRange(1, 5);
    const Mesh mesh = perturbed_sphere(frequency, 0.1 * *rc::gen::inRange(0, 5), *rc::gen::arbitrary<unsigned>());
    Problem problem(mesh, ratio, clamp);
    for (const SolverMethod method : all_methods) {
      std::fill(problem.solution.begin(), problem.solution.end(), Lanes{});
      const SolveReport report = problem.solve(method);
      RC_ASSERT(report.converged);
      RC_ASSERT(report.relative_residual <= 1e-12);
      RC_ASSERT(problem.error() < 1e-8);
    }
  }));
}

TEST(SpdSolver, SolvesWithLongRings) {
  for (const int valence : {9, 40, 300}) {
    Problem problem(double_cone(valence), 5);
    ASSERT_EQ(problem.connectivity.long_rings().size(), 2u);
    for (const SolverMethod method : all_methods) {
      std::fill(problem.solution.begin(), problem.solution.end(), Lanes{});
      EXPECT_TRUE(problem.solve(method).converged);
      EXPECT_LT(problem.error(), 1e-9);
    }
  }
}

TEST(SpdSolver, HoldsFixedRowsAtZeroAndSolvesTheRest) {
  EXPECT_TRUE(rc::check([] {
    const unsigned seed = *rc::gen::arbitrary<unsigned>();
    const int share = *rc::gen::inRange(1, 10);  // tenths of the rows
    Problem problem(perturbed_sphere(3, 0.2, seed), 20);
    std::mt19937 generator(seed);
    for (auto& f : problem.fixed) f = static_cast<int>(generator() % 10) < share;
    for (const SolverMethod method : all_methods) {
      std::fill(problem.solution.begin(), problem.solution.end(), Lanes{1, 2, 3, 0});  // fixed rows too
      RC_ASSERT(problem.solve(method).converged);
      for (std::size_t i = 0; i < problem.fixed.size(); ++i)
        if (problem.fixed[i]) RC_ASSERT(to_eigen(problem.solution[i]) == Eigen::Vector3d::Zero().eval());
      if (std::count(problem.fixed.begin(), problem.fixed.end(), 0) > 0) RC_ASSERT(problem.error() < 1e-8);
    }
  }));
}

TEST(SpdSolver, FixedRowsMayChangeWhileThePatternStands) {
  Problem problem(perturbed_sphere(4, 0.2, 1), 20);
  for (const SolverMethod method : all_methods) {
    SpdSolver solver;
    for (const std::size_t row : {5u, 90u, 17u}) {
      std::fill(problem.fixed.begin(), problem.fixed.end(), 0);
      problem.fixed[row] = 1;
      EXPECT_TRUE(problem.solve(solver, method, 1e-12, 5000, row == 5).converged);
      EXPECT_LT(problem.error(), 1e-9);
    }
  }
}

TEST(SpdSolver, AllRowsFixedGivesZero) {
  Problem problem(perturbed_sphere(2, 0.2, 1), 20);
  std::fill(problem.fixed.begin(), problem.fixed.end(), 1);
  for (const SolverMethod method : all_methods) {
    std::fill(problem.solution.begin(), problem.solution.end(), Lanes{1, 2, 3, 0});
    EXPECT_TRUE(problem.solve(method).converged);
    EXPECT_EQ(Problem::columns_of(problem.solution).norm(), 0);
  }
}

TEST(SpdSolver, ZeroRightHandSideGivesZeroFromAnyStart) {
  Problem problem(perturbed_sphere(3, 0.3, 1), 20);
  std::fill(problem.rhs.begin(), problem.rhs.end(), Lanes{});
  for (const SolverMethod method : all_methods) {
    std::fill(problem.solution.begin(), problem.solution.end(), Lanes{1, 2, 3, 0});
    const SolveReport report = problem.solve(method);
    EXPECT_TRUE(report.converged);
    EXPECT_EQ(report.iterations, 0);
    EXPECT_EQ(report.relative_residual, 0);
    EXPECT_EQ(Problem::columns_of(problem.solution).norm(), 0);
  }
}

TEST(SpdSolver, ColumnsThatAreZeroStayZero) {
  Problem problem(perturbed_sphere(3, 0.3, 1), 20);
  for (Lanes& b : problem.rhs) b = Lanes{0, b[1], 0, 0};
  for (const SolverMethod method : all_methods) {
    std::fill(problem.solution.begin(), problem.solution.end(), Lanes{});
    EXPECT_TRUE(problem.solve(method).converged);
    EXPECT_LT(problem.error(), 1e-9);
    for (const Lanes& x : problem.solution) {
      EXPECT_EQ(x[0], 0);
      EXPECT_EQ(x[2], 0);
    }
  }
}

TEST(SpdSolver, StartAtTheSolutionTakesNoIterations) {
  Problem problem(perturbed_sphere(4, 0.2, 1), 20);
  ASSERT_TRUE(problem.solve(cholesky).converged);
  for (const SolverMethod method : all_methods) {
    const std::vector<Lanes> start = problem.solution;
    const SolveReport report = problem.solve(method, 1e-8);
    EXPECT_TRUE(report.converged);
    EXPECT_EQ(report.iterations, 0);
    EXPECT_TRUE(same_bits(start, problem.solution));
  }
}

TEST(SpdSolver, AStartNearTheSolutionSavesIterations) {
  Problem problem(perturbed_sphere(6, 0.2, 1), 30);
  for (const SolverMethod method : {jacobi, incomplete}) {
    std::fill(problem.solution.begin(), problem.solution.end(), Lanes{});
    const int cold = problem.solve(method, 1e-8).iterations;
    for (Lanes& x : problem.solution) x *= 0.999;
    const int warm = problem.solve(method, 1e-8).iterations;
    EXPECT_GT(warm, 0);
    EXPECT_LT(warm, cold);
  }
}

TEST(SpdSolver, ReportsTheTrueResidual) {
  Problem problem(perturbed_sphere(5, 0.3, 1), 100);
  const Eigen::MatrixXd A = problem.dense();
  const Eigen::VectorXd weight = A.diagonal().cwiseInverse().cwiseSqrt();
  const Eigen::MatrixX3d B = Problem::columns_of(problem.rhs);
  for (const SolverMethod method : {jacobi, incomplete, cholesky}) {
    std::fill(problem.solution.begin(), problem.solution.end(), Lanes{});
    const SolveReport report = problem.solve(method, 1e-6);
    const Eigen::MatrixX3d R = B - A * Problem::columns_of(problem.solution);
    const double expected = (weight.asDiagonal() * R).norm() / (weight.asDiagonal() * B).norm();
    EXPECT_NEAR(report.relative_residual, expected, 1e-3 * expected + 1e-13);
    EXPECT_EQ(report.method, method);
  }
}

TEST(SpdSolver, RemovedRowsTakeNoPart) {
  Mesh mesh = perturbed_sphere(4, 0.1, 2);
  Problem problem(mesh, 10);
  const auto e = mesh.edge(mesh.halfedge(VertexIndex(100)));
  const auto h = mesh.halfedge(e);
  std::vector<VertexIndex> touched;
  for (const auto end : {mesh.source(h), mesh.target(h)})
    for (const auto around : CGAL::halfedges_around_target(mesh.halfedge(end), mesh)) {
      touched.push_back(mesh.source(around));
      touched.push_back(end);
    }
  ASSERT_TRUE(CGAL::Euler::does_satisfy_link_condition(e, mesh));
  const FaceIndex faces[] = {mesh.face(h), mesh.face(mesh.opposite(h))};
  CGAL::Euler::collapse_edge(e, mesh);
  for (const auto f : faces) problem.connectivity.remove_face(f);
  for (const auto v : touched) problem.connectivity.update_vertex(mesh, v);
  problem.assemble(mesh, 10, false);

  std::uint32_t removed_row = 0;
  while (!mesh.is_removed(VertexIndex(removed_row))) ++removed_row;
  EXPECT_EQ(problem.matrix.diagonal[removed_row], 1);
  for (const SolverMethod method : all_methods) {
    std::fill(problem.solution.begin(), problem.solution.end(), Lanes{});
    EXPECT_TRUE(problem.solve(method).converged);
    EXPECT_LT(problem.error(), 1e-9);
    EXPECT_EQ(to_eigen(problem.solution[removed_row]), Eigen::Vector3d::Zero().eval());
  }
}

TEST(SpdSolver, FollowsAPatternThatChanges) {
  for (const SolverMethod method : all_methods) {
    SpdSolver solver;
    for (const int frequency : {3, 5, 2}) {
      Problem problem(perturbed_sphere(frequency, 0.2, 4), 10);
      EXPECT_TRUE(problem.solve(solver, method, 1e-12, 5000, false).converged);  // the size tells
      EXPECT_LT(problem.error(), 1e-9);
    }
    Problem before(double_cone(20), 10);
    before.solve(solver, method);
    Mesh flipped = double_cone(20);
    CGAL::Euler::flip_edge(flipped.halfedge(VertexIndex(0), VertexIndex(1)), flipped);
    Problem after(flipped, 10);
    EXPECT_TRUE(after.solve(solver, method, 1e-12, 5000, true).converged);
    EXPECT_LT(after.error(), 1e-9);
  }
}

TEST(SpdSolver, GivesTheSameBitsAgain) {
  Problem problem(perturbed_sphere(6, 0.3, 9), 30);
  for (const SolverMethod method : all_methods) {
    SpdSolver used;
    problem.solve(used, method, 1e-6);
    std::vector<Lanes> first;
    for (const bool pattern_changed : {true, true, false}) {
      std::fill(problem.solution.begin(), problem.solution.end(), Lanes{});
      if (method == SolverMethod::automatic && !pattern_changed) continue;  // it may choose anew
      problem.solve(used, method, 1e-6, 5000, pattern_changed);
      if (first.empty()) first = problem.solution;
      EXPECT_TRUE(same_bits(first, problem.solution));
    }
    std::fill(problem.solution.begin(), problem.solution.end(), Lanes{});
    problem.solve(method, 1e-6);  // a solver without a past
    EXPECT_TRUE(same_bits(first, problem.solution));
  }
}

TEST(SpdSolver, DoesNotDependOnTheNumberingBeyondRounding) {
  const Mesh mesh = perturbed_sphere(5, 0.3, 9);
  MeshData data = to_mesh_data(mesh);
  const std::size_t n = data.points.size();
  std::vector<std::uint32_t> number(n);
  std::iota(number.begin(), number.end(), 0u);
  std::shuffle(number.begin(), number.end(), std::mt19937(3));
  MeshData shuffled = data;
  for (std::size_t i = 0; i < n; ++i) shuffled.points[number[i]] = data.points[i];
  for (auto& triangle : shuffled.triangles)
    for (auto& v : triangle) v = number[v];
  Problem a(mesh, 30), b(to_mesh(shuffled), 30);
  for (std::size_t i = 0; i < n; ++i) b.rhs[number[i]] = a.rhs[i];
  for (const SolverMethod method : all_methods) {
    a.solve(method);
    b.solve(method);
    const double scale = Problem::columns_of(a.solution).norm() / std::sqrt(double(n));
    for (std::size_t i = 0; i < n; ++i)
      EXPECT_LT((to_eigen(a.solution[i]) - to_eigen(b.solution[number[i]])).norm(), 1e-9 * scale);
  }
}

TEST(SpdSolver, SaysSoWhenIterationsDoNotSuffice) {
  Problem problem(perturbed_sphere(5, 0.3, 9), 100);
  for (const SolverMethod method : {jacobi, incomplete}) {
    std::fill(problem.solution.begin(), problem.solution.end(), Lanes{});
    const SolveReport report = problem.solve(method, 1e-10, 1);
    EXPECT_FALSE(report.converged);
    EXPECT_EQ(report.iterations, 1);
    EXPECT_GT(report.relative_residual, 1e-10);
    EXPECT_TRUE(std::isfinite(report.relative_residual));
  }
  std::fill(problem.solution.begin(), problem.solution.end(), Lanes{});
  const SolveReport report = problem.solve(SolverMethod::automatic, 1e-10, 1);
  EXPECT_TRUE(report.converged);  // by the factor that it falls back to
  EXPECT_EQ(report.method, cholesky);
}

TEST(SpdSolver, SaysSoWhenTheMatrixIsNotPositiveDefinite) {
  const Mesh mesh = perturbed_sphere(4, 0.1, 9);
  for (const SolverMethod method : all_methods) {
    Problem negative(mesh, 10);
    negative.matrix.diagonal[3] = -1;
    EXPECT_FALSE(negative.solve(method).converged);
    Problem indefinite(mesh, 10);  // diagonal positive, but x.Ax < 0 for constant x
    for (double& d : indefinite.matrix.diagonal) d *= 0.5;
    EXPECT_FALSE(indefinite.solve(method, 1e-12, 100000).converged);
  }
}

TEST(SpdSolver, SaysSoWhenSomethingIsNotFinite) {
  const Mesh mesh = perturbed_sphere(4, 0.1, 9);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    for (const SolverMethod method : all_methods) {
      Problem diagonal(mesh, 10), weight(mesh, 10), rhs(mesh, 10), start(mesh, 10);
      diagonal.matrix.diagonal[3] = bad;
      weight.matrix.weight[8 * 20] = bad;
      rhs.rhs[7][1] = bad;
      start.solution[9][2] = bad;
      for (Problem* problem : {&diagonal, &weight, &rhs, &start}) {
        const SolveReport report = problem->solve(method, 1e-6, 200);
        EXPECT_FALSE(report.converged);
        EXPECT_FALSE(std::isnan(report.relative_residual));
      }
      Problem sound(mesh, 10);  // and the solver is none the worse for it
      SpdSolver solver;
      weight.solve(solver, method, 1e-6, 200);
      EXPECT_TRUE(sound.solve(solver, method, 1e-12, 5000, false).converged);
      EXPECT_LT(sound.error(), 1e-9);
    }
}

TEST(SpdSolver, TakesAnEmptySystem) {
  Connectivity connectivity;
  RingMatrix matrix;
  for (const SolverMethod method : all_methods) {
    SolverOptions options;
    options.method = method;
    EXPECT_TRUE(SpdSolver().solve(connectivity, matrix, nullptr, nullptr, nullptr, true, options).converged);
  }
}

TEST(SpdSolver, AutomaticIsOneOfTheMethodsAndConverges) {
  // Rough and smooth, small and larger steps: whatever it takes, the answer is right.
  for (const double amount : {0.0, 0.4})
    for (const double ratio : {0.1, 10.0, 1000.0, 1e6}) {
      Problem problem(perturbed_sphere(6, amount, 1), ratio);
      const SolveReport report = problem.solve(SolverMethod::automatic, 1e-10);
      EXPECT_TRUE(report.converged);
      EXPECT_NE(report.method, SolverMethod::automatic);
      EXPECT_LT(problem.error(), 1e-4);
    }
}

}  // namespace
}  // namespace meniscus
