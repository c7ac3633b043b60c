// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/simulation/broad_phase.h"

#include <cstdint>
#include <vector>

namespace meniscus {

/// How a drop moves as a whole.
struct DropMotion {
  Eigen::Vector3d velocity;  ///< the mean over vertices, cm/s
  double spread;             ///< the most that a vertex departs from it, cm/s
  double radius;             ///< of the ball of the drop's volume, cm
};

/// Groups drops so that none pass through each other within a step: two drops may come closer by no more than a quarter
/// of the smaller one's radius before they are looked at again, once their boxes may meet; what is smaller than
/// `least_radius` (cm) counts as if it were that large. Keeps its working arrays from call to call, so that drops that
/// keep away from each other cost no allocation.
class Approach {
 public:
  /// Places in the list, at least two a cluster, ascending: those whose paths may meet within dt (s) and that could
  /// come closer by more than they may. Every other drop goes alone. A path is the box of the drop swept by its mean
  /// velocity and widened by the most that any vertex departs from it. Clusters are in the order of their first drops.
  /// The view is void after the next call.
  const std::vector<std::vector<std::uint32_t>>& find_clusters(const std::vector<Drop>& drops, double dt,
                                                               double least_radius);

 private:
  BroadPhase broad_phase_;
  std::vector<DropMotion> motions_;
  std::vector<Eigen::AlignedBox3d> boxes_;
  std::vector<std::array<std::uint32_t, 2>> fast_;
  std::vector<std::vector<std::uint32_t>> clusters_;
};

/// The longest step (s), at most dt, after which the drops of a cluster have to be looked at: the boxes of no two of
/// them meet before its end, or they come closer by no more than they may.
double longest_step(const std::vector<Drop>& drops, double dt, double least_radius);

}  // namespace meniscus
