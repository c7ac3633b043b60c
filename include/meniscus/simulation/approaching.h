// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/simulation/broad_phase.h"

#include <cstdint>
#include <vector>

namespace meniscus {

/// Drops that go through a step together, in `substeps` equal parts, each followed by merging.
struct Cluster {
  std::vector<std::uint32_t> drops;  ///< places in the list, at least two, ascending
  int substeps = 1;
};

/// Groups drops so that none pass through each other within a step. Keeps its working arrays from call to call, so that
/// drops that keep away from each other cost no allocation.
class Approach {
 public:
  /// Those whose paths may meet within dt (s) and that could come closer by more than a quarter of the smaller one's
  /// radius share a cluster, with substeps in which they can not (at most 64); what is smaller than `least_radius` (cm)
  /// counts as if it were that large. Every other drop goes alone. A path is the box of the drop swept by its mean
  /// velocity and widened by the most that any vertex departs from it. Clusters are in the order of their first drops.
  /// The view is void after the next call.
  const std::vector<Cluster>& find_clusters(const std::vector<Drop>& drops, double dt, double least_radius);

 private:
  struct Motion {
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< the mean over vertices
    double spread = 0;                                   ///< the most that a vertex departs from it, cm/s
    double radius = 0;                                   ///< of the ball of the drop's volume, cm
  };
  static Motion motion_of(const Drop& drop);
  static Eigen::AlignedBox3d swept_box(const Drop& drop, const Motion& motion, double dt);
  static double substeps_for(const Motion& a, const Motion& b, double dt, double least_radius);

  BroadPhase broad_phase_;
  std::vector<Motion> motions_;
  std::vector<Eigen::AlignedBox3d> boxes_;
  std::vector<std::array<std::uint32_t, 2>> fast_;
  std::vector<int> substeps_;
  std::vector<Cluster> clusters_;
};

}  // namespace meniscus
