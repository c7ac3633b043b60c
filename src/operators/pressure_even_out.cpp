// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/core/chunks.h"
#include "pressure_arrays.h"

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

using Eigen::Vector3d;

constexpr double degree = 3.14159265358979323846 / 180;

/// The two neighbours of a line vertex along the line.
struct LineNeighbours {
  std::uint32_t vertex[2];
  int count = 0;
};

LineNeighbours line_neighbours(const Drop& drop, const std::vector<std::uint8_t>& wet_face, std::uint32_t v) {
  LineNeighbours result{};
  const Ring ring = drop.connectivity().ring(v);
  for (int k = 0, last = ring.degree - 1; k < ring.degree; last = k++)
    if (wet_face[ring.corner[k] / 3] != wet_face[ring.corner[last] / 3] && result.count++ < 2)
      result.vertex[result.count - 1] = ring.neighbour[k];
  return result;
}

/// From a vertex to the area weighted centroid of its ring.
Vector3d to_centroid(const Drop& drop, std::uint32_t v) {
  const ConstColumns x = drop.positions();
  const auto& faces = drop.workspace().geometry.faces();
  const Ring ring = drop.connectivity().ring(v);
  Vector3d sum = Vector3d::Zero();
  double area = 0;
  for (int k = 0; k < ring.degree; ++k) {
    const FaceGeometry& face = faces[ring.corner[k] / 3];
    const double a = face.area[0] + face.area[1] + face.area[2];
    const std::uint32_t p = ring.neighbour[k], q = ring.neighbour[k + 1 == ring.degree ? 0 : k + 1];
    sum += a / 3 * (x.col(p) + x.col(q) - 2 * x.col(v));
    area += a;
  }
  return area > 0 ? Vector3d(sum / area) : Vector3d(Vector3d::Zero());
}

/// The gradient of a function on the water-air surface, area weighted over the ring.
Vector3d surface_gradient(const Drop& drop, const std::vector<std::uint8_t>& wet_face, const std::vector<double>& u,
                          std::uint32_t v) {
  const ConstColumns x = drop.positions();
  const Ring ring = drop.connectivity().ring(v);
  Vector3d sum = Vector3d::Zero();
  double area = 0;
  for (int k = 0; k < ring.degree; ++k) {
    if (wet_face[ring.corner[k] / 3] != 0) continue;
    const std::uint32_t p = ring.neighbour[k], q = ring.neighbour[k + 1 == ring.degree ? 0 : k + 1];
    const Vector3d e = x.col(p) - x.col(v), f = x.col(q) - x.col(v);
    const Vector3d twice_area = e.cross(f);
    const double a = twice_area.norm();
    if (!(a > 0)) continue;
    sum += twice_area.cross((u[q] - u[v]) * e - (u[p] - u[v]) * f) / a;
    area += a;
  }
  return area > 0 ? Vector3d(sum / area) : Vector3d(Vector3d::Zero());
}

/// Along the contact line to the middle of its neighbours. Where the line turns sharply, all of the way's
/// half, even where it sticks: a line that has crumpled stays so for good.
Vector3d line_shift(const Drop& drop, const PressureSurface& surface, std::uint32_t v, double factor,
                    double sharp_cosine) {
  const LineNeighbours line = line_neighbours(drop, surface.wet_face, v);
  if (line.count != 2) return Vector3d::Zero();
  const ConstColumns x = drop.positions();
  const Vector3d before = x.col(v) - x.col(line.vertex[0]), after = x.col(line.vertex[1]) - x.col(v);
  const Vector3d wall = drop.contact_normals().col(v);
  Vector3d way = 0.5 * (after - before);
  way -= way.dot(wall) * wall;
  if (before.dot(after) < sharp_cosine * before.norm() * after.norm()) return 0.5 * way;
  if (drop.line_status(v) == LineStatus::stuck) return Vector3d::Zero();
  const Vector3d m = surface.direction[v].normalized();
  return factor * (way - way.dot(m) * m);
}

/// The turn from which on a line of n vertices is crumpled: a circle's is 360 degrees/n.
double sharp_turn_cosine(const PressureSurface& surface) {
  const auto n = std::count(surface.role.begin(), surface.role.end(), Role::line);
  return std::cos(std::min(180.0, std::max(50.0, 720.0 / static_cast<double>(std::max<std::ptrdiff_t>(n, 1)))) *
                  degree);
}

}  // namespace

void even_out(Drop& drop, const PressureOptions& options, double factor, double offset, PressureArrays& arrays) {
  const PressureSurface& surface = arrays.surface;
  const SurfaceGeometry& geometry = drop.workspace().geometry;
  const auto n = static_cast<std::uint32_t>(drop.num_rows());
  const double sharp = surface.in_contact ? sharp_turn_cosine(surface) : -1;
  const double small = 1e-3 * options.edge_min;  // u changes by next to nothing on such a way
  std::vector<double>& carried = arrays.rhs;     // free by now
  std::vector<Vector3d>& shift = arrays.shift;
  shift.assign(n, Vector3d::Zero());
  carried = arrays.deformation;
  for_each_chunk(n, [&](std::size_t begin, std::size_t end) {
    for (auto v = static_cast<std::uint32_t>(begin); v < end; ++v) {
      const bool colliding = is_colliding(drop.contact()[v]);
      const Role role = surface.role[v];
      if (drop.connectivity().degree(v) <= 3) continue;  // a corner of a tetrahedron has no tangent plane
      if (is_on_surface(role) && !colliding) {
        const Vector3d normal = geometry.normal(v), way = to_centroid(drop, v);
        shift[v] = factor * (way - way.dot(normal) * normal);
      } else if (role == Role::line) {
        shift[v] = line_shift(drop, surface, v, factor, sharp);
      } else if (role == Role::wetted) {
        const Vector3d normal = drop.contact_normals().col(v), way = to_centroid(drop, v);
        shift[v] = factor * (way - way.dot(normal) * normal);
      }
      if (is_moving(role) && shift[v].squaredNorm() > small * small)
        carried[v] += shift[v].dot(surface_gradient(drop, surface.wet_face, arrays.deformation, v));
      if (is_on_surface(role) && !colliding) shift[v] += offset * geometry.normal(v);
    }
  });
  Columns x = drop.positions();
  for (std::uint32_t v = 0; v < n; ++v) x.col(v) += shift[v];
  arrays.deformation = carried;
}

}  // namespace meniscus
