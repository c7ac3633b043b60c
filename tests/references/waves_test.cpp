// SPDX-License-Identifier: GPL-3.0-or-later
#include "references/waves.h"

#include <gtest/gtest.h>

#include <cmath>

namespace meniscus::references {
namespace {

TEST(Waves, OfAWaterDropOfTwoMillimetres) {
  EXPECT_NEAR(rayleigh_frequency(2, 0.2, Liquid()), std::sqrt(8 * 72 / 0.008), 1e-9);
  EXPECT_NEAR(lamb_decay(2, 0.2, Liquid()), 1.25, 1e-12);
}

TEST(Waves, OnAThreadGrowAsTabulated) {
  Liquid unit;
  unit.surface_tension = 1;
  const double known[][2] = {{0.3, 0.201236}, {0.5, 0.301558}, {0.697, 0.343339}, {0.9, 0.264730}};
  for (const auto& [x, growth] : known) EXPECT_NEAR(rayleigh_plateau_growth(x, 1, unit), growth, 6e-7);
  EXPECT_EQ(rayleigh_plateau_growth(1, 1, unit), 0);
  EXPECT_EQ(rayleigh_plateau_growth(1.2, 1, unit), 0);
  EXPECT_NEAR(2 * M_PI / fastest_thread_wave(), 9.0144, 1e-4);
  // Long waves: I1/I0 -> x/2.
  EXPECT_NEAR(rayleigh_plateau_growth(1e-3, 1, unit) / (1e-3 / std::sqrt(2)), 1, 1e-6);
}

TEST(Waves, ScaleAsCapillarityDoes) {
  Liquid heavy;
  heavy.density = 4;
  EXPECT_NEAR(rayleigh_frequency(3, 0.4, heavy) / rayleigh_frequency(3, 0.2, Liquid()), std::sqrt(1 / 32.0), 1e-12);
  EXPECT_NEAR(rayleigh_plateau_growth(0.5, 0.4, heavy) / rayleigh_plateau_growth(0.5, 0.2, Liquid()),
              std::sqrt(1 / 32.0), 1e-12);
}

}  // namespace
}  // namespace meniscus::references
