// SPDX-License-Identifier: GPL-3.0-or-later
// What the solver's tolerance does to the level "calibrated": mode 2 of a drop of R = 0.2 cm of water beside the same
// drop solved to 1e-10, and the iterations that it takes. bench_tolerance [--quick]
#include "meniscus/simulation/oscillation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

namespace {

using namespace meniscus;

struct Motion {
  std::vector<double> amplitudes;
  double iterations = 0;  ///< mean over the steps
  double volume_error = 0;
};

Motion oscillate(int frequency, double dt, int steps, double tolerance) {
  StepOptions options;
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

}  // namespace

int main(int argc, char** argv) {
  const bool quick = argc > 1 && std::strcmp(argv[1], "--quick") == 0;
  fmt::print("{:>9} {:>7} {:>10} {:>11} {:>14} {:>11}\n", "triangles", "1/dt", "tolerance", "iterations",
             "amplitude off", "volume off");
  for (const int frequency : {8, 16})
    for (const double rate : {960.0, 5000.0}) {
      if (quick && (frequency > 8 || rate > 1000)) continue;
      const int steps = static_cast<int>((quick ? 0.02 : 0.06) * rate);
      const Motion exact = oscillate(frequency, 1 / rate, steps, 1e-10);
      for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
        const Motion motion = oscillate(frequency, 1 / rate, steps, tolerance);
        fmt::print("{:>9} {:>7} {:>10.0e} {:>11.1f} {:>14.1e} {:>11.1e}\n", 20 * frequency * frequency, rate, tolerance,
                   motion.iterations, difference(motion, exact), motion.volume_error);
      }
    }
  return 0;
}
