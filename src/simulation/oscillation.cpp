// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/simulation/oscillation.h"

#include "meniscus/geometry/shapes.h"

#include <Eigen/QR>

#include <cmath>
#include <limits>

namespace meniscus {
namespace {

using Eigen::Vector3d;

double legendre_two(double cosine) { return 0.5 * (3 * cosine * cosine - 1); }

}  // namespace

Drop oscillating_drop(int frequency, double radius, double amplitude) {
  Mesh mesh = make_icosphere(Vector3d::Zero(), radius, frequency);
  Columns x = positions(mesh);
  for (Eigen::Index i = 0; i < x.cols(); ++i) x.col(i) *= 1 + amplitude * legendre_two(x(2, i) / x.col(i).norm());
  return Drop(std::move(mesh));
}

double mode_two_amplitude(const Drop& drop) {
  SurfaceGeometry geometry;
  geometry.compute(drop.positions(), drop.connectivity());
  const ConstColumns x = drop.positions();
  const Vector3d center = x.rowwise().mean();
  double projection = 0, norm = 0, radius = 0;
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i) {
    const Vector3d r = x.col(i) - center;
    const double length = r.norm();
    if (!(length > 0)) continue;
    const double p2 = legendre_two(r.z() / length),
                 weight = geometry.lumped_area(i) / (length * length);  // solid angle
    projection += weight * length * p2;
    norm += weight * p2 * p2;
    radius += weight * length;
  }
  return projection / norm / (radius / (4 * M_PI));
}

Swing fit_swing(const std::vector<double>& samples, double dt) {
  const auto n = static_cast<Eigen::Index>(samples.size()) - 2;
  Eigen::MatrixX3d known(n, 3);
  Eigen::VectorXd next(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    known.row(i) << samples[k + 1], -samples[k], 1;
    next[i] = samples[k + 2];
  }
  const Eigen::Vector3d abc = known.colPivHouseholderQr().solve(next);
  const double cosine = abc[0] / (2 * std::sqrt(abc[1]));
  if (!(std::abs(cosine) < 1)) return {};
  const double phase = std::acos(cosine);
  return {phase / dt, std::pow(abc[1], M_PI / phase)};
}

OscillationResult measure_oscillation(int frequency, double amplitude, double dt, int steps,
                                      const StepOptions& options) {
  const double radius = 0.2;
  OscillationResult result;
  result.rayleigh = std::sqrt(8 * options.liquid.surface_tension / (options.liquid.density * std::pow(radius, 3)));
  Drop drop = oscillating_drop(frequency, radius, amplitude);
  Remesher remesher;
  StepReport report;
  double first = 0, last = 0, before = mode_two_amplitude(drop), swing = std::abs(before);
  int crossings = 0;
  std::vector<double> swings;
  for (int n = 1; n <= steps; ++n) {
    drop = std::move(step_drop(std::move(drop), {}, n * dt, dt, options, remesher, report).front());
    const double now = mode_two_amplitude(drop);
    if (before * now < 0) {
      last = (n - 1 + before / (before - now)) * dt;
      if (crossings++ == 0) first = last;
      swings.push_back(swing);
      swing = 0;
    }
    swing = std::max(swing, std::abs(now));
    before = now;
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  result.angular_frequency = crossings > 1 ? M_PI * (crossings - 1) / (last - first) : nan;
  result.kept_per_period = swings.size() > 2 ? swings[2] / swings[0] : nan;
  return result;
}

}  // namespace meniscus
