// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/geometry/flow_matrix.h"

#include "support/flow_step_problem.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

using namespace flow_step;

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

}  // namespace
}  // namespace meniscus
