// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/drop.h"

namespace meniscus {

struct DampingOptions {
  double damping_rate = 0;           ///< mu, 1/s, >= 0
  double viscosity_coefficient = 0;  ///< eta, cm^2/s, >= 0
  /// Share (0..1) of its neighbours' mean velocity that a vertex of poor quality takes on: the
  /// paper's extra viscosity where remeshing could not mend the mesh.
  double poor_quality_smoothing = 0.5;
  SolverOptions solver;  ///< for viscosity beyond the explicit limit
};

/// How a damping step was taken.
struct DampingReport {
  bool implicit = false;     ///< viscosity was beyond the explicit limit and was solved for
  SolveReport solve;         ///< of that solve
  std::size_t smoothed = 0;  ///< vertices with extra viscosity
};

/// Damping and viscosity (Eq 3 of the paper): v = (1 - mu dt) v + eta dt Lap(v), with
/// Lap = -M^-1 L. The first factor is kept at or above zero. The second term is explicit as in the
/// paper while eta dt max_i(L_ii / M_ii) <= 1/2 and otherwise implicit, (M + eta dt L) v_new = M v,
/// so that it is stable at any dt.
///
/// Reads positions, `geometry` (of the current positions), contact state and poor quality marks;
/// writes velocities. Colliding vertices keep their velocity along the solid's normal.
/// Throws NumericsError if an implicit solve does not converge.
DampingReport apply_damping(Drop& drop, const SurfaceGeometry& geometry, double dt, const DampingOptions& options);

}  // namespace meniscus
