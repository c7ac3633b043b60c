// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/simulation/oscillation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace meniscus {
namespace {

std::vector<double> samples_of(double omega, double rate, double dt) {
  std::vector<double> samples;
  for (int n = 0; n < 20; ++n) samples.push_back(0.3 + std::exp(-rate * n * dt) * std::cos(omega * n * dt + 0.4));
  return samples;
}

TEST(FitSwing, FindsADampedSwingExactly) {
  constexpr double omega = 268, dt = 1.0 / 240;  // 5.6 samples a period
  for (const double rate : {0.0, 3.0, 40.0}) {
    const Swing swing = fit_swing(samples_of(omega, rate, dt), dt);
    EXPECT_NEAR(swing.angular_frequency / omega, 1, 1e-9);
    EXPECT_NEAR(swing.kept_per_period, std::exp(-rate * 2 * M_PI / omega), 1e-9);
  }
}

TEST(FitSwing, WhatCreepsHasNoFrequency) {
  std::vector<double> samples;
  for (int n = 0; n < 20; ++n) samples.push_back(0.1 + std::exp(-0.2 * n) + 0.5 * std::exp(-0.7 * n));
  EXPECT_TRUE(std::isnan(fit_swing(samples, 0.01).angular_frequency));
}

}  // namespace
}  // namespace meniscus
