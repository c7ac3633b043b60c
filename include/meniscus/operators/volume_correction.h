// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/drop.h"
#include "meniscus/state/parameters.h"

#include <limits>

namespace meniscus {

enum class LocalCorrection {
  smooth_velocity,  ///< Eqs 9-11 as written: takes away the one-ring mean of the normal velocity
  local_pressure,   ///< takes away this step's curvature flow averaged over the drop's own length
};

struct VolumeCorrectionOptions {
  VolumeCorrectionMethod method = VolumeCorrectionMethod::global;
  LocalCorrection local = LocalCorrection::local_pressure;
  SolverOptions solver;  ///< of local_pressure
  /// The most that one step may offset the surface (cm), > 0, beyond what the last curvature flow
  /// (Drop::displacements) took away: what is left waits for the next.
  double offset_limit = std::numeric_limits<double>::infinity();
};

struct VolumeCorrectionReport {
  double relative_error_before = 0;  ///< (V - V_target) / V_target as the operator found it
  double relative_error = 0;         ///< as it left it; NaN if the method has no global part
  double offset = 0;                 ///< cm, of the global part
  bool limited = false;              ///< the offset was cut to offset_limit
};

/// Volume correction (Section 4.4 of the paper).
/// Local, smooth_velocity (Eqs 9-11): takes out the rigid velocity, averages the normal velocity over
/// one-rings and takes that out of velocities, and of positions what it moved in dt. It acts on all
/// the motion there is, at every step, so that oscillations creep instead.
/// Local, local_pressure: the same idea for the step's own change only. The normal part q of the
/// last curvature flow (Drop::displacements) is averaged by (M + r^2 L) q_bar = M q, r = 2 (3 V/A),
/// and q_bar n is taken back. Its flux is that of q, so that the flow keeps the volume to first order,
/// and mode n of a sphere keeps 1 - 1/(1 + 4 n (n + 1)) of its force at any dt and mesh.
/// Global: offsets the surface along its normals by d = (V_target - V)/A, by secants until the volume
/// fits, and adds d n/dt to the velocities, without which the correction diverges.
/// Colliding vertices take no part.
///
/// Reads `geometry` (normals and areas; that of the step's start will do), contact state and target
/// volume; writes positions and velocities. dt > 0.
/// Throws NumericsError if the solve of local_pressure does not converge.
VolumeCorrectionReport correct_volume(Drop& drop, const SurfaceGeometry& geometry, double dt,
                                      const VolumeCorrectionOptions& options);

}  // namespace meniscus
