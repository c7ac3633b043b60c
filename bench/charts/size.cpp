// SPDX-License-Identifier: GPL-3.0-or-later
// Cost against size: processor time of a step of one drop of 1K to 200K triangles, and of 1 to 1,000 drops of 50K
// triangles in all, each a ball of water in free fall, swinging in mode 2, remeshing on. Edges in the middle of the
// band, time step so that omega dt = 0.1.
#include "charts.h"
#include "meniscus/geometry/measure.h"
#include "references/waves.h"
#include "support/levels.h"
#include "support/modes.h"
#include "support/process.h"

#include <fmt/format.h>

#include <cmath>

namespace meniscus::bench {
namespace {

/// CPU seconds of a step of `drops` equal drops on one thread: the least of
/// `repeats` after two to warm up.
double step_seconds(Level level, int frequency, int num_drops, int repeats, double& triangles) {
  const double radius = 0.2;
  StepOptions options;
  options.level = level;
  const double dt = 0.1 / references::rayleigh_frequency(2, radius, options.liquid);
  std::vector<Drop> drops(static_cast<std::size_t>(num_drops), drop_in_mode(2, frequency, radius, 0.05));
  const EdgeLengths edges = edge_lengths(drops.front().mesh());
  options.band.edge_min = 0.5 * edges.mean;
  options.band.edge_max = 1.5 * edges.mean;
  Remesher remesher;
  double least = 1e300;
  for (int n = 1; n <= repeats + 2; ++n) {
    StepReport report;
    const double start = cpu_seconds();
    for (Drop& drop : drops)
      drop = std::move(step_drop(std::move(drop), {}, n * dt, dt, options, remesher, report).front());
    if (n > 2) least = std::min(least, cpu_seconds() - start);
  }
  triangles = 0;
  for (const Drop& drop : drops) triangles += static_cast<double>(drop.mesh().number_of_faces());
  return least;
}

/// The slope of log y over log x by least squares.
double exponent(const std::vector<double>& x, const std::vector<double>& y) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  const auto n = static_cast<double>(x.size());
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double a = std::log(x[k]), b = std::log(y[k]);
    sx += a;
    sy += b;
    sxx += a * a;
    sxy += a * b;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

}  // namespace

ChartTable size_chart(bool quick) {
  ChartTable table("size",
                   "Processor time of a step on one thread; exponent is the "
                   "fit over one drop's sizes",
                   {"level", "what", "drops", "triangles", "step_seconds", "ns_per_triangle", "exponent"});
  for (const NamedLevel& level : levels) {
    std::vector<double> sizes, seconds;
    for (const int frequency : {7, 16, 32, 51, 71, 100}) {
      if (quick && frequency > 16) continue;
      double triangles = 0;
      const double step = step_seconds(level.level, frequency, 1, quick ? 2 : 6, triangles);
      sizes.push_back(triangles);
      seconds.push_back(step);
    }
    const double slope = exponent(sizes, seconds);
    for (std::size_t k = 0; k < sizes.size(); ++k)
      table.add({std::string(level.name), std::string("one drop"), 1.0, sizes[k], seconds[k],
                 1e9 * seconds[k] / sizes[k], slope});
    for (const auto& [drops, frequency] : {std::pair{1, 50}, {10, 16}, {100, 5}, {1000, 2}}) {
      if (quick && drops != 10) continue;
      double triangles = 0;
      const double step = step_seconds(level.level, frequency, drops, quick ? 1 : 6, triangles);
      table.add({std::string(level.name), std::string("many drops"), double(drops), triangles, step,
                 1e9 * step / triangles, slope});
    }
  }
  return table;
}

}  // namespace meniscus::bench
