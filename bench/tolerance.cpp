// SPDX-License-Identifier: GPL-3.0-or-later
// What the solver's tolerance does to the levels: mode 2 of a drop of R = 0.2 cm of water beside the same drop solved
// as tightly as the level goes, and the iterations that it takes. Writes tolerance.csv and .json into docs/charts, or,
// with --quick (a few rows), nowhere, unless a directory is given. bench_tolerance [--quick] [--out DIRECTORY]
#include "meniscus/core/error.h"
#include "meniscus/simulation/oscillation.h"
#include "support/chart_table.h"
#include "support/levels.h"
#include "support/run_bench.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace {

using namespace meniscus;
using namespace meniscus::bench;

constexpr const char* usage = "bench_tolerance [--quick] [--out DIRECTORY]";

struct Motion {
  std::vector<double> amplitudes;
  double iterations = 0;  ///< mean over the steps
  double volume_error = 0;
};

Motion oscillate(Level level, int frequency, double dt, int steps, double tolerance) {
  StepOptions options;
  options.level = level;
  options.gravity.setZero();
  options.remesh = false;
  options.solver.tolerance = tolerance;
  Drop drop = oscillating_drop(frequency, 0.2, 0.05);
  Remesher remesher;
  Motion motion;
  for (int n = 1; n <= steps; ++n) {
    StepReport report;
    drop = std::move(step_drop(std::move(drop), {}, n * dt, dt, options, remesher, report).front());
    motion.amplitudes.push_back(mode_two_amplitude(drop));
    motion.iterations += static_cast<double>(report.solver_iterations) / steps;
    motion.volume_error = std::max(motion.volume_error, report.worst_volume_error);
  }
  return motion;
}

/// The largest difference of the amplitudes, in parts of the first one.
double difference(const Motion& a, const Motion& b) {
  double most = 0;
  for (std::size_t k = 0; k < a.amplitudes.size(); ++k)
    most = std::max(most, std::abs(a.amplitudes[k] - b.amplitudes[k]));
  return most / 0.05;
}

ChartTable measure(bool quick) {
  ChartTable table("tolerance", "Mode 2 of a ball of water, R = 0.2 cm, beside the same solved to 1e-10",
                   {"level", "triangles", "time_step", "tolerance", "iterations", "amplitude_off", "volume_error"});
  for (const NamedLevel& level : levels)
    for (const int frequency : {8, 16})
      for (const double rate : {960.0, 5000.0}) {
        if (quick && (frequency > 8 || rate > 1000)) continue;
        const int steps = static_cast<int>((quick ? 0.02 : 0.06) * rate);
        const Motion exact = oscillate(level.level, frequency, 1 / rate, steps, 1e-10);
        for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
          const Motion motion = oscillate(level.level, frequency, 1 / rate, steps, tolerance);
          table.add({std::string(level.name), 20.0 * frequency * frequency, 1 / rate, tolerance, motion.iterations,
                     difference(motion, exact), motion.volume_error});
        }
      }
  return table;
}

int run(const ChartArguments& arguments) {
  const ChartTable table = measure(arguments.quick);
  if (const auto directory = arguments.directory()) table.write(*directory);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return run_bench(argc, argv, usage, [&] { return run(chart_arguments(argc, argv, usage)); });
}
