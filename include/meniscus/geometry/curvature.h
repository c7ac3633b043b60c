// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/geometry/surface_geometry.h"

namespace meniscus {

/// K = kappa_1 + kappa_2 at each vertex (1/cm), positive where the surface is convex: 2/R on a
/// sphere. K = (L x . n) / M with the cotangent stiffness L (positive semidefinite, as in Eq 7), the
/// outward area-weighted normal n and the mixed Voronoi area M. Zero for removed vertices and for
/// those of zero area.
///
/// `geometry` must have been computed from these positions (3 x n, cm) and this connectivity.
std::vector<double> mean_curvature(const SurfaceGeometry& geometry, const ConstColumns& positions,
                                   const Connectivity& connectivity);

}  // namespace meniscus
