// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/drop.h"
#include "meniscus/state/parameters.h"
#include "meniscus/state/solid.h"

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace meniscus {

struct PressureOptions {
  Eigen::Vector3d gravity{0, 0, -981};  ///< cm/s^2
  Liquid liquid;
  double edge_min = 0.04;  ///< cm: what counts as a small displacement is a share of it, > 0
  double edge_max = std::numeric_limits<double>::infinity();  ///< cm: the longest edge, for Solid::rim_point
  double contact_line_friction = 1;                           ///< xi, g/(cm s): what a contact line that moves meets
  double tolerance = 1e-4;    ///< of the conjugate gradients, relative to the right-hand side
  int max_iterations = 1000;  ///< of the conjugate gradients
  /// Of the centre of mass of a drop in flight (cm/s), where it is known better than velocities on the surface tell:
  /// evening out the mesh and remeshing leave P/V of those a little off, of thin pieces much.
  std::optional<Eigen::Vector3d> velocity;
  double smoothing = 0.3;  ///< share of the way along the surface to the ring's centroid, a substep; 0: none
};

/// What a substep did.
struct PressureReport {
  int solves = 0;                    ///< linear systems: more than one where the contact line's state changed
  int iterations = 0;                ///< of conjugate gradients, over all of them
  double relative_volume_error = 0;  ///< V/V_target - 1 after it
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< with which a drop in flight goes on, cm/s
};

/// One substep of the level `pressure` (docs/MODELS.md): every force is the exact gradient of the
/// discrete energy sigma A_air - sigma cos(theta) A_wet + gravity, the unknown is one normal speed a
/// vertex, the drop moves as a whole by Newton, and the volume is a constraint of the solve.
///
/// Looks at the drop once; solve() may then be tried with shorter and shorter steps, and move() takes the
/// last one. Nothing of the drop changes before move() but the status of its contact line.
///
/// Reads and writes positions (cm), velocities (cm/s), contact state and line status; never changes
/// connectivity. Free vertices carry U + rotation x r + u n, line vertices their speed along the solid,
/// wetted ones the solid's velocity: velocities are all the state there is, beside the line status.
class PressureStep {
 public:
  /// `time` (s) is that of the drop's positions. An empty drop passes.
  PressureStep(Drop& drop, const std::vector<Solid>& solids, double time, const PressureOptions& options);

  /// The fastest deformation (cm/s) in the drop's velocities: a start for dt.
  double top_speed() const { return top_speed_; }
  /// The longest dt (s) that keeps a drop in flight from gaining energy: one radian of its lowest mode.
  /// Infinite on a solid, where the step damps.
  double longest_step() const { return longest_step_; }

  /// Solves for a step of dt (s, > 0). Returns whether the step is short enough: no vertex moves more than
  /// half of edge_min on its own, nor deeper than a fifth of it into a solid. If not, try a shorter one.
  /// Throws NumericsError if the conjugate gradients do not converge or a number is not finite.
  bool solve(double dt);

  /// Takes the step solved for last: moves the vertices, finds contact anew, evens the mesh along the
  /// surface, gives the volume its remainder and writes the velocities. Call it once, after solve().
  PressureReport move();

 private:
  bool is_short_enough(double dt) const;

  Drop& drop_;
  const std::vector<Solid>& solids_;
  PressureOptions options_;
  double time_, dt_ = 0, top_speed_ = 0, longest_step_ = std::numeric_limits<double>::infinity();
  PressureReport report_;
};

}  // namespace meniscus
