// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/operators/mean_curvature_flow.h"

#include "meniscus/core/error.h"
#include "meniscus/geometry/shapes.h"

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <cmath>

namespace meniscus {
namespace {

using Eigen::Vector3d;

SolveReport flow(Drop& drop, double dt, const MeanCurvatureFlowOptions& options) {
  drop.workspace().geometry.compute(std::as_const(drop).positions(), drop.connectivity());
  return flow_by_mean_curvature(drop, drop.workspace().geometry, dt, options);
}

MeanCurvatureFlowOptions exact(double gamma) {
  MeanCurvatureFlowOptions options;
  options.coefficient = gamma;
  options.solver.tolerance = 1e-12;
  return options;
}

/// The largest error of the radius after one step, against R/(1 + 2 gamma dt/R^2).
double one_step_error(int frequency) {
  const double R = 0.2, gamma_dt = 2e-3;
  Drop drop(make_icosphere({1, 1, 1}, R, frequency));
  flow(drop, 1, exact(gamma_dt));
  const double expected = R / (1 + 2 * gamma_dt / (R * R));
  return ((drop.positions().colwise() - Vector3d(1, 1, 1)).colwise().norm().array() - expected).abs().maxCoeff() / R;
}

TEST(MeanCurvatureFlow, OneStepOnASphereConverges) {
  // Second order: the error falls by about 4 when the edges halve.
  const double coarse = one_step_error(8), middle = one_step_error(16), fine = one_step_error(32);
  EXPECT_LT(fine, 1e-3);
  EXPECT_LT(middle, 0.35 * coarse);
  EXPECT_LT(fine, 0.35 * middle);
}

TEST(MeanCurvatureFlow, ASphereShrinksAsTheSquareRootOfTime) {
  // r^2 = r0^2 - 4 gamma t; first order in dt.
  const auto error = [](int steps) {
    const double R = 1, gamma = 0.1, t = 1;
    Drop drop(make_icosphere({0, 0, 0}, R, 16));
    for (int n = 0; n < steps; ++n) flow(drop, t / steps, exact(gamma));
    return drop.positions().colwise().norm().mean() - std::sqrt(R * R - 4 * gamma * t);
  };
  const double coarse = error(20), fine = error(80);
  EXPECT_LT(std::abs(fine), 4e-3);
  EXPECT_LT(std::abs(fine), 0.4 * std::abs(coarse));
}

/// The factor that a step of viscosity alone leaves of a velocity field of degree 2 on the unit sphere: lambda = 6.
double decay_of_degree_two(int frequency, double eta) {
  Drop drop(make_icosphere({0, 0, 0}, 1, frequency));
  const Eigen::Matrix3Xd x = drop.positions();
  const Eigen::RowVectorXd y2 = x.row(0).cwiseProduct(x.row(1));
  drop.velocities().setZero();
  drop.velocities().row(2) = y2;
  MeanCurvatureFlowOptions options = exact(0);
  options.viscosity = eta;
  flow(drop, 1, options);
  EXPECT_LT((drop.positions() - x - (drop.velocities() - Vector3d::UnitZ() * y2)).cwiseAbs().maxCoeff(), 1e-12);
  return drop.velocities().row(2).dot(y2) / y2.squaredNorm();
}

TEST(MeanCurvatureFlow, ViscosityDecaysAnEigenfunctionByItsEigenvalue) {
  // 1/(1 + 6 eta dt), of second order in the edges; what it does to velocities moves the vertices too.
  const auto error = [](int frequency) { return std::abs(decay_of_degree_two(frequency, 0.5) - 1 / (1 + 3.0)); };
  EXPECT_LT(error(16), 2e-3);
  EXPECT_LT(error(16), 0.35 * error(8));
}

TEST(MeanCurvatureFlow, ViscosityLeavesRigidMotionAlone) {
  Drop drop(make_ellipsoid({0.5, -1, 2}, {0.3, 0.2, 0.15}, 0.05));
  const Eigen::Matrix3Xd x = drop.positions();
  const Vector3d translation(1, 2, -3), rotation(4, -5, 6);
  for (Eigen::Index i = 0; i < x.cols(); ++i)
    drop.velocities().col(i) = translation + rotation.cross(Vector3d(x.col(i)) - Vector3d(0.5, -1, 2));
  const Eigen::Matrix3Xd v = drop.velocities();
  MeanCurvatureFlowOptions options = exact(0);
  options.viscosity = 0.3;
  options.rotation = rotation;
  flow(drop, 1e-2, options);
  EXPECT_LT((drop.velocities() - v).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((drop.positions() - x).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(MeanCurvatureFlow, TheCentreOfMassStaysAndVelocityFollowsTheMove) {
  Drop drop(make_ellipsoid({3, 2, 1}, {0.3, 0.2, 0.15}, 0.04));
  const Eigen::Matrix3Xd x0 = drop.positions();
  const double dt = 1e-3;
  flow(drop, dt, exact(0.5));
  const SurfaceGeometry& before = drop.workspace().geometry;  // of the old positions
  Vector3d momentum = Vector3d::Zero();
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i) {
    momentum += before.lumped_area(i) * drop.velocities().col(i);
    EXPECT_LT((drop.velocities().col(i) * dt - (drop.positions().col(i) - x0.col(i))).norm(), 1e-15);
  }
  EXPECT_LT(momentum.norm(), 1e-9);  // 1^T M d = -gamma dt 1^T L X = 0
}

TEST(MeanCurvatureFlow, AreaNeverGrowsOnASpheroidAtLargeSteps) {
  Drop drop(make_ellipsoid({0, 0, 0}, {0.2, 0.2, 0.4}, 0.03));
  MeanCurvatureFlowOptions options = exact(2 * 72 / 0.2 / 240);
  options.solver.tolerance = 1e-8;
  double area = 1e300;
  for (int n = 0; n < 6; ++n) {
    flow(drop, 1.0 / 240, options);
    EXPECT_LT(drop.workspace().geometry.area(), area);
    area = drop.workspace().geometry.area();
  }
}

TEST(MeanCurvatureFlow, RotatesWithTheMesh) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  Drop drop(make_ellipsoid({0, 0, 0}, {0.3, 0.2, 0.15}, 0.05));
  Drop turned(drop);
  turned.positions() = (turn * Eigen::Matrix3Xd(drop.positions())).eval();
  flow(drop, 1e-2, exact(0.2));
  flow(turned, 1e-2, exact(0.2));
  EXPECT_LT((turned.positions() - turn * drop.positions()).cwiseAbs().maxCoeff(), 1e-11);
}

TEST(MeanCurvatureFlow, VerticesOnASolidStayOrSlideAsAsked) {
  for (const ContactInFlow contact : {ContactInFlow::fixed, ContactInFlow::slide}) {
    Drop drop(make_icosphere({0, 0, 0}, 0.2, 6));
    for (std::uint32_t i = 0; i < drop.num_rows(); ++i)
      if (drop.positions()(2, i) < -0.1) {
        drop.contact()[i] = Contact::wetted;
        drop.contact_normals().col(i) = Vector3d::UnitZ();
      }
    const Eigen::Matrix3Xd x0 = drop.positions();
    MeanCurvatureFlowOptions options = exact(0.2);
    options.contact = contact;
    flow(drop, 1e-2, options);
    double slid = 0;
    for (std::uint32_t i = 0; i < drop.num_rows(); ++i) {
      if (!is_colliding(drop.contact()[i])) continue;
      EXPECT_EQ(drop.positions()(2, i), x0(2, i));
      slid = std::max(slid, (drop.positions().col(i) - x0.col(i)).norm());
    }
    EXPECT_EQ(slid > 0, contact == ContactInFlow::slide);
  }
}

TEST(MeanCurvatureFlow, NoFlowNoChangeAndAFailedSolveIsAnError) {
  Drop drop(make_icosphere({0, 0, 0}, 0.2, 6));
  const Eigen::Matrix3Xd x0 = drop.positions();
  flow(drop, 0, exact(0.2));
  flow(drop, 1, exact(0));
  EXPECT_EQ((drop.positions() - x0).norm(), 0);
  MeanCurvatureFlowOptions options = exact(10);
  options.solver.method = SolverMethod::conjugate_gradient_jacobi;
  options.solver.max_iterations = 1;
  EXPECT_THROW(flow(drop, 1, options), NumericsError);
}

}  // namespace
}  // namespace meniscus
