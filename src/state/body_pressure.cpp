// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/state/body_pressure.h"

#include "meniscus/core/chunks.h"

namespace meniscus {
namespace {

using Eigen::Vector3d;

struct Sums {
  double work = 0, area = 0;

  Sums& operator+=(const Sums& other) {
    work += other.work;
    area += other.area;
    return *this;
  }
};

}  // namespace

double mean_pressure(const Drop& drop, const SurfaceGeometry& geometry, const BodyPressure& pressure) {
  const ConstColumns x = drop.positions();
  const Contact* contact = drop.contact();
  const Sums sums = sum_over_chunks(drop.num_rows(), Sums{}, [&](std::size_t begin, std::size_t end) {
    Sums part;
    for (auto v = static_cast<std::uint32_t>(begin); v < end; ++v) {
      if (drop.connectivity().degree(v) == 0 || is_colliding(contact[v])) continue;
      const Vector3d n = geometry.normal(v);
      const double share = n.dot(geometry.area_vector(v)) / 3;
      const double body = pressure.gradient.dot(x.col(v) - pressure.center);
      part.work += n.dot(geometry.area_gradient(v)) - body * share;
      part.area += share;
    }
    return part;
  });
  return sums.area > 0 ? sums.work / sums.area : 0;
}

}  // namespace meniscus
