// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/geometry/curvature.h"

namespace meniscus {

std::vector<double> mean_curvature(const SurfaceGeometry& geometry, const ConstColumns& x,
                                   const Connectivity& connectivity) {
  Eigen::Matrix3Xd lx = Eigen::Matrix3Xd::Zero(3, x.cols());
  const auto& triangles = connectivity.triangles();
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    if (triangles[f][0] == Connectivity::removed) continue;
    for (int corner = 0; corner < 3; ++corner) {  // the corner's cotangent weighs the edge opposite
      const std::uint32_t i = triangles[f][(corner + 1) % 3], j = triangles[f][(corner + 2) % 3];
      const Eigen::Vector3d flux = 0.5 * geometry.faces()[f].cotangent[corner] * (x.col(i) - x.col(j));
      lx.col(i) += flux;
      lx.col(j) -= flux;
    }
  }
  std::vector<double> curvature(connectivity.num_rows(), 0.0);
  for (std::uint32_t v = 0; v < curvature.size(); ++v)
    if (geometry.lumped_area(v) > 0) curvature[v] = lx.col(v).dot(geometry.normal(v)) / geometry.lumped_area(v);
  return curvature;
}

}  // namespace meniscus
