// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/state/ledger.h"

#include "meniscus/geometry/shapes.h"
#include "support/knot.h"

#include <CGAL/boost/graph/Euler_operations.h>
#include <gtest/gtest.h>

#include <cmath>

namespace meniscus {
namespace {

using Eigen::Vector3d;

constexpr double pi = 3.14159265358979323846;

/// A box of 2 x 3 x 5 whose velocities are u(x).
template <class Field>
Drop moving_box(const Vector3d& center, Field u) {
  Drop drop(make_box(center, {2, 3, 5}, 1));
  for (Eigen::Index i = 0; i < drop.velocities().cols(); ++i)
    drop.velocities().col(i) = u(Vector3d(drop.positions().col(i)));
  return drop;
}

double relative(const Vector3d& a, const Vector3d& b) { return (a - b).norm() / b.norm(); }

TEST(Ledger, OfARigidlyMovingBoxIsThatOfMechanics) {
  const Vector3d center(3, -2, 7), speed(4, 5, 6), omega(0.3, -0.2, 0.5);
  const Drop drop = moving_box(center, [&](const Vector3d& x) -> Vector3d { return speed + omega.cross(x - center); });
  const Ledger ledger = measure_ledger(drop);
  EXPECT_NEAR(ledger.volume, 30, 1e-12);
  EXPECT_LT(relative(ledger.center(), center), 1e-14);
  EXPECT_LT(relative(ledger.momentum, 30 * speed), 1e-13);
  const Vector3d inertia = Vector3d(3 * 3 + 5 * 5, 2 * 2 + 5 * 5, 2 * 2 + 3 * 3) * 30 / 12;
  EXPECT_LT(relative(ledger.angular_momentum, center.cross(30 * speed) + inertia.cwiseProduct(omega)), 1e-12);
}

TEST(Ledger, MomentumOfAFlowThatKeepsTheVolumeIsItsVolumeIntegral) {
  // u = (y, z, x) + (x, y, -2 z): divergence free; the integral over a box is V u(center).
  const Vector3d center(1, 2, 3);
  const Drop drop = moving_box(center, [](const Vector3d& x) -> Vector3d {
    return {x.y() + x.x(), x.z() + x.y(), x.x() - 2 * x.z()};
  });
  EXPECT_LT(relative(measure_ledger(drop).momentum, 30 * Vector3d(3, 5, -5)), 1e-13);
}

/// A bumpy drop with uneven velocities.
Drop lively_drop() {
  Drop drop(make_ellipsoid({0.4, -0.2, 5}, {0.2, 0.25, 0.3}, 0.05));
  for (Eigen::Index i = 0; i < drop.velocities().cols(); ++i) {
    const Vector3d x = drop.positions().col(i);
    drop.positions().col(i) += 0.01 * Vector3d(std::sin(20 * x.y()), std::cos(17 * x.z()), std::sin(23 * x.x()));
    drop.velocities().col(i) = 30 * Vector3d(std::cos(9 * x.z()), std::sin(8 * x.x()), x.y() + 1);
  }
  return drop;
}

TEST(Ledger, MeanMotionIsItsMomentumByItsVolume) {
  for (const bool has_gaps : {false, true}) {
    Drop drop = lively_drop();
    if (has_gaps) {  // rows and faces that are no more
      CGAL::Euler::collapse_edge(drop.mesh().edge(drop.mesh().halfedge(VertexIndex(0))), drop.mesh());
      drop.connectivity().rebuild(drop.mesh());
    }
    const Ledger ledger = measure_ledger(drop);
    const MeanMotion motion = mean_motion(drop);
    EXPECT_NEAR(motion.volume, ledger.volume, 1e-14 * ledger.volume);
    EXPECT_LT(relative(motion.velocity, ledger.momentum / ledger.volume), 1e-12);
  }
  EXPECT_EQ(mean_motion(Drop(make_box({0, 0, 0}, {1, 1, 1}, 1))).velocity, Vector3d::Zero());
}

TEST(Ledger, APieceThatWasTornOffIsNoFasterThanItsSurface) {
  // A disc of 1 x 1 x 0.01 whose sides run as +-10 x along z: by its surface a momentum along x of many times that.
  Drop disc(make_box({0, 0, 0}, {1, 1, 0.01}, 0.2));
  for (Eigen::Index i = 0; i < disc.velocities().cols(); ++i) {
    const Vector3d x = disc.positions().col(i);
    disc.velocities().col(i) = Vector3d(1, 2, (x.z() > 0 ? 10 : -10) * x.x());
  }
  ASSERT_GT((mean_motion(disc).velocity - Vector3d(1, 2, 0)).norm(), 100);
  EXPECT_TRUE(calm_torn_piece(disc));
  EXPECT_LT((mean_motion(disc).velocity - Vector3d(1, 2, 0)).norm(), 1e-9);
  const Eigen::Matrix3Xd calm = disc.velocities();
  EXPECT_FALSE(calm_torn_piece(disc)) << "a rigid motion stays";
  EXPECT_EQ(Eigen::Matrix3Xd(disc.velocities()), calm);
}

Ledger wanted_ledger() {
  Ledger ledger;
  ledger.volume = 0.066;
  ledger.moment = ledger.volume * Vector3d(0.41, -0.22, 5.01);
  ledger.momentum = {0.5, -0.7, 1.1};
  ledger.angular_momentum = ledger.center().cross(ledger.momentum) + Vector3d(1e-3, 2e-3, -3e-3);
  return ledger;
}

TEST(Ledger, AFreeDropTakesAnyLedger) {
  Drop drop = lively_drop();
  const Ledger wanted = wanted_ledger();
  restore_ledger(drop, wanted);
  const Ledger is = measure_ledger(drop);
  EXPECT_NEAR(is.volume / wanted.volume, 1, 1e-12);
  EXPECT_LT(relative(is.center(), wanted.center()), 1e-12);
  EXPECT_LT(relative(is.momentum, wanted.momentum), 1e-12);
  EXPECT_LT(relative(is.angular_momentum, wanted.angular_momentum), 1e-11);
}

TEST(Ledger, ItsOwnLedgerMovesADropByRoundingOnlyWhereItHadNoFlux) {
  Drop drop = lively_drop();
  restore_ledger(drop, measure_ledger(drop));  // takes the flux away
  const Eigen::Matrix3Xd x = drop.positions(), u = drop.velocities();
  restore_ledger(drop, measure_ledger(drop));
  EXPECT_LT((drop.positions() - x).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((drop.velocities() - u).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Ledger, ADropOnASolidKeepsItsPlaceAndVelocityAndTakesVolume) {
  Drop drop(make_cap({0, 0, 0}, {0, 0, 1}, 0.2, pi / 2, 0.05));
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i)
    if (drop.positions()(2, i) < 1e-9) {
      drop.contact()[i] = drop.positions().col(i).norm() > 0.199 ? Contact::line : Contact::wetted;
      drop.contact_normals().col(i) = Vector3d::UnitZ();
      drop.contact_solid()[i] = 0;
    }
  const Eigen::Matrix3Xd x = drop.positions();
  Ledger wanted = measure_ledger(drop);
  wanted.volume *= 1.01;
  wanted.momentum = wanted.volume * Vector3d(3, -2, -1);
  restore_ledger(drop, wanted);
  const Ledger is = measure_ledger(drop);
  EXPECT_NEAR(is.volume / wanted.volume, 1, 1e-12);
  EXPECT_EQ(drop.velocities().norm(), 0);
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i)
    if (is_colliding(drop.contact()[i])) {
      EXPECT_EQ(Vector3d(drop.positions().col(i)), Vector3d(x.col(i)));
    }
}

TEST(Ledger, PiecesShareWhatIsMissing) {
  std::vector<Drop> pieces{Drop(make_sphere({0, 0, 0}, 0.2, 0.06)), Drop(make_sphere({1, 0, 0}, 0.1, 0.04))};
  Ledger whole = measure_ledger(pieces[0]);
  whole += measure_ledger(pieces[1]);
  whole.volume *= 1.001;
  whole.moment *= 1.001;
  whole.momentum = {0.1, 0.2, 0.3};
  restore_ledger(pieces, whole);
  Ledger sum = measure_ledger(pieces[0]);
  sum += measure_ledger(pieces[1]);
  EXPECT_NEAR(sum.volume / whole.volume, 1, 1e-12);
  EXPECT_LT(relative(sum.moment, whole.moment), 1e-12);
  EXPECT_LT(relative(sum.momentum, whole.momentum), 1e-12);
  EXPECT_LT(
      relative(measure_ledger(pieces[0]).momentum / measure_ledger(pieces[0]).volume, whole.momentum / whole.volume),
      1e-9);
}

/// A knot of six faces hardly has a motion that carries what it carried before it was mended: some were made ten times
/// as fast by every mending. A tetrahedron pair that is drawn together to a needle is to keep its spin.
TEST(Ledger, AKnotIsNotMadeMuchFasterThanItWas) {
  Drop drop(make_knot());
  for (Eigen::Index i = 0; i < drop.velocities().cols(); ++i)
    drop.velocities().col(i) = Vector3d(3, 4, 5) + 1e4 * Vector3d::UnitZ().cross(Vector3d(drop.positions().col(i)));
  const Ledger ledger = measure_ledger(drop);
  drop.positions().topRows(2) *= 0.05;
  const Vector3d mean = ledger.momentum / ledger.volume;
  const double before = top_speed(drop, mean);
  restore_ledger(drop, ledger, false);
  EXPECT_LE(top_speed(drop, mean), 2 * before);
  EXPECT_LT(relative(measure_ledger(drop).momentum / drop.volume(), mean), 1e-9) << "momentum by volume stays";
}

TEST(Ledger, WithoutVolumeNothingHappens) {
  Drop drop = lively_drop();
  const Eigen::Matrix3Xd x = drop.positions();
  restore_ledger(drop, Ledger{});
  EXPECT_EQ((drop.positions() - x).cwiseAbs().maxCoeff(), 0);
}

}  // namespace
}  // namespace meniscus
