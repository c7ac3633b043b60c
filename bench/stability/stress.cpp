// SPDX-License-Identifier: GPL-3.0-or-later
#include "stress.h"

#include "../../tests/support/random_shapes.h"
#include "meniscus/core/error.h"
#include "meniscus/geometry/inspect.h"
#include "meniscus/simulation/check_frame.h"
#include "meniscus/simulation/safe_time_step.h"
#include "meniscus/simulation/simulation.h"
#include "support/levels.h"
#include "support/process.h"
#include "test_meshes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace meniscus::bench {
namespace {

using random_shapes::Numbers;
constexpr int num_steps = 8;
constexpr double most_volume_error = 0.05;
constexpr double most_weber = 5;  // rho v^2 2 R/sigma of an impact; beyond, levels fail at every time step
constexpr double shortest_step = 1.0 / 4800, longest_step = 1.0 / 15;  // s

struct Trial {
  Scene scene;
  std::vector<Drop> drops;
  std::size_t level = 0;  ///< in `levels`
  std::string words;
};

/// How a trial ended.
enum class Ending {
  held,
  gave_up,  ///< by a clear error, exit code 5
  garbage,  ///< frames that are wrong without a word: not finite, volume lost, unsound
  slow,     ///< not done within the limit of processor time
};
constexpr std::size_t num_endings = 4;

struct Outcome {
  Ending ending = Ending::held;
  std::string wrong;           ///< in words; "" if it held
  std::size_t recoveries = 0;  ///< substeps that were taken back and done again in halves
};

/// Log-uniform inside the safe region, down to 1/4800 s, or beyond it, up to 30 times.
double random_time_step(Numbers& numbers, double safe, bool outside) {
  const double longest = std::min(safe, longest_step), shortest = std::min(shortest_step, 0.5 * longest);
  const double share = numbers.between(0, 1);
  if (outside) return safe * std::pow(30, share);
  return shortest * std::pow(longest / shortest, share);
}

Trial random_trial(unsigned seed, bool outside) {
  Numbers numbers(seed);
  Trial trial;
  Scene& scene = trial.scene;
  scene = default_scene();
  trial.level = static_cast<std::size_t>(numbers.below(static_cast<int>(std::size(levels))));
  scene.model = levels[trial.level].level;
  const double radius = numbers.log_between(0.05, 0.3), edge = radius * numbers.between(0.12, 0.35);
  scene.mesh = {0.5 * edge, 1.5 * edge, 0.5, 1};
  scene.liquid.surface_tension = numbers.log_between(10, 500);
  scene.liquid.viscosity = numbers.log_between(1e-3, 1);
  scene.paper.curvature_flow_coefficient = numbers.log_between(0.02, 0.5);
  const auto quality = static_cast<Quality>(numbers.below(static_cast<int>(quality_names.size())));
  const double gentle = std::sqrt(most_weber * scene.liquid.surface_tension / (scene.liquid.density * 2 * radius));
  const double speed = numbers.between(0, std::min(40.0, gentle));
  const bool paper = scene.model == Level::paper;
  const int where = paper ? 0 : numbers.below(3);  // on solids the paper's level has no safe region
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
  const double safe = safe_time_step(make_step_options(scene), trial.drops, {});
  scene.time_step = random_time_step(numbers, safe, outside);
  constexpr const char* places[] = {"air", "plane", "sphere"};
  trial.words =
      fmt::format("{} {} {} R {:.3f} edge {:.3f} sigma {:.0f} speed {:.0f} dt {:.2e} ({:.2g} of the safe one)",
                  levels[trial.level].name, places[where], quality_names[static_cast<std::size_t>(quality)], radius,
                  edge, scene.liquid.surface_tension, speed, scene.time_step, scene.time_step / safe);
  return trial;
}

/// What a frame shows that is wrong, or "".
std::string defect_of(const Simulation& simulation) {
  const double volume = simulation.volume();
  if (!std::isfinite(volume)) return "not finite";
  if (std::abs(volume / simulation.target_volume() - 1) > most_volume_error)
    return fmt::format("volume off by {:.0f} %", 100 * (volume / simulation.target_volume() - 1));
  for (const Drop& drop : simulation.drops()) {
    std::vector<Drop> one;
    one.push_back(drop);
    const Inspection inspection = inspect(to_mesh_data(one));
    if (!inspection.sound) return "unsound: " + inspection.defects.front().message;
  }
  return {};
}

/// As `evolve` runs it: outside of the safe region each frame, here the last step, is checked.
Outcome run_trial(Trial& trial, bool outside, double limit) {
  Outcome outcome;
  const double start = cpu_seconds();
  try {
    Simulation simulation(trial.scene, std::move(trial.drops));
    for (int k = 0; k < num_steps; ++k) {
      outcome.recoveries += simulation.step().recoveries;
      if (cpu_seconds() - start < limit) continue;
      outcome.ending = Ending::slow;
      outcome.wrong = fmt::format("given up after {} of {} steps in {:.0f} s", k + 1, num_steps, cpu_seconds() - start);
      return outcome;
    }
    if (outside) check_frame(simulation.drops(), true);
    outcome.wrong = defect_of(simulation);
    if (!outcome.wrong.empty()) outcome.ending = Ending::garbage;
  } catch (const Error& error) {
    outcome.wrong = std::string("gave up: ") + error.what();
    outcome.ending = Ending::gave_up;
  }
  return outcome;
}

}  // namespace

int run_stress(int trials, unsigned seed, bool outside, double limit) {
  std::array<std::array<int, num_endings>, std::size(levels)> count{};
  std::array<int, std::size(levels)> recovered{};  // runs
  int failures = 0;
  for (int k = 0; k < trials; ++k) {
    Trial trial = random_trial(seed + static_cast<unsigned>(k), outside);
    const Outcome outcome = run_trial(trial, outside, limit);
    ++count[trial.level][static_cast<std::size_t>(outcome.ending)];
    if (outcome.recoveries > 0) ++recovered[trial.level];
    if (outcome.ending == Ending::held || (outside && outcome.ending == Ending::gave_up)) continue;
    if (outcome.ending != Ending::slow) ++failures;
    fmt::print("--stress 1 --seed {}{}: {}: {}\n", seed + static_cast<unsigned>(k), outside ? " --outside" : "",
               trial.words, outcome.wrong);
    std::fflush(stdout);
  }
  fmt::print("{} random runs {} the safe region\n", trials, outside ? "outside" : "inside");
  for (std::size_t l = 0; l < count.size(); ++l)
    fmt::print(
        "{}: {} held, {} gave up with an error, {} were wrong without a word, {} were not done in time; {} of all "
        "recovered from bad substeps\n",
        levels[l].name, count[l][0], count[l][1], count[l][2], count[l][3], recovered[l]);
  return failures == 0 ? 0 : 5;
}

}  // namespace meniscus::bench
