// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/rest.h"

#include "meniscus/core/error.h"
#include "meniscus/geometry/shapes.h"
#include "meniscus/simulation/simulation.h"
#include "meniscus/state/contact_line.h"
#include "references/drop_at_rest.h"
#include "support/process.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace meniscus::bench {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double height_of(const Drop& drop) {
  double top = 0;
  for (std::uint32_t v = 0; v < drop.num_rows(); ++v)
    if (drop.connectivity().degree(v) > 0) top = std::max(top, drop.positions()(2, v));
  return top;
}

double contact_radius_of(const Drop& drop) { return std::sqrt(wetted_area(drop) / pi); }

/// The contact angle of the cap of this volume and contact radius, by bisection: the radius falls as the angle grows.
double cap_angle(double volume, double contact_radius) {
  double low = 0.05, high = 3.0;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (references::spherical_cap(volume, middle).contact_radius > contact_radius ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

Scene scene_of(const RestCase& rest) {
  Scene scene = default_scene();
  scene.model = rest.level;
  scene.accuracy = rest.accuracy;
  scene.solids.emplace_back();
  scene.solids[0].advancing_angle = scene.solids[0].receding_angle = rest.angle;
  scene.time_step = rest.time_step;
  scene.mesh.edge_min = rest.edge_min;
  scene.mesh.edge_max = 3 * rest.edge_min;
  return scene;
}

Drop start_of(const RestCase& rest) {
  const double volume = 4 * pi / 3 * std::pow(rest.radius, 3);
  const double contact = rest.start_factor * references::spherical_cap(volume, rest.angle).contact_radius;
  const double angle = cap_angle(volume, contact);
  return Drop(make_cap({0, 0, 0}, {0, 0, 1}, references::spherical_cap(volume, angle).contact_radius, angle,
                       2 * rest.edge_min));
}

}  // namespace

RestRun run_to_rest(const RestCase& rest) {
  RestRun run;
  run.height_error = run.radius_error = nan;
  try {
    std::vector<Drop> drops;
    drops.push_back(start_of(rest));
    const double volume = drops.front().target_volume();
    Simulation simulation(scene_of(rest), std::move(drops));
    run.choice = simulation.choice();
    const double start = cpu_seconds();
    double height = 0, radius = 0, checked = 0;
    int still = 0;  // looks in a row at which nothing had moved: at one look it may just turn round
    while (simulation.time() < rest.longest && !run.rested) {
      simulation.step();
      if (simulation.drops().size() != 1) return run;
      if (simulation.time() < checked + 0.05) continue;
      checked = simulation.time();
      const Drop& drop = simulation.drops().front();
      const double new_height = height_of(drop), new_radius = contact_radius_of(drop);
      const bool moved = std::abs(new_height - height) > 1e-4 * height || std::abs(new_radius - radius) > 1e-4 * radius;
      still = moved ? 0 : still + 1;
      run.rested = still == 2;
      height = new_height;
      radius = new_radius;
    }
    run.cpu_seconds = cpu_seconds() - start;
    run.seconds = simulation.time();
    const Drop& drop = simulation.drops().front();
    const Scene scene = default_scene();
    const references::DropAtRest exact =
        references::drop_at_rest(volume, rest.angle, scene.gravity.norm(), scene.liquid, references::Hold::sessile);
    run.height_error = height_of(drop) / exact.height - 1;
    run.radius_error = contact_radius_of(drop) / exact.contact_radius - 1;
    run.triangles = static_cast<double>(drop.mesh().number_of_faces());
  } catch (const Error&) {
    run.rested = false;
  }
  return run;
}

}  // namespace meniscus::bench
