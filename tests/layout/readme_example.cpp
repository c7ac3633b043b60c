// SPDX-License-Identifier: GPL-3.0-or-later
#include <meniscus/geometry/shapes.h>
#include <meniscus/simulation/simulation.h>

#include <cmath>
#include <cstdio>

int main() {
  meniscus::Scene scene = meniscus::default_scene();  // water, gravity along -z, no solids
  scene.time_step = 1.0 / 960;                        // s
  meniscus::SolidSpec plate;                          // the plane z = 0
  plate.advancing_angle = 1.2;                        // radians, through the liquid
  plate.receding_angle = 0.9;
  scene.solids.push_back(plate);
  std::vector<meniscus::Drop> drops;
  drops.emplace_back(meniscus::make_sphere({0, 0, 0.3}, 0.2, 0.08));  // centre, radius, edge length in cm
  meniscus::Simulation simulation(scene, std::move(drops));
  while (simulation.time() < 0.2) simulation.step();
  const meniscus::Drop& drop = simulation.drops().front();
  const double volume_error = drop.volume() / drop.target_volume() - 1;
  std::printf("height %.3f cm, volume off by %.1e\n", drop.positions().row(2).maxCoeff(), volume_error);
  return std::abs(volume_error) < 1e-6 ? 0 : 1;
}
