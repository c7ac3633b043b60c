// SPDX-License-Identifier: GPL-3.0-or-later
#include "round_off.h"

#include "meniscus/geometry/self_intersection.h"
#include "meniscus/geometry/shapes.h"
#include "step_parts.h"

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

using Eigen::Vector3d;

constexpr double thinnest_film = 0.25;  // in lengths of edge_min
constexpr double smallest_shape = 2;    // radius of the ball, in lengths of edge_max
/// A drop that has been stuck for so many substeps in a row does not get free by itself.
constexpr int most_stuck = 30;

/// A ball about `center` that reaches into solids goes out of them along their normals.
Vector3d clear_of_solids(Vector3d center, double radius, const std::vector<Solid>& solids, double time) {
  constexpr double clear = 1.01;
  for (const Solid& solid : solids) {
    if (solid.inflow || !solid.is_near(Eigen::AlignedBox3d(center), time, clear * radius)) continue;
    const SolidContact nearest = solid.query(center, time);
    if (nearest.distance < clear * radius) center = nearest.point + clear * radius * nearest.normal;
  }
  return center;
}

bool is_watched(const Drop& drop) {
  const std::uint8_t* watch = drop.seam_watch();
  return std::any_of(watch, watch + drop.num_rows(), [](std::uint8_t w) { return w != 0; });
}

bool is_knot(const Drop& drop) {
  if (drop.mesh().number_of_faces() <= 4 || !(drop.volume() > 0)) return true;
  MeshData surface;
  const ConstColumns x = drop.positions();
  for (std::uint32_t v = 0; v < drop.num_rows(); ++v) surface.points.push_back({x(0, v), x(1, v), x(2, v)});
  for (const auto& t : drop.connectivity().triangles()) {
    if (t[0] == Connectivity::removed) continue;
    const Vector3d p = x.col(t[0]), q = x.col(t[1]), r = x.col(t[2]);
    if (!((q - p).cross(r - p).squaredNorm() > 0)) return true;
    surface.triangles.push_back(t);
  }
  return !self_intersections(surface, 1).empty();
}

}  // namespace

bool is_speck(const Drop& drop, const EdgeBand& band) { return ball_radius(drop) < band.edge_max; }

bool may_be_rounded_off(const Drop& drop, const EdgeBand& band) {
  if (!drop.positions().allFinite() || !drop.velocities().allFinite()) return false;
  if (ball_radius(drop) < smallest_shape * band.edge_max) return true;
  SurfaceGeometry geometry;
  geometry.compute(drop.positions(), drop.connectivity());
  return 2 * drop.target_volume() < thinnest_film * band.edge_min * geometry.area();
}

Drop rounded_off(const Drop& drop, const std::vector<Solid>& solids, double time, double dt, const EdgeBand& band) {
  const Vector3d velocity = mean_over_vertices(drop, drop.velocities());
  const Vector3d center =
      clear_of_solids(mean_over_vertices(drop, drop.positions()) + dt * velocity, ball_radius(drop), solids, time);
  const double edge = std::sqrt(band.edge_min * band.edge_max);
  const Mesh unit = make_sphere(Vector3d::Zero(), ball_radius(drop), edge);
  Drop ball(unit);
  const double scale = std::cbrt(drop.target_volume() / ball.volume());
  ball.positions() = (scale * ball.positions()).colwise() + center;
  ball.velocities().colwise() = velocity;
  ball.set_target_volume(drop.target_volume());
  ball.set_inflow(drop.inflow());
  ball.set_id(drop.id());
  return ball;
}

bool round_off_knot(Drop& drop, std::uint64_t version, const std::vector<Solid>& solids, double time,
                    const EdgeBand& band) {
  const bool is_stuck = drop.stuck_substeps() >= most_stuck && may_be_rounded_off(drop, band);
  const bool may_be_knot = is_speck(drop, band) && (drop.topology_version() != version || is_watched(drop));
  if (!is_stuck && !(may_be_knot && is_knot(drop))) return false;
  drop = rounded_off(drop, solids, time, 0, band);
  return true;
}

}  // namespace meniscus
