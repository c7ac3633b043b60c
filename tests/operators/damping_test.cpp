// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/operators/damping.h"

#include "meniscus/geometry/shapes.h"

#include <gtest/gtest.h>

namespace meniscus {
namespace {

using Eigen::Vector3d;

const SurfaceGeometry& geometry_of(Drop& drop) {
  drop.workspace().geometry.compute(std::as_const(drop).positions(), drop.connectivity());
  return drop.workspace().geometry;
}

/// An eigenfunction of the Laplacian on the unit sphere, degree 2: lambda = 6.
double y2(const Vector3d& n) { return n.x() * n.y(); }

/// The factor that a step of viscosity leaves of the velocity field y2 times x's axis.
double decay_of_degree_two(int frequency, double eta, double dt) {
  Drop drop(make_icosphere({0, 0, 0}, 1, frequency));
  for (Eigen::Index i = 0; i < drop.positions().cols(); ++i)
    drop.velocities().col(i) = y2(Vector3d(drop.positions().col(i))) * Vector3d::UnitX();
  DampingOptions options;
  options.viscosity_coefficient = eta;
  options.solver.tolerance = 1e-12;
  apply_damping(drop, geometry_of(drop), dt, options);
  double after = 0, before = 0;
  for (Eigen::Index i = 0; i < drop.positions().cols(); ++i) {
    const double y = y2(Vector3d(drop.positions().col(i)));
    after += drop.velocities()(0, i) * y;
    before += y * y;
  }
  return after / before;
}

TEST(Damping, FactorIsOneMinusMuDt) {
  for (const double mu : {0.0, 0.3, 0.5, 100.0})
    for (const double dt : {0.0, 1e-4, 1.0 / 240}) {
      Drop drop(make_icosphere({1, 2, 3}, 0.2, 3));
      drop.velocities().setRandom();
      const Eigen::Matrix3Xd v0 = drop.velocities();
      DampingOptions options;
      options.damping_rate = mu;
      apply_damping(drop, geometry_of(drop), dt, options);
      EXPECT_LT((drop.velocities() - (1 - mu * dt) * v0).cwiseAbs().maxCoeff(), 1e-15);
    }
}

TEST(Damping, ARateBeyondTheStepStopsAndDoesNotReverse) {
  Drop drop(make_icosphere({0, 0, 0}, 0.2, 2));
  drop.velocities().setRandom();
  DampingOptions options;
  options.damping_rate = 1e6;
  apply_damping(drop, geometry_of(drop), 0.1, options);
  EXPECT_EQ(drop.velocities().norm(), 0);
}

TEST(Damping, ViscosityDecaysAnEigenfunctionByItsEigenvalue) {
  // Explicit: 1 - 6 eta dt. Implicit (a step beyond the explicit limit): 1/(1 + 6 eta dt).
  const double explicit_coarse = decay_of_degree_two(8, 1e-4, 1) - (1 - 6e-4);
  const double explicit_fine = decay_of_degree_two(16, 1e-4, 1) - (1 - 6e-4);
  EXPECT_LT(std::abs(explicit_fine), 2e-5);
  EXPECT_LT(std::abs(explicit_fine), 0.5 * std::abs(explicit_coarse));
  EXPECT_NEAR(decay_of_degree_two(16, 0.5, 1), 1 / (1 + 3.0), 0.01);
}

TEST(Damping, LargeViscosityIsStable) {
  Drop drop(make_icosphere({0, 0, 0}, 0.2, 8));
  drop.velocities().setRandom();
  const double before = drop.velocities().cwiseAbs().maxCoeff();
  DampingOptions options;
  options.viscosity_coefficient = 1e4;
  const DampingReport report = apply_damping(drop, geometry_of(drop), 1, options);
  EXPECT_TRUE(report.implicit);
  EXPECT_LE(drop.velocities().cwiseAbs().maxCoeff(), before);
}

TEST(Damping, PoorVerticesTakeOnTheirNeighboursMean) {
  Drop drop(make_icosphere({0, 0, 0}, 0.2, 4));
  drop.velocities()(2, 7) = 1;
  drop.poor_quality()[7] = 1;
  const DampingReport report = apply_damping(drop, geometry_of(drop), 1e-3, {});
  EXPECT_EQ(report.smoothed, 1u);
  EXPECT_DOUBLE_EQ(drop.velocities()(2, 7), 0.5);
}

}  // namespace
}  // namespace meniscus
