// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/geometry/solve_spd.h"
#include "meniscus/state/parameters.h"

#include <vector>

/// What the charts of docs/ACCURACY.md measured of the levels that read the scene's liquid, without units, so that it
/// holds for other drops. scripts/measurements makes the rows from docs/charts.
namespace meniscus {

/// omega dt, omega that of the drop's mode 2 by Rayleigh and dt one step of the model: what `phase` is below.

/// Mode 2 at 5 %, in the air.
struct MeasuredSwing {
  Level level;
  double phase;
  double triangles;
  double frequency_error;  ///< relative, beside Rayleigh's; NaN if it does not swing
  double kept_per_period;  ///< of the amplitude, without viscosity: exactly 1
  double ns_per_triangle;  ///< processor time of a step
};

/// A drop at rest on a plane without hysteresis.
struct MeasuredRest {
  Level level;
  double bond;  ///< rho g R^2/sigma, R the radius of the ball of the drop's volume
  double angle_deg;
  double edge_over_radius;  ///< edge_min/R
  double phase;
  double height_error;          ///< relative, beside Young-Laplace
  double contact_radius_error;  ///< likewise
  double ns_per_triangle;       ///< NaN if it did not come to rest
};

struct MeasuredCorrection {
  Level level;
  VolumeCorrectionMethod method;
  double volume_error;  ///< relative, the worst
  double cost;          ///< of a run, in parts of the cheapest at this level
};

/// Runs of the map of failure: spheroids on meshes from good to hopeless.
struct MeasuredHold {
  Level level;
  bool on_solid;  ///< in the air if not
  double weber;   ///< rho v^2 2R/sigma of the impact
  double phase;
  int runs, failures;
  int recovered;  ///< runs in which bad substeps were taken back and redone
};

/// The cost of a step in the air at a phase of 0.1.
struct MeasuredSize {
  Level level;
  double triangles;  ///< of a drop
  double ns_per_triangle;
};

struct MeasuredTolerance {
  Level level;
  double tolerance;
  double amplitude_off;  ///< of mode 2, in parts of the first amplitude, the most in a run
};

struct MeasuredSolver {
  SolverMethod method;
  double cost;  ///< time in parts of the fastest method's, the mean over systems
};

struct Measurements {
  std::vector<MeasuredSwing> swings;
  std::vector<MeasuredRest> rests;
  std::vector<MeasuredCorrection> corrections;
  std::vector<MeasuredHold> holds;
  std::vector<MeasuredSize> sizes;
  std::vector<MeasuredTolerance> tolerances;
  std::vector<MeasuredSolver> solvers;
};

const Measurements& measurements();

}  // namespace meniscus
