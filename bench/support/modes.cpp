// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/modes.h"

#include "meniscus/core/error.h"
#include "meniscus/geometry/shapes.h"
#include "references/waves.h"
#include "support/process.h"

#include <cmath>
#include <limits>

namespace meniscus::bench {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN(), pi = 3.14159265358979323846;
constexpr double radius = 0.2, first_amplitude = 0.05;

double legendre(int mode, double cosine) { return std::legendre(static_cast<unsigned>(mode), cosine); }

}  // namespace

Drop drop_in_mode(int mode, int frequency, double ball_radius, double amplitude) {
  Mesh mesh = make_icosphere(Eigen::Vector3d::Zero(), ball_radius, frequency);
  Columns x = positions(mesh);
  for (Eigen::Index i = 0; i < x.cols(); ++i) x.col(i) *= 1 + amplitude * legendre(mode, x(2, i) / x.col(i).norm());
  return Drop(std::move(mesh));
}

double mode_amplitude(const Drop& drop, int mode) {
  SurfaceGeometry geometry;
  geometry.compute(drop.positions(), drop.connectivity());
  const ConstColumns x = drop.positions();
  const Eigen::Vector3d center = x.rowwise().mean();
  double projection = 0, norm = 0, mean = 0;
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i) {
    const Eigen::Vector3d r = x.col(i) - center;
    const double length = r.norm();
    if (!(length > 0)) continue;
    const double p = legendre(mode, r.z() / length), solid_angle = geometry.lumped_area(i) / (length * length);
    projection += solid_angle * length * p;
    norm += solid_angle * p * p;
    mean += solid_angle * length;
  }
  return projection / norm / (mean / (4 * pi));
}

ModeRun run_mode(int mode, int frequency, double dt, double periods, const StepOptions& options) {
  const double exact = references::rayleigh_frequency(mode, radius, options.liquid), period = 2 * pi / exact;
  const int steps = static_cast<int>(std::ceil(periods * period / dt));
  Drop drop = drop_in_mode(mode, frequency, radius, first_amplitude);
  const double volume = drop.volume();
  Remesher remesher;
  StepReport report;
  ModeRun run;
  double first = 0, last = 0, before = mode_amplitude(drop, mode), swing = std::abs(before), cpu = 0;
  std::vector<double> swings;
  try {
    for (int n = 1; n <= steps; ++n) {
      const double start = cpu_seconds();
      std::vector<Drop> pieces = step_drop(std::move(drop), {}, n * dt, dt, options, remesher, report);
      cpu += cpu_seconds() - start;
      if (pieces.size() != 1) return {nan, nan, nan, nan};
      drop = std::move(pieces.front());
      const double now = mode_amplitude(drop, mode);
      run.worst_volume_error = std::max(run.worst_volume_error, std::abs(drop.volume() / volume - 1));
      if (run.worst_volume_error > 0.5)  // the drop is gone: what swings is no mode of it
        return {nan, nan, cpu * period / (n * dt), run.worst_volume_error};
      if (before * now < 0) {
        last = (n - 1 + before / (before - now)) * dt;
        if (swings.empty()) first = last;
        swings.push_back(swing);
        swing = 0;
      }
      swing = std::max(swing, std::abs(now));
      before = now;
    }
  } catch (const Error&) {
    return {nan, nan, nan, nan};
  }
  const auto crossings = static_cast<double>(swings.size());
  run.frequency_error = crossings > 1 ? pi * (crossings - 1) / (last - first) / exact - 1 : nan;
  run.kept_per_period = swings.size() > 2 ? swings[2] / swings[0] : nan;
  run.cpu_per_period = cpu * period / (steps * dt);
  return run;
}

StepOptions inviscid_water(Level level) {
  StepOptions options;
  options.level = level;
  options.gravity.setZero();
  options.liquid.viscosity = 0;
  options.paper.damping_rate = options.paper.viscosity_coefficient = 0;
  options.remesh = false;
  return options;
}

}  // namespace meniscus::bench
