// SPDX-License-Identifier: GPL-3.0-or-later
// Drops of water at rest on a plane at the level "pressure", beside Young-Laplace: from caps that stand 20 %
// too steep or too flat, remeshing on, about 2,000 triangles, dt = 1/240. Prints a table. --quick: a short run.
#include "meniscus/simulation/simulation.h"
#include "meniscus/state/contact_line.h"
#include "references/drop_at_rest.h"

#include <fmt/format.h>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ctime>

namespace {

using namespace meniscus;
using Eigen::Vector3d;

constexpr double degree = pi / 180;

double cpu_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double top(const Drop& drop) {
  double height = 0;
  for (std::uint32_t v = 0; v < drop.num_rows(); ++v)
    if (drop.connectivity().degree(v) > 0) height = std::max(height, drop.positions()(2, v));
  return height;
}

/// The contact angle (radians) of a drop of revolution on z = 0: dr/dz = -cot(theta) there, with r^2 the cubic in z
/// nearest to the free and line vertices of the lowest third, about the middle of the line. On a sphere r^2 is
/// quadratic in z, so that the fit has no error of its own there; a cubic for r has 1 to 5 degrees beyond 120.
double profile_angle(const Drop& drop) {
  std::vector<std::uint32_t> low;
  Vector3d middle = Vector3d::Zero();
  int line = 0;
  const double limit = top(drop) / 3;
  for (std::uint32_t v = 0; v < drop.num_rows(); ++v) {
    if (drop.connectivity().degree(v) == 0 || drop.contact()[v] == Contact::wetted) continue;
    if (drop.positions()(2, v) < limit) low.push_back(v);
    if (drop.contact()[v] != Contact::line) continue;
    middle += drop.positions().col(v);
    ++line;
  }
  if (line == 0 || low.size() < 8) return std::nan("");
  middle /= line;
  Eigen::MatrixX4d powers(low.size(), 4);
  Eigen::VectorXd squared_radii(low.size());
  for (std::size_t i = 0; i < low.size(); ++i) {
    const Vector3d x = drop.positions().col(low[i]);
    const double z = x.z() / limit;
    powers.row(static_cast<Eigen::Index>(i)) << 1, z, z * z, z * z * z;
    squared_radii[static_cast<Eigen::Index>(i)] = (x - middle).head<2>().squaredNorm();
  }
  const Eigen::Vector4d fit = powers.colPivHouseholderQr().solve(squared_radii);
  const double slope = fit[1] / (2 * limit * std::sqrt(fit[0]));
  return std::atan2(1, -slope);
}

void print_rest(double radius, double angle_deg, double edges) {
  Scene scene = default_scene();
  scene.model = Level::pressure;
  scene.time_step = 1.0 / 240;
  scene.mesh.edge_min = edges * radius;
  scene.mesh.edge_max = 3 * scene.mesh.edge_min;
  scene.solids.emplace_back();
  scene.solids[0].name = "plate";
  scene.solids[0].advancing_angle = scene.solids[0].receding_angle = angle_deg * degree;
  scene.drops.emplace_back();
  scene.drops[0].shape = DropShape::cap;
  scene.drops[0].on = "plate";
  scene.drops[0].radius = radius;
  scene.drops[0].angle = (angle_deg < 100 ? 0.8 : 0.85) * angle_deg * degree;
  Simulation simulation(scene);
  const double start = cpu_seconds();
  while (simulation.time() < 0.5) simulation.step();
  const double seconds = cpu_seconds() - start;
  const Drop& drop = simulation.drops().front();
  const auto exact =
      references::drop_at_rest(drop.target_volume(), angle_deg * degree, 981, scene.liquid, references::Hold::sessile);
  fmt::print("{:>6} {:>6} {:>10} {:>10.3f} {:>10.3f} {:>12.2f} {:>8.2f}\n", radius, angle_deg,
             std::size_t{drop.mesh().number_of_faces()}, 100 * (top(drop) / exact.height - 1),
             100 * (std::sqrt(wetted_area(drop) / pi) / exact.contact_radius - 1),
             profile_angle(drop) / degree - angle_deg, seconds);
}

}  // namespace

int main(int argc, char** argv) {
  const bool quick = argc > 1 && std::strcmp(argv[1], "--quick") == 0;
  fmt::print("At rest after 0.5 s, against Young-Laplace\n{:>6} {:>6} {:>10} {:>10} {:>10} {:>12} {:>8}\n", "R, cm",
             "angle", "triangles", "height, %", "radius, %", "angle, deg", "CPU, s");
  const struct {
    double angle, edges;  // degrees; edge_min over R, for about 2,000 triangles
  } cases[] = {{30, 0.087}, {60, 0.0685}, {90, 0.0605}, {120, 0.059}, {150, 0.0595}};
  for (const double radius : {0.1, 0.2, 0.3})
    for (const auto& [angle, edges] : cases)
      if (!quick || (radius == 0.2 && angle == 90)) print_rest(radius, angle, edges);
}
