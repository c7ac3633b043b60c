// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/drop.h"

#include <array>

namespace meniscus::bench {

/// Ways to take a step x' = -gamma K n of pure curvature flow; M mixed Voronoi areas, L cotangent stiffness.
enum class Flow {
  explicit_euler,      ///< x -= s M^-1 L x
  implicit,            ///< (M + s L) x_new = M x: the paper's Eq 6, this project's operator
  clamped,             ///< the same, negative weights taken as zero: this project's operator for `calibrated`
  fixed_stiffness,     ///< L of the first step kept, M of each (Kazhdan, Solomon and Ben-Chen 2012)
  intrinsic_delaunay,  ///< L of the intrinsic Delaunay triangulation of each step's surface (Fisher et al. 2007)
  extrinsic_delaunay,  ///< edges of negative weight flipped in the mesh before each step, where legal
};
inline constexpr std::array<const char*, 6> flow_names{"explicit",        "implicit (paper)",   "clamped weights",
                                                       "fixed stiffness", "intrinsic Delaunay", "extrinsic Delaunay"};

/// Steps one drop by one method, s = gamma dt (cm^2) a step. Throws NumericsError if a solve fails.
class PureFlow {
 public:
  PureFlow(Flow flow, double s) : flow_(flow), s_(s) {}
  void step(Drop& drop);

 private:
  void step_fixed(Drop& drop);

  Flow flow_;
  double s_;
  RingMatrix first_;  // weights of the first step
  bool has_first_ = false;
};

}  // namespace meniscus::bench
