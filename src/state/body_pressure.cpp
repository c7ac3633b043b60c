// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/state/body_pressure.h"

#include <algorithm>

namespace meniscus {
namespace {

using Eigen::Vector3d;

/// (L x)_v: the gradient of the area at v.
Vector3d area_gradient(const Drop& drop, const SurfaceGeometry& geometry, std::uint32_t v) {
  const ConstColumns x = drop.positions();
  const auto& faces = geometry.faces();
  const Ring ring = drop.connectivity().ring(v);
  const auto cotangent = [&](int k, std::uint32_t offset) {  // of face k, at the corner `offset` after v's
    const std::uint32_t f = ring.corner[k] / 3, corner = ring.corner[k] - 3 * f;
    return faces[f].cotangent[(corner + offset) % 3];
  };
  Vector3d gradient = Vector3d::Zero();
  for (int k = 0, last = ring.degree - 1; k < ring.degree; last = k++) {
    const double weight = 0.5 * (cotangent(k, 2) + cotangent(last, 1));
    gradient += std::max(weight, 0.0) * (x.col(v) - x.col(ring.neighbour[k]));
  }
  return gradient;
}

}  // namespace

double mean_pressure(const Drop& drop, const SurfaceGeometry& geometry, const BodyPressure& pressure) {
  double work = 0, area = 0;
  for (std::uint32_t v = 0; v < drop.num_rows(); ++v) {
    if (drop.connectivity().degree(v) == 0 || is_colliding(drop.contact()[v])) continue;
    const Vector3d n = geometry.normal(v);
    const double share = n.dot(geometry.area_vector(v)) / 3;
    const double body = pressure.gradient.dot(drop.positions().col(v) - pressure.center);
    work += n.dot(area_gradient(drop, geometry, v)) - body * share;
    area += share;
  }
  return area > 0 ? work / area : 0;
}

}  // namespace meniscus
