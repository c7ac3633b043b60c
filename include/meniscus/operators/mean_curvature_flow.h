// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/body_pressure.h"
#include "meniscus/state/drop.h"

namespace meniscus {

/// What happens to vertices on a solid during curvature flow.
enum class ContactInFlow {
  slide,  ///< they flow with the rest and lose the part along the solid's normal (the paper)
  fixed,  ///< they stay; the contact angle operator alone moves the contact line
};

struct MeanCurvatureFlowOptions {
  double coefficient = 0.2;  ///< gamma, cm^2/s (Eq 4), >= 0
  ContactInFlow contact = ContactInFlow::fixed;
  /// Whether an edge's negative cotangent weight counts as zero, which keeps large steps from
  /// turning triangles over.
  bool clamp_negative_weights = true;
  /// Flows by the curvature K less this pressure: K = p + const at rest, Young-Laplace.
  BodyPressure body_pressure;
  /// eta, cm^2/s, >= 0: viscosity (Eq 3), taken in the same solve.
  double viscosity = 0;
  /// rad/s, about any centre: the rotation that viscosity leaves alone.
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();
  SolverOptions solver;
};

/// Implicit mean curvature flow (Eqs 4 to 7 of the paper): solves
/// (M + gamma dt L) X_new = M X_old for the displacement, (M + gamma dt L) d = -gamma dt L X_old,
/// starting from the last step's, then x += d and v += d/dt.
/// M: lumped areas (mixed Voronoi), L: cotangent stiffness, positive semidefinite.
///
/// A body pressure b adds gamma dt b(x_i) w_i to the right-hand side, w_i = dV/dx_i.
///
/// With viscosity the velocities follow v_new = v - (gamma L (x + d) + eta dt L (u + d/dt))/M with u = v less the
/// rotation, both terms by backward Euler: eta dt joins gamma dt in the matrix, and -eta dt^2 L u the right-hand side.
///
/// Reads positions, `geometry` (of the current positions) and contact state; writes positions,
/// velocities and displacements. gamma dt = eta dt = 0 does nothing. With dt = 0 the velocity is left alone.
/// Throws NumericsError if the solve does not converge.
SolveReport flow_by_mean_curvature(Drop& drop, const SurfaceGeometry& geometry, double dt,
                                   const MeanCurvatureFlowOptions& options);

}  // namespace meniscus
