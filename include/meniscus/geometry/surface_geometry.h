// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/types.h"
#include "meniscus/geometry/connectivity.h"

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

  const std::vector<FaceGeometry>& faces() const { return faces_; }
  /// Sum of the area vectors around vertex v: three times the gradient of the volume (cm^2).
  Eigen::Vector3d area_vector(std::uint32_t v) const { return area_vector_[v]; }
  /// Outward unit normal, area weighted; zero for a removed vertex.
  Eigen::Vector3d normal(std::uint32_t v) const { return normal_[v]; }
  /// The vertex's lumped area (cm^2), mixed Voronoi; zero for a removed vertex.
  double lumped_area(std::uint32_t v) const { return lumped_area_[v]; }
  double area() const { return area_; }      ///< of the whole surface, cm^2
  double volume() const { return volume_; }  ///< enclosed, cm^3; negative if inside out

 private:
  std::vector<FaceGeometry> faces_;
  std::vector<Eigen::Vector3d> area_vector_, normal_;
  std::vector<double> lumped_area_;
  double area_ = 0, volume_ = 0;
};

/// The volume enclosed by a closed mesh (cm^3): the sum of x.N/3 over faces, about the first
/// vertex, so that a drop far from the origin loses no digits.
double enclosed_volume(const ConstColumns& positions, const Connectivity& connectivity);

}  // namespace meniscus
