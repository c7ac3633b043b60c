// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/types.h"
#include "meniscus/geometry/connectivity.h"
#include "meniscus/geometry/solve_spd.h"
#include "meniscus/geometry/surface_geometry.h"

namespace meniscus {

/// A = M + s L of one implicit step of curvature flow (Eq 6 of the paper, s = gamma dt in cm^2):
/// M the lumped mixed Voronoi areas (cm^2), L the positive semidefinite cotangent stiffness, so that
/// an edge ij weighs weight = -A_ij = (s/2) (cot alpha + cot beta), the cotangents of the angles
/// opposite to it. A is exactly symmetric, to the last bit.
///
/// `clamp_negative` takes zero for the weight of an edge whose sum of cotangents is negative: A is
/// then an M-matrix and no vertex moves outside the hull of its ring. A row without area and weights
/// (a removed vertex, or one among faces of zero area) becomes a row of the identity.
/// Allocates nothing while the number of rows and long rings stands.
/// Preconditions: `geometry` is that of `connectivity`; s is finite and >= 0.
void assemble_flow_matrix(const Connectivity& connectivity, const SurfaceGeometry& geometry, double s,
                          bool clamp_negative, RingMatrix& matrix);

/// The right-hand side for the displacement: rhs_i = sum_k weight_k (x_k - x_i) = -s (L x)_i (cm^3),
/// with the weights of `matrix`; the fourth lane is zero. `rhs` holds one entry a row.
void curvature_right_hand_side(const Connectivity& connectivity, const RingMatrix& matrix,
                               const ConstColumns& positions, Lanes* rhs);

/// The same for any vectors in place of the positions: rhs_i = sum_k weight_k (y_k - y_i). One entry a row.
void weighted_differences(const Connectivity& connectivity, const RingMatrix& matrix, const Lanes* y, Lanes* rhs);

/// What a solve's tolerance left of the motion of the whole: the translation t (cm) for which solution + t gives sum M
/// (solution + t) = sum rhs, as the exact solution does where no row is fixed (L 1 = 0).
Eigen::Vector3d missing_translation(const SurfaceGeometry& geometry, const std::vector<Lanes>& rhs,
                                    const std::vector<Lanes>& solution);

}  // namespace meniscus
