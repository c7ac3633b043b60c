// SPDX-License-Identifier: GPL-3.0-or-later
// How well the level "pressure" holds drops on a tilted pane with contact angle hysteresis (30 and 90 degrees):
// the tilt at which they start to slide, beside Furmidge's form and its pi/4 variant, and how far a drop that
// should stay creeps on the upright pane. Prints tables. --quick: a short run, so that it cannot rot.
#include "meniscus/geometry/measure.h"
#include "meniscus/simulation/simulation.h"
#include "meniscus/state/contact_line.h"
#include "references/drop_at_rest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace {

using namespace meniscus;
using Eigen::Vector3d;

constexpr double degree = pi / 180;
constexpr double receding = 30 * degree, advancing = 90 * degree;

Scene pane(double theta_r, double theta_a, double radius, double deposited, double edge_min) {
  Scene scene = default_scene();
  scene.model = Level::pressure;
  scene.mesh.edge_min = edge_min;
  scene.mesh.edge_max = 3 * edge_min;
  scene.time_step = 1.0 / 240;
  scene.solids.emplace_back();
  scene.solids[0].name = "pane";
  scene.solids[0].receding_angle = theta_r;
  scene.solids[0].advancing_angle = theta_a;
  scene.drops.emplace_back();
  scene.drops[0].shape = DropShape::cap;
  scene.drops[0].on = "pane";
  scene.drops[0].radius = radius;
  scene.drops[0].angle = deposited;
  return scene;
}

/// At rest on the level pane at the angle, without hysteresis.
Drop deposit(double radius, double deposited, double edge_min) {
  Simulation simulation(pane(deposited, deposited, radius, deposited, edge_min));
  while (simulation.time() < 0.5) simulation.step();
  return simulation.drops().front();
}

/// The uphill end of the contact line (cm): it moves when the drop slides, not when only its front spreads.
double rear(const Drop& drop) {
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t v = 0; v < drop.num_rows(); ++v)
    if (drop.connectivity().degree(v) > 0 && drop.contact()[v] == Contact::line)
      least = std::min(least, drop.positions()(0, v));
  return least;
}

struct Slide {
  double tilt;  ///< radians; NaN if it never slid
  double triangles;
};

/// Tilts the pane by `rate` (radians/s) until the rear of the contact line has moved by a quarter of R.
Slide tilt_until_it_slides(double radius, double deposited, double edge_min, double rate) {
  Drop drop = deposit(radius, deposited, edge_min);
  const Scene scene = pane(receding, advancing, radius, deposited, edge_min);
  StepOptions options = make_step_options(scene);
  const std::vector<Solid> solids = make_solids(scene);
  Remesher remesher;
  StepReport report;
  const double dt = scene.time_step, start = rear(drop);
  for (int n = 1; n * dt * rate < pi / 2; ++n) {
    const double tilt = n * dt * rate;
    options.gravity = 981 * Vector3d(std::sin(tilt), 0, -std::cos(tilt));
    drop = std::move(step_drop(std::move(drop), solids, n * dt, dt, options, remesher, report).front());
    if (rear(drop) - start > 0.25 * radius) return {tilt, static_cast<double>(drop.mesh().number_of_faces())};
  }
  return {std::nan(""), static_cast<double>(drop.mesh().number_of_faces())};
}

void print_critical_tilt(double radius, double deposited, double edge_min, double rate) {
  const Slide slide = tilt_until_it_slides(radius, deposited, edge_min, rate);
  const double volume = 4.0 / 3 * pi * std::pow(radius, 3);
  const auto exact = [&](references::RetentionForm form) {
    return references::critical_tilt(form, volume, deposited, advancing, receding, 981, Liquid{}) / degree;
  };
  fmt::print("{:>6} {:>10.0f} {:>9} {:>10.0f} {:>12.1f} {:>10.1f} {:>10.1f}\n", radius, deposited / degree, edge_min,
             slide.triangles, slide.tilt / degree, exact(references::RetentionForm::quarter_pi),
             exact(references::RetentionForm::furmidge));
}

/// On the upright pane: how far the centre of mass goes between 1 s and the end.
void print_creep(double radius, double deposited, double edge_min, double seconds) {
  Scene scene = pane(receding, advancing, radius, deposited, edge_min);
  scene.gravity = Vector3d(981, 0, 0);
  std::vector<Drop> drops;
  drops.push_back(deposit(radius, deposited, edge_min));
  Simulation simulation(scene, std::move(drops));
  while (simulation.time() < 0.2 * seconds) simulation.step();
  const Vector3d before = solid_centroid(simulation.drops().front().mesh());
  while (simulation.time() < seconds) simulation.step();
  const Vector3d after = solid_centroid(simulation.drops().front().mesh());
  fmt::print("{:>6} {:>10.0f} {:>9} {:>16.2e}\n", radius, deposited / degree, edge_min, (after - before).norm());
}

}  // namespace

int main(int argc, char** argv) {
  const bool quick = argc > 1 && std::strcmp(argv[1], "--quick") == 0;
  fmt::print("Tilt at which a drop of water starts to slide, degrees; 30/90 degrees, dt = 1/240\n");
  fmt::print("{:>6} {:>10} {:>9} {:>10} {:>12} {:>10} {:>10}\n", "R, cm", "deposited", "edge_min", "triangles",
             "measured", "pi/4", "Furmidge");
  const double rate = (quick ? 200 : 5) * degree;
  for (const double radius : {0.25, 0.3})
    for (const double deposited : {60 * degree, 90 * degree})
      for (const double edge_min : {0.028, 0.02})
        if (!quick || (radius == 0.3 && deposited == 90 * degree && edge_min == 0.028))
          print_critical_tilt(radius, deposited, edge_min, rate);
  fmt::print("\nOn the upright pane: way of the centre of mass in the last four fifths of {} s, cm\n",
             quick ? 0.25 : 5);
  fmt::print("{:>6} {:>10} {:>9} {:>16}\n", "R, cm", "deposited", "edge_min", "creep, cm");
  for (const double radius : {0.1, 0.15})
    for (const double deposited : {60 * degree, 90 * degree})
      if (!quick || (radius == 0.1 && deposited == 60 * degree))
        print_creep(radius, deposited, 0.2 * radius, quick ? 0.25 : 5);
}
