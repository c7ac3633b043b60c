// SPDX-License-Identifier: GPL-3.0-or-later
// What the level "auto" takes for each accuracy, beside the levels themselves at the scene's time step: a ball of water
// that swings in the air and drops that come to rest on a plane, their errors and processor seconds. Writes auto.csv
// and .json into docs/charts, or, with --quick (fewer scenes), nowhere, unless a directory is given. Exits with 5 if
// what is said to reach an accuracy does not.
//
//   bench_auto [--quick] [--out DIRECTORY]
#include "meniscus/core/error.h"
#include "meniscus/simulation/oscillation.h"
#include "meniscus/simulation/simulation.h"
#include "references/waves.h"
#include "support/chart_table.h"
#include "support/levels.h"
#include "support/modes.h"
#include "support/process.h"
#include "support/rest.h"
#include "support/run_bench.h"

#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <limits>

namespace {

using namespace meniscus;
using namespace meniscus::bench;

constexpr const char* usage = "bench_auto [--quick] [--out DIRECTORY]";
constexpr double nan = std::numeric_limits<double>::quiet_NaN(), radius = 0.2;

/// What a scene is run with: an accuracy, or a level at the scene's time step.
struct Asked {
  std::string name;
  std::optional<Accuracy> accuracy;
  Level level = Level::calibrated;
};

std::vector<Asked> all_asked() {
  std::vector<Asked> all;
  for (const Accuracy accuracy : {Accuracy::look, Accuracy::shape, Accuracy::motion})
    all.push_back({std::string("auto ") + accuracy_name(accuracy), accuracy});
  for (const NamedLevel& level : levels) all.push_back({level.name, std::nullopt, level.level});
  return all;
}

class Comparison {
 public:
  Comparison()
      : table_("auto", "What the level auto takes, and the levels at the scene's time step of 1/240 s",
               {"scene", "asked", "level", "substeps", "frequency_error", "kept_per_period", "height_error",
                "contact_radius_error", "said_to_be_met", "cpu_seconds"}) {}

  /// Mode 2 at 5 % in the air, 0.1 s; water without viscosity, so that the amplitude ought to stay.
  void swing(const Asked& asked, int frequency) {
    Scene scene = default_scene();
    scene.accuracy = asked.accuracy;
    scene.model = asked.level;
    scene.gravity.setZero();
    scene.liquid.viscosity = scene.paper.viscosity_coefficient = scene.paper.damping_rate = 0;
    const double edge = radius * 1.2 / frequency;
    scene.mesh = {0.5 * edge, 1.5 * edge, 0.5, 1};
    std::vector<Drop> drops;
    drops.push_back(drop_in_mode(2, frequency, radius, 0.05));
    Simulation simulation(scene, std::move(drops));
    std::vector<double> amplitudes;
    const double start = cpu_seconds();
    while (simulation.time() < 0.1) {
      amplitudes.push_back(mode_amplitude(simulation.drops().front(), 2));
      simulation.step();
    }
    const double seconds = cpu_seconds() - start;
    const Swing found = fit_swing(amplitudes, scene.time_step);
    const double error = found.angular_frequency / references::rayleigh_frequency(2, radius, scene.liquid) - 1;
    const ModelChoice& choice = simulation.choice();
    add(fmt::format("swing of {} triangles", 20 * frequency * frequency), asked, choice,
        {error, found.kept_per_period, nan, nan}, seconds);
    if (!asked.accuracy || !choice.is_met) return;
    const AccuracyTarget target = target_of(*asked.accuracy);
    check(error, target.frequency_error, asked);
    check(found.kept_per_period - 1, target.amplitude_error, asked);
  }

  void rest(const Asked& asked, RestCase rest) {
    rest.level = asked.level;
    rest.accuracy = asked.accuracy;
    rest.longest = 1;  // "paper" goes on creeping
    const RestRun run = run_to_rest(rest);
    add(fmt::format("rest at {:.0f} degrees R {} edge_min {:.3g}", rest.angle * 180 / pi, rest.radius, rest.edge_min),
        asked, run.choice, {nan, nan, run.height_error, run.radius_error}, run.cpu_seconds);
    if (!asked.accuracy || !run.choice.is_met) return;
    const double most = target_of(*asked.accuracy).rest_error;
    check(run.height_error, most, asked);
    check(run.radius_error, most, asked);
  }

  const ChartTable& table() const { return table_; }
  bool is_as_said() const { return is_as_said_; }

 private:
  void add(const std::string& scene, const Asked& asked, const ModelChoice& choice, const std::array<double, 4>& errors,
           double seconds) {
    table_.add({scene, asked.name, std::string(level_name(choice.level)), double(choice.substeps), errors[0], errors[1],
                errors[2], errors[3],
                std::string(!asked.accuracy ? ""
                            : choice.is_met ? "yes"
                                            : "no"),
                seconds});
  }
  void check(double error, double most, const Asked& asked) {
    if (std::isinf(most) || std::abs(error) <= most) return;
    is_as_said_ = false;
    table_.note(fmt::format("{}: {:.2g} is more than {:.2g}", asked.name, error, most));
  }

  ChartTable table_;
  bool is_as_said_ = true;
};

int run(const ChartArguments& arguments) {
  const oneapi::tbb::global_control one_thread(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  Comparison comparison;
  for (const int frequency : {8, 16})
    for (const Asked& asked : all_asked())
      if (!arguments.quick || (frequency == 8 && asked.accuracy)) comparison.swing(asked, frequency);
  for (const double angle : {60.0, 90.0, 120.0})
    for (const auto& [size, share] : {std::pair{0.2, 0.1}, {0.1, 0.2}, {0.3, 0.2}})
      for (const Asked& asked : all_asked()) {
        if (arguments.quick && (angle != 90 || !asked.accuracy || share > 0.1)) continue;
        RestCase rest;
        rest.radius = size;
        rest.angle = angle * pi / 180;
        rest.edge_min = share * size;
        comparison.rest(asked, rest);
      }
  if (const auto directory = arguments.directory()) comparison.table().write(*directory);
  return comparison.is_as_said() ? 0 : 5;
}

}  // namespace

int main(int argc, char** argv) {
  return run_bench(argc, argv, usage, [&] { return run(chart_arguments(argc, argv, usage)); });
}
