// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/geometry/surface_geometry.h"

#include "meniscus/core/chunks.h"
#include "meniscus/geometry/four_triangles.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

/// What four triangles contribute.
struct FourFaces {
  FourVectors area_vector;
  std::array<Four, 3> cotangent, area;
};

/// Area vectors, cotangents and mixed Voronoi areas of four triangles a, b, c.
FourFaces face_geometry(const FourVectors& a, const FourVectors& b, const FourVectors& c) {
  const FourVectors u = b - a, w = c - a, cross = u.cross(w);
  const Four uu = u.dot(u), ww = w.dot(w), uw = u.dot(w);
  const Four area = 0.5 * square_root(cross.dot(cross));
  const Four zero{};
  const Four s = area <= 0 ? zero : 0.5 / area;  // cot = dot / |cross|
  const Four cot_a = uw * s, cot_b = (uu - uw) * s, cot_c = (ww - uw) * s;
  const Four vv = uu + ww - 2 * uw;  // |bc|^2
  const Four ab = uu * cot_c * 0.125, ac = ww * cot_b * 0.125, bc = vv * cot_a * 0.125;
  const Four half = 0.5 * area, quarter = 0.25 * area;
  const auto obtuse = [&](const Four& own, const Four& other, const Four& third, const Four& voronoi) -> Four {
    return own < 0 ? half : other < 0 ? quarter : third < 0 ? quarter : voronoi;
  };
  return {{0.5 * cross.x, 0.5 * cross.y, 0.5 * cross.z},
          {cot_a, cot_b, cot_c},
          {obtuse(cot_a, cot_b, cot_c, ab + ac), obtuse(cot_b, cot_a, cot_c, ab + bc),
           obtuse(cot_c, cot_a, cot_b, ac + bc)}};
}

void store(const FourFaces& four, FaceGeometry* faces, std::size_t count) {
  for (std::size_t k = 0; k < count; ++k) {
    FaceGeometry& face = faces[k];
    face.area_vector = {four.area_vector.x[k], four.area_vector.y[k], four.area_vector.z[k]};
    for (std::size_t corner = 0; corner < 3; ++corner) {
      face.cotangent[corner] = four.cotangent[corner][k];
      face.area[corner] = four.area[corner][k];
    }
  }
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
  if (x.cols() == 0 || triangles.empty()) {
    area_ = volume_ = 0;
    return;
  }
  const FourVectors origin = constant(x.col(0));
  const Sums sums = sum_over_chunks(triangles.size(), Sums{}, [&](std::size_t begin, std::size_t end) {
    Four area{}, volume{};
    for (std::size_t f = begin; f < end; f += 4) {
      const FourTriangles four(triangles, f, end);
      const FourVectors a = four.corner(x.data(), 0);
      const FourFaces faces = face_geometry(a, four.corner(x.data(), 1), four.corner(x.data(), 2));
      area += faces.area[0] + faces.area[1] + faces.area[2];
      volume += (a - origin).dot(faces.area_vector);
      if (end - f >= 4)
        store(faces, &faces_[f], 4);
      else
        store(faces, &faces_[f], end - f);
    }
    return Sums{sum(area), sum(volume)};
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
  set_area_vector(v, sum);
  area_gradient_[v] = gradient;
  lumped_area_[v] = area;
}

void SurfaceGeometry::compute(const ConstColumns& x, const Connectivity& connectivity) {
  const std::size_t n = connectivity.num_rows();
  faces_.resize(connectivity.triangles().size());
  for (auto* array : {&area_vector_, &normal_, &area_gradient_}) array->resize(n);
  lumped_area_.resize(n);
  edge_weights_.weight.resize(Connectivity::width * n);
  edge_weights_.fit_long_rings(connectivity);
  compute_faces(x, connectivity);
  for_each_chunk(n, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) compute_vertex(x, connectivity, static_cast<std::uint32_t>(v));
  });
}

double enclosed_volume(const ConstColumns& x, const Connectivity& connectivity) {
  if (x.cols() == 0) return 0;
  const FourVectors origin = constant(x.col(0));
  const auto& triangles = connectivity.triangles();
  return sum_over_chunks(triangles.size(), 0.0,
                         [&](std::size_t begin, std::size_t end) {
                           Four volume{};
                           for (std::size_t f = begin; f < end; f += 4) {
                             const FourTriangles four(triangles, f, end);
                             const FourVectors a = four.corner(x.data(), 0) - origin;
                             const FourVectors b = four.corner(x.data(), 1) - origin;
                             const FourVectors c = four.corner(x.data(), 2) - origin;
                             volume += a.dot(b.cross(c));
                           }
                           return sum(volume);
                         }) /
         6;
}

}  // namespace meniscus
