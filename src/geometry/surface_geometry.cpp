// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/geometry/surface_geometry.h"

#include "meniscus/core/chunks.h"

#include <Eigen/Geometry>

#include <algorithm>
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

struct Sums {
  double area = 0, volume = 0;

  Sums& operator+=(const Sums& other) {
    area += other.area;
    volume += other.volume;
    return *this;
  }
};

}  // namespace

void SurfaceGeometry::compute_faces(const ConstColumns& x, const Connectivity& connectivity) {
  const auto& triangles = connectivity.triangles();
  const Eigen::Vector3d origin = x.cols() == 0 ? Eigen::Vector3d::Zero() : Eigen::Vector3d(x.col(0));
  const Sums sums = sum_over_chunks(triangles.size(), Sums{}, [&](std::size_t begin, std::size_t end) {
    Sums part;
    for (std::size_t f = begin; f < end; ++f) {
      const auto& [i, j, k] = triangles[f];
      if (i == Connectivity::removed) {
        faces_[f] = {};
        continue;
      }
      const Eigen::Vector3d a = x.col(i);
      FaceGeometry& face = faces_[f] = face_geometry(a, x.col(j), x.col(k));
      part.area += face.area[0] + face.area[1] + face.area[2];
      part.volume += (a - origin).dot(Eigen::Vector3d(face.area_vector[0], face.area_vector[1], face.area_vector[2]));
    }
    return part;
  });
  area_ = sums.area;
  volume_ = sums.volume / 3;
}

void SurfaceGeometry::compute_vertex(const ConstColumns& x, const Connectivity& connectivity, std::uint32_t v) {
  constexpr std::uint8_t next[3] = {1, 2, 0}, previous[3] = {2, 0, 1};
  const Ring ring = connectivity.ring(v);
  double* weight = &edge_weights_.weight[Connectivity::width * std::size_t{v}];
  std::fill(weight + (ring.degree > Connectivity::width ? 0 : ring.degree), weight + Connectivity::width, 0.0);
  if (ring.degree > Connectivity::width) weight = edge_weights_.long_weight[connectivity.long_ring(v)].data();
  const auto face_of = [&](int k) -> const FaceGeometry& { return faces_[ring.corner[k] / 3]; };
  const auto place_in = [&](int k) { return ring.corner[k] - 3 * (ring.corner[k] / 3); };
  const Eigen::Vector3d own = x.col(v);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), gradient = Eigen::Vector3d::Zero();
  double area = 0;
  // Face k is (v, u_k, u_{k+1}): its cotangent at u_{k+1} belongs to edge v u_k, the one at u_k to edge v u_{k+1}.
  double carried = ring.degree > 0 ? face_of(ring.degree - 1).cotangent[next[place_in(ring.degree - 1)]] : 0;
  for (int k = 0; k < ring.degree; ++k) {
    const FaceGeometry& face = face_of(k);
    const std::uint32_t corner = place_in(k);
    sum += Eigen::Vector3d(face.area_vector[0], face.area_vector[1], face.area_vector[2]);
    area += face.area[corner];
    const double half_sum = 0.5 * (face.cotangent[previous[corner]] + carried);
    weight[k] = half_sum;
    carried = face.cotangent[next[corner]];
    gradient += std::max(half_sum, 0.0) * (own - x.col(ring.neighbour[k]));
  }
  area_vector_[v] = sum;
  area_gradient_[v] = gradient;
  lumped_area_[v] = area;
  const double length = sum.norm();
  normal_[v] = length > 0 ? Eigen::Vector3d(sum / length) : Eigen::Vector3d::Zero();
}

void SurfaceGeometry::compute(const ConstColumns& x, const Connectivity& connectivity) {
  const std::size_t n = connectivity.num_rows(), num_long = connectivity.long_rings().size();
  faces_.resize(connectivity.triangles().size());
  for (auto* array : {&area_vector_, &normal_, &area_gradient_}) array->resize(n);
  lumped_area_.resize(n);
  edge_weights_.weight.resize(Connectivity::width * n);
  edge_weights_.long_weight.resize(num_long);
  for (std::size_t k = 0; k < num_long; ++k)
    edge_weights_.long_weight[k].resize(connectivity.long_rings()[k].neighbour.size());
  compute_faces(x, connectivity);
  for_each_chunk(n, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) compute_vertex(x, connectivity, static_cast<std::uint32_t>(v));
  });
}

double enclosed_volume(const ConstColumns& x, const Connectivity& connectivity) {
  if (x.cols() == 0) return 0;
  const Eigen::Vector3d origin = x.col(0);
  const auto& triangles = connectivity.triangles();
  return sum_over_chunks(triangles.size(), 0.0,
                         [&](std::size_t begin, std::size_t end) {
                           double volume = 0;
                           for (std::size_t f = begin; f < end; ++f) {
                             const auto& [i, j, k] = triangles[f];
                             if (i == Connectivity::removed) continue;
                             const Eigen::Vector3d a = x.col(i) - origin, b = x.col(j) - origin, c = x.col(k) - origin;
                             volume += a.dot(b.cross(c));
                           }
                           return volume;
                         }) /
         6;
}

}  // namespace meniscus
