// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/operators/volume_correction.h"

#include "meniscus/geometry/shapes.h"

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <cmath>

namespace meniscus {
namespace {

using Eigen::Vector3d;

VolumeCorrectionReport correct(Drop& drop, double dt, const VolumeCorrectionOptions& options) {
  drop.workspace().geometry.compute(std::as_const(drop).positions(), drop.connectivity());
  return correct_volume(drop, drop.workspace().geometry, dt, options);
}

TEST(VolumeCorrection, GlobalMeetsTheTargetToRounding) {
  for (const double factor : {0.9, 0.999, 1.0, 1.001, 1.1}) {
    Drop drop(make_ellipsoid({5, 5, 5}, {0.3, 0.2, 0.15}, 0.04));
    drop.set_target_volume(factor * drop.volume());
    const VolumeCorrectionReport report = correct(drop, 1e-3, {});
    EXPECT_NEAR(drop.volume() / drop.target_volume(), 1, 1e-11);
    EXPECT_NEAR(report.relative_error_before, 1 / factor - 1, 1e-12);
  }
}

TEST(VolumeCorrection, TheOffsetEntersTheVelocityToo) {
  Drop drop(make_icosphere({0, 0, 0}, 0.2, 8));
  drop.set_target_volume(1.01 * drop.volume());
  const Eigen::Matrix3Xd x0 = drop.positions();
  const double dt = 1e-3;
  const VolumeCorrectionReport report = correct(drop, dt, {});
  EXPECT_LT((drop.velocities() * dt - (drop.positions() - x0)).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_NEAR(report.offset, 0.2 * (std::cbrt(1.01) - 1), 1e-5);  // d = dV/A to first order
}

TEST(VolumeCorrection, ALimitedOffsetWaitsForTheNextSteps) {
  Drop drop(make_icosphere({0, 0, 0}, 0.2, 6));
  drop.set_target_volume(1.2 * drop.volume());
  VolumeCorrectionOptions options;
  options.offset_limit = 0.004;
  int steps = 0;
  while (correct(drop, 1e-3, options).limited) ASSERT_LT(++steps, 20);
  EXPECT_EQ(steps, static_cast<int>(0.2 * (std::cbrt(1.2) - 1) / 0.004));
  EXPECT_NEAR(drop.volume() / drop.target_volume(), 1, 1e-11);
}

TEST(VolumeCorrection, CollidingVerticesTakeNoPart) {
  using Method = VolumeCorrectionMethod;
  for (const Method method : {Method::local, Method::global, Method::local_then_global})
    for (const LocalCorrection local : {LocalCorrection::smooth_velocity, LocalCorrection::local_pressure}) {
      Drop drop(make_icosphere({0, 0, 0}, 0.2, 6));
      drop.velocities().setRandom();
      drop.displacements().setRandom();
      for (std::uint32_t i = 0; i < 20; ++i) drop.contact()[i] = Contact::wetted;
      drop.set_target_volume(0.95 * drop.volume());
      const Eigen::Matrix3Xd x0 = drop.positions(), v0 = drop.velocities();
      VolumeCorrectionOptions options;
      options.method = method;
      options.local = local;
      correct(drop, 1e-3, options);
      EXPECT_EQ((drop.positions() - x0).leftCols(20).norm(), 0);
      EXPECT_EQ((drop.velocities() - v0).leftCols(20).norm(), 0);
      EXPECT_GT((drop.positions() - x0).norm(), 0);
    }
}

TEST(VolumeCorrection, RigidMotionIsNeverCorrected) {
  using Method = VolumeCorrectionMethod;
  Drop drop(make_ellipsoid({0, 0, 0}, {0.3, 0.2, 0.15}, 0.04));
  for (Eigen::Index i = 0; i < drop.positions().cols(); ++i)
    drop.velocities().col(i) = Vector3d(5, 6, 7) + Vector3d(1, 2, 3).cross(Vector3d(drop.positions().col(i)));
  const Eigen::Matrix3Xd v0 = drop.velocities();
  VolumeCorrectionOptions options;
  options.method = Method::local_then_global;
  options.local = LocalCorrection::smooth_velocity;
  correct(drop, 1e-3, options);
  EXPECT_LT((drop.velocities() - v0).cwiseAbs().maxCoeff(), 1e-11);
}

TEST(VolumeCorrection, AsWrittenTakesAUniformExpansionAway) {
  // u = n: a_i = 1, a_bar_i = 1, so that Eq 11 leaves nothing.
  Drop drop(make_icosphere({0, 0, 0}, 0.2, 8));
  drop.workspace().geometry.compute(std::as_const(drop).positions(), drop.connectivity());
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i) drop.velocities().col(i) = drop.workspace().geometry.normal(i);
  VolumeCorrectionOptions options;
  options.method = VolumeCorrectionMethod::local;
  options.local = LocalCorrection::smooth_velocity;
  correct(drop, 1e-3, options);
  EXPECT_LT(drop.velocities().cwiseAbs().maxCoeff(), 1e-9);
}

TEST(VolumeCorrection, LocalPressureKeepsTheFluxOfTheFlowAndMostOfModeTwo) {
  // A flow q = 1 + y, y a harmonic of degree 2: the mean takes 1 whole and 1/(1 + 4 n (n + 1)) of y.
  const double R = 0.2, dt = 1e-3;
  Drop drop(make_icosphere({0, 0, 0}, R, 16));
  SurfaceGeometry& geometry = drop.workspace().geometry;
  geometry.compute(std::as_const(drop).positions(), drop.connectivity());
  const auto y = [](const Vector3d& n) { return 0.5 * (3 * n.z() * n.z() - 1); };
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i) {
    const Vector3d n = geometry.normal(i);
    drop.displacements().col(i) = 1e-6 * (1 + y(n)) * n;
  }
  VolumeCorrectionOptions options;
  options.method = VolumeCorrectionMethod::local;
  options.solver.tolerance = 1e-10;
  const double before = drop.volume();
  correct(drop, dt, options);
  double flux = 0, mode = 0, norm = 0;
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i) {
    const Vector3d n = geometry.normal(i);
    const double taken = -drop.velocities().col(i).dot(n) * dt / 1e-6, area = geometry.lumped_area(i);
    flux += area * (taken - (1 + y(n)));
    mode += area * taken * y(n);
    norm += area * y(n) * y(n);
  }
  EXPECT_NEAR(flux / geometry.area(), 0, 1e-9);
  EXPECT_NEAR(mode / norm, 1.0 / 25, 1e-3);
  EXPECT_NEAR((before - drop.volume()) / (1e-6 * geometry.area()), 1, 2e-3);
}

}  // namespace
}  // namespace meniscus
