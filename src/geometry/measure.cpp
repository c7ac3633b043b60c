// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/geometry/measure.h"

#include "scaled_triangles.h"

#include <Eigen/Geometry>

#include <algorithm>

namespace meniscus {
namespace {

template <class Triangles>
EdgeLengths edge_lengths_of(const Triangles& source) {
  EdgeLengths lengths;
  std::size_t count = 0;
  const double unit = for_each_scaled_triangle(source, [&](const Corners& p) {
    for (int k = 0; k < 3; ++k) {
      const double length = (p[(k + 1) % 3] - p[k]).norm();
      lengths.min = count == 0 ? length : std::min(lengths.min, length);
      lengths.max = std::max(lengths.max, length);
      lengths.mean += length;
      ++count;
    }
  });
  if (count == 0) return {};
  return {lengths.min * unit, lengths.mean / double(count) * unit, lengths.max * unit};
}

template <class Triangles>
Angles angles_of(const Triangles& source, double threshold) {
  Angles result;
  std::size_t count = 0, below = 0;
  for_each_scaled_triangle(source, [&](const Corners& p) {
    double least = 4, greatest = 0;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d u = p[(k + 1) % 3] - p[k], w = p[(k + 2) % 3] - p[k];
      const double angle = std::atan2(u.cross(w).norm(), u.dot(w));
      least = std::min(least, angle);
      greatest = std::max(greatest, angle);
    }
    result.least = count == 0 ? least : std::min(result.least, least);
    result.greatest = std::max(result.greatest, greatest);
    below += least < threshold;
    ++count;
  });
  result.share_below = count == 0 ? 0 : double(below) / double(count);
  return result;
}

template <class Triangles>
double area_of(const Triangles& source) {
  double sum = 0;
  const double unit =
      for_each_scaled_triangle(source, [&](const Corners& p) { sum += 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).norm(); });
  return sum * unit * unit;
}

/// Volume, its first moment about `origin` and the mean corner relative to it, scaled.
struct SolidSums {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero(), corner = Eigen::Vector3d::Zero();
  Eigen::Vector3d unit = Eigen::Vector3d::Ones();
  double volume = 0;
  std::size_t count = 0;
};

template <class Triangles>
SolidSums solid_sums(const Triangles& source) {
  SolidSums sums;
  sums.unit = for_each_triangle_scaled_by_axis(source, [&](const Corners& p) {
    if (sums.count++ == 0) sums.origin = p[0];
    const Eigen::Vector3d a = p[0] - sums.origin, b = p[1] - sums.origin, c = p[2] - sums.origin;
    const double volume = a.dot(b.cross(c)) / 6;
    sums.volume += volume;
    sums.moment += volume * (a + b + c) / 4;
    sums.corner += (a + b + c) / 3;
  });
  return sums;
}

template <class Triangles>
double volume_of(const Triangles& source) {
  const SolidSums sums = solid_sums(source);
  return std::ldexp(sums.volume, std::ilogb(sums.unit.x()) + std::ilogb(sums.unit.y()) + std::ilogb(sums.unit.z()));
}

template <class Triangles>
Eigen::Vector3d centroid_of(const Triangles& source) {
  const SolidSums sums = solid_sums(source);
  if (sums.count == 0) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d offset =
      sums.volume != 0 ? Eigen::Vector3d(sums.moment / sums.volume) : Eigen::Vector3d(sums.corner / double(sums.count));
  return (sums.origin + offset).cwiseProduct(sums.unit);
}

}  // namespace

EdgeLengths edge_lengths(const Mesh& mesh) { return edge_lengths_of(mesh); }
EdgeLengths edge_lengths(const MeshData& data) { return edge_lengths_of(data); }
Angles angles(const Mesh& mesh, double threshold) { return angles_of(mesh, threshold); }
Angles angles(const MeshData& data, double threshold) { return angles_of(data, threshold); }
double surface_area(const Mesh& mesh) { return area_of(mesh); }
double surface_area(const MeshData& data) { return area_of(data); }
double enclosed_volume(const Mesh& mesh) { return volume_of(mesh); }
double enclosed_volume(const MeshData& data) { return volume_of(data); }
Eigen::Vector3d solid_centroid(const Mesh& mesh) { return centroid_of(mesh); }
Eigen::Vector3d solid_centroid(const MeshData& data) { return centroid_of(data); }

}  // namespace meniscus
