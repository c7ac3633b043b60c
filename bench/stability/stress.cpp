// SPDX-License-Identifier: GPL-3.0-or-later
#include "stress.h"

#include "meniscus/core/error.h"
#include "meniscus/geometry/inspect.h"
#include "meniscus/simulation/safe_time_step.h"
#include "meniscus/simulation/simulation.h"
#include "support/levels.h"
#include "test_meshes.h"

#include <fmt/format.h>

#include <cmath>
#include <random>

namespace meniscus::bench {
namespace {

constexpr int num_steps = 8;
constexpr double most_volume_error = 0.05;

class Numbers {
 public:
  explicit Numbers(unsigned seed) : generator_(seed) {}
  double between(double low, double high) { return low + (high - low) * (generator_() / 4294967296.0); }
  double log_between(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }
  int below(int n) { return static_cast<int>(generator_() % static_cast<unsigned>(n)); }

 private:
  std::mt19937 generator_;
};

struct Trial {
  Scene scene;
  std::vector<Drop> drops;
  std::string words;
};

Trial random_trial(unsigned seed) {
  Numbers numbers(seed);
  Trial trial;
  Scene& scene = trial.scene;
  scene = default_scene();
  const NamedLevel& level = levels[numbers.below(static_cast<int>(std::size(levels)))];
  scene.model = level.level;
  const double radius = numbers.log_between(0.05, 0.3), edge = radius * numbers.between(0.12, 0.35);
  scene.mesh = {0.5 * edge, 1.5 * edge, 0.5};
  scene.liquid.surface_tension = numbers.log_between(10, 500);
  scene.liquid.viscosity = numbers.log_between(1e-3, 1);
  scene.paper.curvature_flow_coefficient = numbers.log_between(0.02, 0.5);
  const auto quality = static_cast<Quality>(numbers.below(static_cast<int>(quality_names.size())));
  const double speed = numbers.between(0, 40);
  const int where = numbers.below(3);
  Mesh mesh = test_spheroid(quality, radius, edge, seed);
  if (where > 0) {
    SolidSpec solid;
    solid.advancing_angle = numbers.between(30, 150) * pi / 180;
    solid.receding_angle = solid.advancing_angle * numbers.between(0.5, 1);
    if (where == 2) {
      solid.shape = SolidShape::sphere;
      solid.radius = 5 * radius;
      solid.center = {0, 0, -solid.radius};
    }
    scene.solids.push_back(solid);
    Columns x = positions(mesh);
    x.row(2).array() -= x.row(2).minCoeff();
  }
  trial.drops.emplace_back(std::move(mesh));
  trial.drops[0].velocities().row(2).setConstant(-speed);
  scene.time_step = numbers.log_between(0.05, 1) * safe_time_step(make_step_options(scene), trial.drops);
  constexpr const char* places[] = {"air", "plane", "sphere"};
  trial.words = fmt::format("{} {} {} R {:.3f} edge {:.3f} sigma {:.0f} dt {:.2e}", level.name, places[where],
                            quality_names[static_cast<std::size_t>(quality)], radius, edge,
                            scene.liquid.surface_tension, scene.time_step);
  return trial;
}

/// What went wrong, or "".
std::string run_trial(Trial& trial, std::size_t& recoveries) {
  try {
    Simulation simulation(trial.scene, std::move(trial.drops));
    for (int k = 0; k < num_steps; ++k) {
      recoveries += simulation.step().recoveries;
      if (!std::isfinite(simulation.volume())) return "not finite";
      if (std::abs(simulation.volume() / simulation.target_volume() - 1) > most_volume_error)
        return fmt::format("volume off by {:.0f} % at step {}",
                           100 * (simulation.volume() / simulation.target_volume() - 1), k);
    }
    for (const Drop& drop : simulation.drops()) {
      std::vector<Drop> one;
      one.push_back(drop);
      const Inspection inspection = inspect(to_mesh_data(one));
      if (!inspection.sound) return "unsound: " + inspection.defects.front().message;
    }
  } catch (const Error& error) {
    return std::string("gave up: ") + error.what();
  }
  return {};
}

}  // namespace

int run_stress(int trials, unsigned seed) {
  std::size_t recoveries = 0;
  int failures = 0;
  for (int k = 0; k < trials; ++k) {
    Trial trial = random_trial(seed + static_cast<unsigned>(k));
    const std::string wrong = run_trial(trial, recoveries);
    if (wrong.empty()) continue;
    ++failures;
    fmt::print("--stress 1 --seed {}: {}: {}\n", seed + static_cast<unsigned>(k), trial.words, wrong);
    std::fflush(stdout);
  }
  fmt::print("{} random runs inside the safe region: {} failed, {} substeps were taken back and redone\n", trials,
             failures, recoveries);
  return failures == 0 ? 0 : 5;
}

}  // namespace meniscus::bench
