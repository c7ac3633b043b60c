// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/error.h"
#include "meniscus/geometry/shapes.h"
#include "meniscus/scene/read_scene.h"
#include "meniscus/simulation/oscillation.h"
#include "meniscus/simulation/simulation.h"

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

/// The scenes of bench_step.
namespace meniscus::bench {

/// A scene and, if it has none of its own, its drops.
struct Setting {
  Scene scene;
  std::vector<Drop> drops;
  int settling = 20;  ///< steps taken before anything is counted

  Simulation simulation() const { return drops.empty() ? Simulation(scene) : Simulation(scene, drops); }
};

/// One drop of 20 frequency^2 triangles in free flight: R = 0.2 cm, mode 2 of 5 %. The step is h/sqrt(c), c = 2
/// sigma/(rho R): a mesh that is twice as fine takes steps half as long, and the flow's matrix stays as stiff.
inline Setting free_flight(int frequency, Level level) {
  constexpr double radius = 0.2;
  Setting setting;
  setting.scene = default_scene();
  setting.scene.model = level;
  const double triangles = 20.0 * frequency * frequency;
  const double edge = std::sqrt(4 * pi * radius * radius / triangles / (std::sqrt(3.0) / 4));
  setting.scene.mesh.edge_min = 0.5 * edge;
  setting.scene.mesh.edge_max = 1.5 * edge;
  const Liquid& liquid = setting.scene.liquid;
  setting.scene.time_step = edge / std::sqrt(2 * liquid.surface_tension / (liquid.density * radius));
  setting.drops.push_back(oscillating_drop(frequency, radius, 0.05));
  return setting;
}

/// A vertical pane crowded with drops that it holds: about 50,000 triangles.
inline Setting window(bool sleep) {
  Setting setting;
  Scene& scene = setting.scene = default_scene();
  scene.time_step = 1.0 / 960;
  scene.sleep = sleep;
  scene.mesh.edge_min = 0.02;
  scene.mesh.edge_max = 0.06;
  SolidSpec pane;
  pane.name = "pane";
  pane.normal = {0, 1, 0};
  pane.advancing_angle = pi / 2;
  pane.receding_angle = pi / 6;
  scene.solids.push_back(pane);
  DropSpec drops;
  drops.shape = DropShape::scatter;
  drops.on = "pane";
  drops.count = 170;
  drops.seed = 1;
  drops.size = {9, 0, 9};
  drops.radius_min = 0.08;
  drops.radius_max = 0.17;
  drops.gap = 0.06;
  scene.drops.push_back(drops);
  setting.settling = sleep ? 480 : 120;
  return setting;
}

/// What is measured if nothing is named. The first four give the exponent.
inline std::vector<std::string> all_settings() {
  return {"free_5k",       "free_20k", "free_100k", "free_200k", "free_20k_pressure", "window",
          "window_asleep", "collide",  "lotus",     "bird",      "tap_middle"};
}

/// The setting of a name: one of the above, or a scene of data/scenes. Throws UsageError, or what read_scene throws.
inline Setting make_setting(const std::string& name) {
  if (name == "free_5k") return free_flight(16, Level::calibrated);
  if (name == "free_20k") return free_flight(32, Level::calibrated);
  if (name == "free_100k") return free_flight(71, Level::calibrated);
  if (name == "free_200k") return free_flight(100, Level::calibrated);
  if (name == "free_20k_pressure") return free_flight(32, Level::pressure);
  if (name == "window") return window(false);
  if (name == "window_asleep") return window(true);
  Setting setting;
  setting.scene = read_scene(std::filesystem::path(MENISCUS_DATA_DIR) / "scenes" / (name + ".json"));
  return setting;
}

}  // namespace meniscus::bench
