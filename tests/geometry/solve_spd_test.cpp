// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/geometry/solve_spd.h"

#include "meniscus/core/mesh_data.h"
#include "meniscus/geometry/flow_matrix.h"
#include "meniscus/geometry/shapes.h"

#include <CGAL/boost/graph/Euler_operations.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <random>

namespace meniscus {
namespace {

constexpr SolverMethod jacobi = SolverMethod::conjugate_gradient_jacobi;
constexpr SolverMethod incomplete = SolverMethod::conjugate_gradient_incomplete_cholesky;
constexpr SolverMethod cholesky = SolverMethod::cholesky;
constexpr SolverMethod all_methods[] = {SolverMethod::automatic, jacobi, incomplete, cholesky};

double uniform(std::mt19937& generator) { return static_cast<double>(generator()) / 2147483648.0 - 1; }

/// A sphere whose vertices are moved by up to `amount` edge lengths in each direction.
Mesh perturbed_sphere(int frequency, double amount, unsigned seed) {
  Mesh mesh = make_icosphere(Eigen::Vector3d(1, 2, 3), 0.2, frequency);
  std::mt19937 generator(seed);
  auto x = positions(mesh);
  const double edge = 0.24 / frequency;
  for (Eigen::Index i = 0; i < x.size(); ++i) x(i) += amount * edge * uniform(generator);
  return mesh;
}

/// Two cones base to base: their tips have `valence` neighbours each.
Mesh double_cone(int valence) {
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

bool same_bits(const std::vector<Lanes>& a, const std::vector<Lanes>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Lanes)) == 0;
}

TEST(FlowMatrix, IsSymmetricPositiveDefiniteOnRandomSurfaces) {
  EXPECT_TRUE(rc::check([] {
    const auto seed = *rc::gen::arbitrary<unsigned>();
    const bool clamp = *rc::gen::arbitrary<bool>();
    const double ratio = std::pow(10.0, *rc::gen::inRange(-2, 4));
    const Mesh mesh = perturbed_sphere(*rc::gen::inRange(1, 5), 0.1 * *rc::gen::inRange(0, 6), seed);
    const Eigen::MatrixXd A = Problem(mesh, ratio, clamp).dense();
    RC_ASSERT(A == A.transpose().eval());
    const Eigen::VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A).eigenvalues();
    RC_ASSERT(eigenvalues.minCoeff() > 0);
  }));
}

TEST(FlowMatrix, StiffnessHasConstantsInItsNullSpaceAndMassHasTheArea) {
  const Mesh mesh = perturbed_sphere(4, 0.4, 3);
  for (const bool clamp : {false, true}) {
    const Problem problem(mesh, 50, clamp);
    const Eigen::MatrixXd A = problem.dense();
    const Eigen::VectorXd sums = A * Eigen::VectorXd::Ones(A.cols());  // M 1
    for (std::uint32_t v = 0; v < sums.size(); ++v)
      EXPECT_NEAR(sums[v], problem.geometry.lumped_area(v), 1e-14 * A(v, v));
    EXPECT_NEAR(sums.sum(), problem.geometry.area(), 1e-13 * A.diagonal().sum());
  }
}

TEST(FlowMatrix, WeighsAnEquilateralEdgeByItsCotangents) {
  // A regular tetrahedron: every edge has (s/2) (cot 60 + cot 60) = s / sqrt(3).
  MeshData data;
  data.points = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  data.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  const Mesh mesh = to_mesh(data);
  Connectivity connectivity;
  connectivity.rebuild(mesh);
  SurfaceGeometry geometry;
  geometry.compute(positions(mesh), connectivity);
  RingMatrix matrix;
  assemble_flow_matrix(connectivity, geometry, 0.75, false, matrix);
  for (std::size_t v = 0; v < 4; ++v) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(matrix.weight[8 * v + k], 0.75 / std::sqrt(3.0), 1e-15);
    for (std::size_t k = 3; k < 8; ++k) EXPECT_EQ(matrix.weight[8 * v + k], 0);
    EXPECT_NEAR(matrix.diagonal[v], 0.75 * std::sqrt(3.0) + geometry.area() / 4, 1e-14);
  }
}

TEST(FlowMatrix, ClampsTheSumOfAnEdgeNotEachCotangent) {
  const Mesh mesh = perturbed_sphere(5, 0.45, 11);
  const Problem plain(mesh, 10), clamped(mesh, 10, true);
  int num_negative = 0;
  for (std::size_t k = 0; k < plain.matrix.weight.size(); ++k) {
    num_negative += plain.matrix.weight[k] < 0;
    EXPECT_EQ(clamped.matrix.weight[k], std::max(plain.matrix.weight[k], 0.0));
  }
  EXPECT_GT(num_negative, 0);
}

TEST(FlowMatrix, RightHandSideIsMinusStiffnessTimesPositions) {
  for (const Mesh& mesh : {perturbed_sphere(4, 0.3, 5), double_cone(40)}) {
    Problem problem(mesh, 10);
    Eigen::MatrixXd S = problem.dense();  // s L
    for (std::uint32_t v = 0; v < S.rows(); ++v) S(v, v) -= problem.geometry.lumped_area(v);
    const Eigen::MatrixX3d expected = -S * positions(mesh).transpose();
    curvature_right_hand_side(problem.connectivity, problem.matrix, positions(mesh), problem.rhs.data());
    const double scale = S.cwiseAbs().sum() / double(S.rows());
    EXPECT_LT((Problem::columns_of(problem.rhs) - expected).cwiseAbs().maxCoeff(), 1e-12 * scale);
    for (const Lanes& b : problem.rhs) EXPECT_EQ(b[3], 0);
  }
}

TEST(FlowMatrix, RowsWithoutAreaAreRowsOfTheIdentity) {
  Mesh mesh = make_icosphere(Eigen::Vector3d::Zero(), 1, 1);
  positions(mesh).setOnes();  // every face a point
  const Problem problem(mesh, 0);
  EXPECT_EQ(problem.dense(), Eigen::MatrixXd::Identity(12, 12));
}

TEST(Multiply, EqualsTheDenseProduct) {
  for (const Mesh& mesh : {perturbed_sphere(4, 0.3, 5), double_cone(40), double_cone(9)}) {
    const Problem problem(mesh, 10);
    std::vector<Lanes> y(problem.rhs.size());
    multiply(problem.connectivity, problem.matrix, problem.rhs.data(), y.data());
    const Eigen::MatrixX3d expected = problem.dense() * Problem::columns_of(problem.rhs);
    EXPECT_LT((Problem::columns_of(y) - expected).norm(), 1e-14 * expected.norm());
  }
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
