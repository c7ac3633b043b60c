// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/drop.h"

#include <cstdint>
#include <vector>

namespace meniscus {

class BroadPhase;

/// Drops that go through a step together, in `substeps` equal parts, each followed by merging.
struct Cluster {
  std::vector<std::uint32_t> drops;  ///< places in the list, ascending
  int substeps = 1;
};

/// Groups drops so that none pass through each other within a step of dt (s): those whose paths may meet
/// and that could come closer by more than a quarter of the smaller one's radius share a cluster, with
/// substeps in which they can not (at most 64); what is smaller than `least_radius` (cm) counts as if it were that
/// large. Every other drop is a cluster of its own. A path is the box of the drop swept by its mean velocity and
/// widened by the most that any vertex departs from it. Clusters are in the order of their first drops.
std::vector<Cluster> clusters_of_approaching_drops(const std::vector<Drop>& drops, double dt, double least_radius,
                                                   BroadPhase& broad_phase);

}  // namespace meniscus
