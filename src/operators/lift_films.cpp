// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/operators/lift_films.h"

#include <Eigen/Geometry>

namespace meniscus {
namespace {

using Eigen::Vector3d;

/// Whether p lies within the triangle of three points, as seen along n.
bool is_within(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& n) {
  const double u = (b - a).cross(p - a).dot(n), v = (c - b).cross(p - b).dot(n), w = (a - c).cross(p - c).dot(n);
  return (u <= 0 && v <= 0 && w <= 0) || (u >= 0 && v >= 0 && w >= 0);
}

constexpr double film_thickness = 0.02;  // of the mean length of a vertex' edges

bool is_over_wetted_area(const Drop& drop, std::uint32_t v, const Vector3d& p, const Vector3d& n) {
  const ConstColumns x = drop.positions();
  const Contact* contact = drop.contact();
  for (const auto& [a, b, c] : drop.connectivity().triangles()) {
    if (a == Connectivity::removed || a == v || b == v || c == v) continue;
    if (!is_colliding(contact[a]) || !is_colliding(contact[b]) || !is_colliding(contact[c])) continue;
    const Vector3d p_a = x.col(a), p_b = x.col(b), p_c = x.col(c);
    if ((p_b - p_a).cross(p_c - p_a).dot(n) < 0 && is_within(p, p_a, p_b, p_c, n)) return true;
  }
  return false;
}

/// Puts a vertex that is below p, on a solid of normal n, above it.
void lift(Drop& drop, std::uint32_t v, const Vector3d& p, const Vector3d& n) {
  Columns x = drop.positions();
  const Ring ring = drop.connectivity().ring(v);
  double length = 0;
  for (int k = 0; k < ring.degree; ++k) length += (x.col(ring.neighbour[k]) - p).norm() / ring.degree;
  x.col(v) = p + film_thickness * length * n;
}

}  // namespace

void lift_films(Drop& drop, const std::vector<Solid>& solids, double time) {
  if (!touches_solid(drop)) return;
  const Eigen::AlignedBox3d box = bounding_box(drop);
  for (const Solid& solid : solids) {
    if (solid.inflow || !solid.is_near(box, time, 0)) continue;
    for (std::uint32_t v = 0; v < drop.num_rows(); ++v) {
      if (drop.connectivity().degree(v) == 0 || is_colliding(drop.contact()[v])) continue;
      const Vector3d x = drop.positions().col(v);
      if (!solid.is_near(x, time, 0)) continue;
      const SolidContact below = solid.query(x, time);
      if (below.distance <= 0 && is_over_wetted_area(drop, v, below.point, below.normal))
        lift(drop, v, below.point, below.normal);
    }
  }
}

}  // namespace meniscus
