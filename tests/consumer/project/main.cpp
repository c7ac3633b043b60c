// SPDX-License-Identifier: GPL-3.0-or-later
// A project outside the tree: a drop of water falls for a tenth of a second.
#include <meniscus/core/version.h>
#include <meniscus/geometry/shapes.h>
#include <meniscus/simulation/simulation.h>

#include <cmath>
#include <cstdio>

int main() {
  meniscus::Scene scene = meniscus::default_scene();
  std::vector<meniscus::Drop> drops;
  drops.emplace_back(meniscus::make_sphere({0, 0, 0}, 0.2, 0.06));
  meniscus::Simulation simulation(scene, std::move(drops));
  while (simulation.time() < 0.1) simulation.step();
  const double n = static_cast<double>(simulation.num_steps()), dt = scene.time_step;
  const double expected = -981 * dt * dt * n * (n + 1) / 2;
  const double height = simulation.drops().front().positions().row(2).mean();
  std::printf("meniscus %s: fell to %.4f cm, expected %.4f cm\n", meniscus::version().c_str(), height, expected);
  return std::abs(height - expected) < 1e-3 ? 0 : 1;
}
