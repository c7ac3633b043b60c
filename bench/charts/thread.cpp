// SPDX-License-Identifier: GPL-3.0-or-later
// Rayleigh-Plateau: the growth of waves k r on a thread of water of r = 0.1 cm bent to a ring of 30 r, which is
// periodic without ends, beside Rayleigh's inviscid rate. A thread at rest with a wave of 1 % grows as cosh(rate t).
#include "charts.h"
#include "meniscus/core/error.h"
#include "meniscus/geometry/shapes.h"
#include "references/waves.h"
#include "support/levels.h"
#include "support/modes.h"
#include "support/process.h"

#include <cmath>
#include <limits>

namespace meniscus::bench {
namespace {

constexpr double radius = 0.1, ring = 30 * radius, first = 0.01, nan = std::numeric_limits<double>::quiet_NaN();

Drop wavy_ring(int waves, double edge) {
  Mesh mesh = make_torus(Eigen::Vector3d::Zero(), ring, radius, edge);
  for (const auto v : mesh.vertices()) {
    const Eigen::Vector3d x = to_eigen(mesh.point(v));
    const Eigen::Vector3d middle = ring * Eigen::Vector3d(x.x(), x.y(), 0).normalized();
    const double wave = 1 + first * std::cos(waves * std::atan2(x.y(), x.x()));
    mesh.point(v) = to_point(middle + wave * (x - middle));
  }
  return Drop(std::move(mesh));
}

/// The wave's amplitude over r: the projection of the distance from the ring's
/// axis. The ring may shrink meanwhile.
double amplitude(const Drop& drop, int waves) {
  SurfaceGeometry geometry;
  geometry.compute(drop.positions(), drop.connectivity());
  const ConstColumns x = drop.positions();
  double axis = 0, area = 0;
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i) {
    axis += geometry.lumped_area(i) * std::hypot(x(0, i), x(1, i));
    area += geometry.lumped_area(i);
  }
  axis /= area;
  double projection = 0, norm = 0;
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i) {
    const double angle = waves * std::atan2(x(1, i), x(0, i)), weight = geometry.lumped_area(i);
    const double distance = std::hypot(std::hypot(x(0, i), x(1, i)) - axis, x(2, i));
    projection += weight * distance * std::cos(angle);
    norm += weight * std::cos(angle) * std::cos(angle);
  }
  return projection / norm / radius;
}

double area_of(const Drop& drop) {
  SurfaceGeometry geometry;
  geometry.compute(drop.positions(), drop.connectivity());
  return geometry.area();
}

struct Growth {
  double rate = nan, cpu_seconds = 0;
};

/// Until the wave is three times as high, or Rayleigh's would be twenty times. NaN if it does not grow so far, or not
/// as cosh(rate t), or the area does, which a wave of this kind shrinks: then something else grows there.
Growth measure(const NamedLevel& level, int waves, double edge, VolumeCorrectionMethod correction) {
  StepOptions options = inviscid_water(level.level);
  options.volume_correction = correction;
  const double unit = std::sqrt(options.liquid.density * std::pow(radius, 3) / options.liquid.surface_tension);
  const double exact = references::rayleigh_plateau_growth(waves * radius / ring, radius, options.liquid);
  const double dt = 0.02 * unit;
  Growth growth;
  try {
    Drop drop = wavy_ring(waves, edge);
    const double start = amplitude(drop, waves), area = area_of(drop), begin = cpu_seconds();
    double early = nan;
    Remesher remesher;
    StepReport report;
    for (int n = 1; n * dt * exact < std::acosh(20.0); ++n) {
      std::vector<Drop> pieces = step_drop(std::move(drop), {}, n * dt, dt, options, remesher, report);
      if (pieces.size() != 1) return {};
      drop = std::move(pieces.front());
      const double ratio = amplitude(drop, waves) / start;
      if (ratio < 1.5) continue;
      const double rate = std::acosh(ratio) / (n * dt) * unit;
      if (std::isnan(early)) early = rate;
      if (ratio < 3) continue;
      if (ratio < 4 && std::abs(early / rate - 1) < 0.3 && area_of(drop) < area) growth.rate = rate;
      break;
    }
    growth.cpu_seconds = cpu_seconds() - begin;
  } catch (const Error&) {
  }
  return growth;
}

}  // namespace

ChartTable thread_chart(bool quick) {
  ChartTable table("thread",
                   "Growth of waves on a thread in units of sqrt(sigma/(rho r^3)), beside Rayleigh's inviscid rate",
                   {"level", "kr", "rate", "exact", "error", "cpu_seconds"});
  const struct {
    const char* name;
    VolumeCorrectionMethod method;
  } corrections[] = {{"", VolumeCorrectionMethod::global}, {" (local)", VolumeCorrectionMethod::local_then_global}};
  Liquid unit;
  unit.surface_tension = 1;
  for (const NamedLevel& level : levels)
    for (const auto& correction : corrections)
      for (const int waves : {9, 15, 21, 27}) {
        const bool local = correction.method != VolumeCorrectionMethod::global;
        if (local && level.level == Level::pressure) continue;  // it has none
        if (quick && (waves != 21 || local)) continue;
        const double kr = waves * radius / ring;
        const Growth growth = measure(level, waves, quick ? 0.1 : 0.05, correction.method);
        const double exact = references::rayleigh_plateau_growth(kr, 1, unit);
        table.add({std::string(level.name) + correction.name, kr, growth.rate, exact, growth.rate / exact - 1,
                   growth.cpu_seconds});
      }
  return table;
}

}  // namespace meniscus::bench
