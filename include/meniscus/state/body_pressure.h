// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/drop.h"

namespace meniscus {

/// The pressure in a drop, over the surface tension (1/cm): mean + gradient . (x - center). The surface
/// is at rest where its curvature K equals it (Young-Laplace). Zero by default.
struct BodyPressure {
  double mean = 0;                                     ///< 1/cm
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  ///< rho g/sigma, 1/cm^2: gravity on a drop that a solid holds
  Eigen::Vector3d center = Eigen::Vector3d::Zero();    ///< cm

  double at(const Eigen::Vector3d& x) const { return mean + gradient.dot(x - center); }
};

/// The mean that keeps the volume: the curvature less the gradient's part, averaged over the free surface
/// (by virtual work of a uniform offset: sum n.(L x - b w) / sum n.w, w = dV/dx). Cotangent weights
/// below zero count as zero, as in the flow. Zero if the drop has no free surface.
double mean_pressure(const Drop& drop, const SurfaceGeometry& geometry, const BodyPressure& pressure);

}  // namespace meniscus
