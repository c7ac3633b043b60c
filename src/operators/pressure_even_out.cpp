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

/// What the faces around a vertex add up to.
struct Around {
  Vector3d area_vector;  ///< cm^2
  Vector3d to_centroid;  ///< from the vertex, area weighted; cm
};

Around look_around(const Drop& drop, std::uint32_t v) {
  const ConstColumns x = drop.positions();
  const Ring ring = drop.connectivity().ring(v);
  Vector3d area_vector = Vector3d::Zero(), moment = Vector3d::Zero();
  double area = 0;
  Vector3d last = ring.degree > 0 ? Vector3d(x.col(ring.neighbour[ring.degree - 1]) - x.col(v)) : Vector3d::Zero();
  for (int k = 0; k < ring.degree; ++k) {
    const Vector3d edge = x.col(ring.neighbour[k]) - x.col(v), twice_area = last.cross(edge);
    const double length = twice_area.norm();
    area_vector += twice_area;
    moment += length * (last + edge);
    area += length;
    last = edge;
  }
  return {0.5 * area_vector, area > 0 ? Vector3d(moment / (3 * area)) : Vector3d(Vector3d::Zero())};
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

bool is_free(const Drop& drop, const PressureSurface& surface, std::uint32_t v) {
  return is_on_surface(surface.role[v]) && !is_colliding(drop.contact()[v]);
}

/// The most that a substep offsets the surface, as a share of edge_min.
constexpr double most_offset = 0.05;

/// What a move of the free surface along its normals does to the volume, and the volume.
struct Enclosed {
  double free_area = 0;  ///< cm^2
  double volume = 0;     ///< cm^3

  Enclosed& operator+=(const Enclosed& other) {
    free_area += other.free_area;
    volume += other.volume;
    return *this;
  }
};

/// What the free surface must be offset by for the volume (cm), within bounds.
double volume_offset(const Drop& drop, double edge_min, const Enclosed& now) {
  const double most = most_offset * edge_min;
  return now.free_area > 0 ? std::clamp((drop.target_volume() - now.volume) / now.free_area, -most, most) : 0;
}

}  // namespace

void even_out(Drop& drop, const PressureOptions& options, PressureArrays& arrays) {
  const PressureSurface& surface = arrays.surface;
  SurfaceGeometry& geometry = drop.workspace().geometry;
  const auto n = static_cast<std::uint32_t>(drop.num_rows());
  const double factor = options.smoothing, sharp = surface.in_contact ? sharp_turn_cosine(surface) : -1;
  const double small = 1e-3 * options.edge_min;  // u changes by next to nothing on such a way
  std::vector<double>& carried = arrays.rhs;     // free by now
  std::vector<Vector3d>& shift = arrays.shift;
  shift.assign(n, Vector3d::Zero());
  carried = arrays.deformation;
  const Enclosed enclosed = sum_over_chunks(n, Enclosed{}, [&](std::size_t begin, std::size_t end) {
    Enclosed part;
    for (auto v = static_cast<std::uint32_t>(begin); v < end; ++v) {
      const Around around = look_around(drop, v);
      geometry.set_area_vector(v, around.area_vector);
      if (is_free(drop, surface, v)) part.free_area += around.area_vector.dot(geometry.normal(v)) / 3;
      // A third of the area vector is the gradient of the volume, which is of degree three.
      part.volume += around.area_vector.dot(drop.positions().col(v) - surface.center) / 9;
      if (drop.connectivity().degree(v) <= 3) continue;  // a corner of a tetrahedron has no tangent plane
      const Role role = surface.role[v];
      if (role == Role::line) {
        shift[v] = line_shift(drop, surface, v, factor, sharp);
      } else if (const bool free = is_free(drop, surface, v); free || role == Role::wetted) {
        const Vector3d normal = free ? geometry.normal(v) : Vector3d(drop.contact_normals().col(v));
        shift[v] = factor * (around.to_centroid - around.to_centroid.dot(normal) * normal);
      }
      if (is_moving(role) && shift[v].squaredNorm() > small * small)
        carried[v] += shift[v].dot(surface_gradient(drop, surface.wet_face, arrays.deformation, v));
    }
    return part;
  });
  const double offset = volume_offset(drop, options.edge_min, enclosed);
  Columns x = drop.positions();
  for_each_chunk(n, [&](std::size_t begin, std::size_t end) {
    for (auto v = static_cast<std::uint32_t>(begin); v < end; ++v) {
      if (offset != 0 && drop.connectivity().degree(v) > 3 && is_free(drop, surface, v))
        shift[v] += offset * geometry.normal(v);
      x.col(v) += shift[v];
    }
  });
  arrays.deformation.swap(carried);
}

}  // namespace meniscus
