// SPDX-License-Identifier: GPL-3.0-or-later
// What the level "calibrated" gets right, against closed forms: mode 2 beside Rayleigh (of "pressure", too), the
// volume after 10,000 steps, drops at rest beside Young-Laplace. Prints tables. --quick: a short run, so that it cannot
// rot.
#include "meniscus/simulation/oscillation.h"
#include "meniscus/simulation/simulation.h"
#include "meniscus/state/contact_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace {

using namespace meniscus;

constexpr double degree = pi / 180;

StepOptions inviscid(Level level) {
  StepOptions options;
  options.level = level;
  options.gravity.setZero();
  options.liquid.viscosity = 0;
  options.remesh = false;
  return options;
}

void print_oscillation(const char* name, Level level, bool quick) {
  fmt::print("Mode 2 at the level {}, 5 %, R = 0.2 cm, water without viscosity, no remeshing\n", name);
  fmt::print("{:>9} {:>8} {:>12} {:>10} {:>16}\n", "vertices", "dt", "omega, 1/s", "error, %", "kept a period");
  for (const int frequency : {8, 16, 32}) {
    if (quick && frequency > 8) break;
    for (const double rate : {5000.0, 2000.0, 960.0, 480.0}) {
      const int steps = static_cast<int>(0.08 * rate);
      const OscillationResult result = measure_oscillation(frequency, 0.05, 1 / rate, steps, inviscid(level));
      fmt::print("{:>9} {:>8} {:>12.2f} {:>10.2f} {:>16.3f}\n", 10 * frequency * frequency + 2,
                 fmt::format("1/{}", rate), result.angular_frequency,
                 100 * (result.angular_frequency / result.rayleigh - 1), result.kept_per_period);
    }
  }
}

void print_drift(bool quick) {
  const StepOptions options = inviscid(Level::calibrated);
  Drop drop = oscillating_drop(quick ? 8 : 16, 0.2, 0.05);
  Remesher remesher;
  StepReport report;
  const int steps = quick ? 500 : 10000;
  for (int n = 1; n <= steps; ++n)
    drop = std::move(step_drop(std::move(drop), {}, n / 5000.0, 1.0 / 5000, options, remesher, report).front());
  fmt::print("\nVolume after {} steps of 1/5000 s: relative drift {:.1e}, worst in any step {:.1e}\n", steps,
             std::abs(drop.volume() / drop.target_volume() - 1), report.worst_volume_error);
}

/// Young-Laplace for the volume of a ball of R = 0.2 cm of water, g = 981: the sources of data/scenes/resting_*.
struct Resting {
  double angle, height, radius;
};
constexpr Resting resting[] = {
    {60, 0.167592241, 0.334000777}, {90, 0.225321022, 0.267454373}, {120, 0.274691987, 0.209967817}};

void print_rest(const Resting& exact, double edge_min, double rate) {
  Scene scene = default_scene();
  scene.solids.emplace_back();
  scene.solids[0].advancing_angle = scene.solids[0].receding_angle = exact.angle * degree;
  scene.time_step = 1 / rate;
  scene.mesh.edge_min = edge_min;
  scene.mesh.edge_max = 3 * edge_min;
  scene.drops.emplace_back();
  scene.drops[0].center = Eigen::Vector3d(0, 0, 0.2);
  Simulation simulation(scene);
  StepReport last;
  while (simulation.time() < 0.8) last = simulation.step();
  const Drop& drop = simulation.drops().front();
  double top = 0, speed = 0;
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i) {
    if (drop.connectivity().degree(i) == 0) continue;
    top = std::max(top, drop.positions()(2, i));
    speed = std::max(speed, drop.velocities().col(i).norm());
  }
  // What the mesh of the ball holds is less than the ball: compare lengths at equal volume.
  const double scale = std::cbrt(drop.target_volume() / (4.0 / 3 * pi * 0.008));
  fmt::print("{:>6} {:>9} {:>8} {:>10} {:>10.2f} {:>10.2f} {:>12.1e} {:>10.1f}\n", exact.angle, edge_min,
             fmt::format("1/{}", rate), drop.mesh().number_of_faces(), 100 * (top / exact.height / scale - 1),
             100 * (std::sqrt(wetted_area(drop) / pi) / exact.radius / scale - 1), speed,
             mean_contact_angle(drop).value_or(0) / degree);
}

}  // namespace

int main(int argc, char** argv) {
  const bool quick = argc > 1 && std::strcmp(argv[1], "--quick") == 0;
  print_oscillation("calibrated", Level::calibrated, quick);
  print_oscillation("pressure", Level::pressure, quick);
  print_drift(quick);
  fmt::print("\nAt rest after 0.8 s, R = 0.2 cm, water, remeshing on, against Young-Laplace\n");
  fmt::print("{:>6} {:>9} {:>8} {:>10} {:>10} {:>10} {:>12} {:>10}\n", "angle", "edge_min", "dt", "triangles",
             "height, %", "radius, %", "speed, cm/s", "by normals");
  for (const Resting& exact : resting)
    for (const double edge_min : {0.04, 0.02, 0.01})
      for (const double rate : {960.0, 240.0})
        if (!quick || (edge_min == 0.04 && rate == 240)) print_rest(exact, edge_min, rate);
}
