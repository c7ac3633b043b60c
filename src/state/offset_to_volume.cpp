// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/state/offset_to_volume.h"

#include "meniscus/core/chunks.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

using Eigen::Vector3d;

/// Newton needs two or three rounds for a step's change of volume; more are for the first after a merge or a split.
constexpr int max_rounds = 8;
constexpr double volume_tolerance = 1e-12;

/// The volume as a function of the offset d: the normals stay, so that it is a cubic.
struct OffsetVolume {
  double constant = 0, linear = 0, square = 0, cube = 0;

  double at(double d) const { return constant + d * (linear + d * (square + d * cube)); }
  double slope(double d) const { return linear + d * (2 * square + d * 3 * cube); }
  OffsetVolume& operator+=(const OffsetVolume& other) {
    constant += other.constant;
    linear += other.linear;
    square += other.square;
    cube += other.cube;
    return *this;
  }
};

/// A point of the surface, so that a drop far from the origin loses no digits.
Vector3d point_of(const Drop& drop) {
  for (const auto& triangle : drop.connectivity().triangles())
    if (triangle[0] != Connectivity::removed) return drop.positions().col(triangle[0]);
  return Vector3d::Zero();
}

/// The sum of det(a + d n_a, b + d n_b, c + d n_c)/6 over the faces.
OffsetVolume offset_volume(const Drop& drop, const SurfaceGeometry& geometry) {
  const ConstColumns x = drop.positions();
  const auto& triangles = drop.connectivity().triangles();
  const Vector3d origin = point_of(drop);
  const auto normal = [&](std::uint32_t i) {
    return is_colliding(drop.contact()[i]) ? Vector3d(Vector3d::Zero()) : geometry.normal(i);
  };
  OffsetVolume six = sum_over_chunks(triangles.size(), OffsetVolume{}, [&](std::size_t begin, std::size_t end) {
    OffsetVolume part;
    for (std::size_t f = begin; f < end; ++f) {
      const auto& [i, j, k] = triangles[f];
      if (i == Connectivity::removed) continue;
      const Vector3d a = x.col(i) - origin, b = x.col(j) - origin, c = x.col(k) - origin;
      const Vector3d p = normal(i), q = normal(j), r = normal(k);
      const Vector3d bc = b.cross(c), qr = q.cross(r), mixed = q.cross(c) + b.cross(r);
      part.constant += a.dot(bc);
      part.linear += p.dot(bc) + a.dot(mixed);
      part.square += p.dot(mixed) + a.dot(qr);
      part.cube += p.dot(qr);
    }
    return part;
  });
  return {six.constant / 6, six.linear / 6, six.square / 6, six.cube / 6};
}

}  // namespace

VolumeOffset offset_to_volume(Drop& drop, const SurfaceGeometry& geometry, double volume, double least, double most) {
  const OffsetVolume measured = offset_volume(drop, geometry);
  VolumeOffset report;
  report.error = report.error_before = measured.constant - volume;
  for (int round = 0; round < max_rounds && std::abs(report.error) > volume_tolerance * volume && !report.limited;
       ++round) {
    const double slope = measured.slope(report.offset);
    if (!(slope > 0)) break;
    const double wanted = report.offset - report.error / slope;
    report.offset = std::clamp(wanted, least, most);
    report.limited = report.offset != wanted;
    report.error = measured.at(report.offset) - volume;
  }
  if (report.offset == 0) return report;
  Columns x = drop.positions();
  for_each_chunk(drop.num_rows(), [&](std::size_t begin, std::size_t end) {
    for (auto i = static_cast<std::uint32_t>(begin); i < end; ++i)
      if (is_off_solids(drop, i)) x.col(i) += report.offset * geometry.normal(i);
  });
  return report;
}

}  // namespace meniscus
