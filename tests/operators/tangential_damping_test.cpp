// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/operators/tangential_damping.h"

#include "meniscus/geometry/rigid_motion.h"
#include "meniscus/geometry/shapes.h"
#include "meniscus/state/free_rigid_motion.h"

#include <Eigen/Dense>

#include <gtest/gtest.h>

namespace meniscus {
namespace {

using Eigen::Vector3d;

const SurfaceGeometry& geometry_of(Drop& drop) {
  drop.workspace().geometry.compute(std::as_const(drop).positions(), drop.connectivity());
  return drop.workspace().geometry;
}

void remove(Drop& drop, const SurfaceGeometry& geometry, double dt) {
  remove_tangential_deformation(drop, geometry, free_rigid_motion(drop, geometry), dt);
}

TEST(TangentialDamping, LeavesNormalMotionAndTheMomentum) {
  Drop drop(make_icosphere({0, 0, 0}, 0.2, 6));
  drop.velocities().setRandom();
  const SurfaceGeometry& geometry = geometry_of(drop);
  const Eigen::Matrix3Xd x0 = drop.positions(), v0 = drop.velocities();
  const RigidMotion before = fit_rigid_motion(drop.positions(), drop.velocities(), geometry);
  const double dt = 1e-3;
  remove_tangential_deformation(drop, geometry, before, dt);
  const Eigen::Matrix3Xd v = drop.velocities();
  drop.positions() = x0;
  const RigidMotion after = fit_rigid_motion(drop.positions(), drop.velocities(), geometry);
  EXPECT_LT((after.translation - before.translation).norm(), 1e-3 * before.translation.norm());
  EXPECT_LT((after.rotation - before.rotation).norm(), 1e-2 * before.rotation.norm());
  // What is left, but for one rigid motion given back, is normal to the surface.
  Eigen::MatrixXd basis(3 * v.cols(), 6 + v.cols());
  basis.setZero();
  Eigen::VectorXd left(3 * v.cols());
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i) {
    left.segment<3>(3 * i) = v.col(i);
    basis.block<3, 3>(3 * i, 0).setIdentity();
    for (int k = 0; k < 3; ++k) basis.block<3, 1>(3 * i, 3 + k) = Vector3d::Unit(k).cross(Vector3d(x0.col(i)));
    basis.block<3, 1>(3 * i, 6 + i) = geometry.normal(i);
  }
  const Eigen::VectorXd fit = basis.completeOrthogonalDecomposition().solve(left);
  EXPECT_LT((basis * fit - left).norm(), 1e-2 * left.norm());
}

TEST(TangentialDamping, LeavesRigidMotionAndCollidingVerticesAlone) {
  Drop drop(make_ellipsoid({0.5, -1, 2}, {0.3, 0.2, 0.15}, 0.05));
  for (Eigen::Index i = 0; i < drop.positions().cols(); ++i)
    drop.velocities().col(i) = Vector3d(1, 2, -3) + Vector3d(4, -5, 6).cross(Vector3d(drop.positions().col(i)));
  const Eigen::Matrix3Xd v0 = drop.velocities();
  remove(drop, geometry_of(drop), 1e-2);
  EXPECT_LT((drop.velocities() - v0).cwiseAbs().maxCoeff(), 1e-12);
  drop.velocities().setRandom();
  drop.contact()[5] = Contact::wetted;
  drop.contact_normals().col(5) = Vector3d::UnitZ();
  const Vector3d v5 = drop.velocities().col(5);
  remove(drop, geometry_of(drop), 1e-2);
  EXPECT_EQ(drop.velocities().col(5), v5);
}

TEST(TangentialDamping, OnASolidOnlyTheMotionAlongItIsRigid) {
  // A drop on a plane that falls as a whole only deforms: its sides must not slide down.
  Drop drop(make_cap({0, 0, 0}, {0, 0, 1}, 0.2, 1.5707963267948966, 0.03));
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i)
    if (drop.positions()(2, i) < 1e-9) {
      drop.contact()[i] = Contact::wetted;
      drop.contact_normals().col(i) = Vector3d::UnitZ();
    }
  drop.velocities().colwise() = Vector3d(0, 0, -1);
  const SurfaceGeometry& geometry = geometry_of(drop);
  remove(drop, geometry, 1e-3);
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i) {
    if (is_colliding(drop.contact()[i])) continue;
    const Vector3d n = geometry.normal(i), v = drop.velocities().col(i);
    EXPECT_LT((v + n.z() * n).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace meniscus
