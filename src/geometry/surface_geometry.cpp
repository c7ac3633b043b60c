// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/geometry/surface_geometry.h"

#include <Eigen/Geometry>

#include <cmath>

namespace meniscus {
namespace {

/// Area vector, cotangents and mixed Voronoi areas of the triangle a, b, c.
FaceGeometry face_geometry(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d u = b - a, w = c - a;
  const Eigen::Vector3d n = 0.5 * u.cross(w);
  const double uu = u.squaredNorm(), ww = w.squaredNorm(), uw = u.dot(w);
  const double area = n.norm();
  FaceGeometry face;
  face.area_vector = {n.x(), n.y(), n.z()};
  if (area <= 0) {
    face.cotangent = {0, 0, 0};
    face.area = {0, 0, 0};
    return face;
  }
  const double s = 0.5 / area;  // cot = dot / |cross|
  const double cot_a = uw * s, cot_b = (uu - uw) * s, cot_c = (ww - uw) * s;
  face.cotangent = {cot_a, cot_b, cot_c};
  if (cot_a < 0)
    face.area = {0.5 * area, 0.25 * area, 0.25 * area};
  else if (cot_b < 0)
    face.area = {0.25 * area, 0.5 * area, 0.25 * area};
  else if (cot_c < 0)
    face.area = {0.25 * area, 0.25 * area, 0.5 * area};
  else {
    const double vv = uu + ww - 2 * uw;  // |bc|^2
    const double ab = uu * cot_c * 0.125, ac = ww * cot_b * 0.125, bc = vv * cot_a * 0.125;
    face.area = {ab + ac, ab + bc, ac + bc};
  }
  return face;
}

}  // namespace

void SurfaceGeometry::compute(const ConstColumns& x, const Connectivity& connectivity) {
  const auto& triangles = connectivity.triangles();
  const std::size_t n = connectivity.num_rows();
  faces_.resize(triangles.size());
  area_vector_.resize(n);
  normal_.resize(n);
  lumped_area_.resize(n);
  area_ = volume_ = 0;
  const Eigen::Vector3d origin = n == 0 ? Eigen::Vector3d::Zero() : Eigen::Vector3d(x.col(0));
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    const auto& [i, j, k] = triangles[f];
    if (i == Connectivity::removed) {
      faces_[f] = {};
      continue;
    }
    const Eigen::Vector3d a = x.col(i);
    FaceGeometry& face = faces_[f] = face_geometry(a, x.col(j), x.col(k));
    area_ += face.area[0] + face.area[1] + face.area[2];
    volume_ += (a - origin).dot(Eigen::Vector3d(face.area_vector[0], face.area_vector[1], face.area_vector[2]));
  }
  volume_ /= 3;
  for (std::uint32_t v = 0; v < n; ++v) {
    const Ring ring = connectivity.ring(v);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double area = 0;
    for (int k = 0; k < ring.degree; ++k) {
      const std::uint32_t f = ring.corner[k] / 3, corner = ring.corner[k] - 3 * f;
      const FaceGeometry& face = faces_[f];
      sum += Eigen::Vector3d(face.area_vector[0], face.area_vector[1], face.area_vector[2]);
      area += face.area[corner];
    }
    area_vector_[v] = sum;
    lumped_area_[v] = area;
    const double length = sum.norm();
    normal_[v] = length > 0 ? Eigen::Vector3d(sum / length) : Eigen::Vector3d::Zero();
  }
}

double enclosed_volume(const ConstColumns& x, const Connectivity& connectivity) {
  if (x.cols() == 0) return 0;
  const Eigen::Vector3d origin = x.col(0);
  double volume = 0;
  for (const auto& [i, j, k] : connectivity.triangles()) {
    if (i == Connectivity::removed) continue;
    const Eigen::Vector3d a = x.col(i) - origin, b = x.col(j) - origin, c = x.col(k) - origin;
    volume += a.dot(b.cross(c));
  }
  return volume / 6;
}

}  // namespace meniscus
