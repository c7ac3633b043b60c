// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/simulation/check_frame.h"

#include "meniscus/core/error.h"
#include "meniscus/geometry/shapes.h"

#include <gtest/gtest.h>

#include <limits>

namespace meniscus {
namespace {

std::vector<Drop> ball() {
  std::vector<Drop> drops;
  drops.emplace_back(make_sphere(Eigen::Vector3d::Zero(), 0.2, 0.06));
  return drops;
}

TEST(CheckFrame, SoundDropsPassAndNoneDo) {
  EXPECT_NO_THROW(check_frame(ball(), true));
  EXPECT_NO_THROW(check_frame({}, true));
}

TEST(CheckFrame, ADropThatMeetsItselfIsRefused) {
  std::vector<Drop> drops = ball();
  Eigen::Index top = 0;
  drops[0].positions().row(2).maxCoeff(&top);
  drops[0].positions()(2, top) = -0.3;  // through the bottom
  EXPECT_THROW(check_frame(drops, false), SoundnessError);
}

TEST(CheckFrame, VolumeThatIsAFifthOffIsRefusedWhereItIsKept) {
  std::vector<Drop> drops = ball();
  drops[0].positions() *= 1.05;  // 16 % more
  EXPECT_NO_THROW(check_frame(drops, true));
  drops[0].positions() *= 1.05;  // 34 %
  EXPECT_THROW(check_frame(drops, true), SoundnessError);
  EXPECT_NO_THROW(check_frame(drops, false));
}

TEST(CheckFrame, AVelocityThatIsNotFiniteIsRefused) {
  std::vector<Drop> drops = ball();
  drops[0].velocities()(1, 3) = std::numeric_limits<double>::infinity();
  EXPECT_THROW(check_frame(drops, true), SoundnessError);
}

}  // namespace
}  // namespace meniscus
