// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/types.h"
#include "meniscus/geometry/connectivity.h"
#include "meniscus/geometry/solve_spd.h"

#include <array>
#include <vector>

namespace meniscus {

/// What one triangle contributes. All zero for a removed face.
struct FaceGeometry {
  std::array<double, 3> area_vector;  ///< outward normal times area, cm^2
  std::array<double, 3> cotangent;    ///< of the angle at each corner
  std::array<double, 3> area;         ///< each corner's share of the area (mixed Voronoi), cm^2
};

/// Per-face and per-vertex geometry of a closed mesh at one moment: computed in one pass over flat
/// arrays and shared by every operator of a step.
///
/// The mixed Voronoi shares are those of Meyer, Desbrun, Schroeder and Barr ("Discrete
/// differential-geometry operators in nD", reference [28] of the paper): they are positive and sum
/// to the triangle's area, so the lumped mass is positive on any mesh.
class SurfaceGeometry {
 public:
  /// Reads positions (3 x n, cm) and connectivity. A triangle of zero area gets cotangents of zero
  /// and a third of its (zero) area at each corner. Cost: two passes, no allocation unless the mesh grew.
  void compute(const ConstColumns& positions, const Connectivity& connectivity);

  /// Vertex v's area vector, and the normal that goes with it, where vertices have moved since: the rest stays as it
  /// was computed. Precondition: compute() was called for the mesh.
  void set_area_vector(std::uint32_t v, const Eigen::Vector3d& area_vector) {
    area_vector_[v] = area_vector;
    const double length = area_vector.norm();
    normal_[v] = length > 0 ? Eigen::Vector3d(area_vector / length) : Eigen::Vector3d::Zero();
  }

  const std::vector<FaceGeometry>& faces() const { return faces_; }
  /// Sum of the area vectors around vertex v: three times the gradient of the volume (cm^2).
  Eigen::Vector3d area_vector(std::uint32_t v) const { return area_vector_[v]; }
  /// Outward unit normal, area weighted; zero for a removed vertex.
  Eigen::Vector3d normal(std::uint32_t v) const { return normal_[v]; }
  /// All of them, 3 x n.
  ConstColumns normals() const {
    return {normal_.empty() ? nullptr : normal_.front().data(), static_cast<Eigen::Index>(normal_.size())};
  }
  /// The vertex's lumped area (cm^2), mixed Voronoi; zero for a removed vertex.
  double lumped_area(std::uint32_t v) const { return lumped_area_[v]; }
  /// The half sums of cotangents: edge k of ring v weighs weight[8 v + k] = (cot alpha + cot beta)/2, be it below zero;
  /// rings longer than 8 as in RingMatrix, the diagonal is not filled.
  const RingMatrix& edge_weights() const { return edge_weights_; }
  /// The gradient of the area at vertex v (cm), sum of w_k (x_v - x_k) over its ring, weights below zero as zero.
  Eigen::Vector3d area_gradient(std::uint32_t v) const { return area_gradient_[v]; }
  double area() const { return area_; }      ///< of the whole surface, cm^2
  double volume() const { return volume_; }  ///< enclosed, cm^3; negative if inside out

 private:
  void compute_faces(const ConstColumns& positions, const Connectivity& connectivity);
  void compute_vertex(const ConstColumns& positions, const Connectivity& connectivity, std::uint32_t v);

  std::vector<FaceGeometry> faces_;
  std::vector<Eigen::Vector3d> area_vector_, normal_, area_gradient_;
  RingMatrix edge_weights_;
  std::vector<double> lumped_area_;
  double area_ = 0, volume_ = 0;
};

/// The volume enclosed by a closed mesh (cm^3): the sum of x.N/3 over faces, about the first
/// vertex, so that a drop far from the origin loses no digits.
double enclosed_volume(const ConstColumns& positions, const Connectivity& connectivity);

}  // namespace meniscus
