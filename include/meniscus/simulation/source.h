// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/drop.h"
#include "meniscus/state/parameters.h"
#include "meniscus/state/solid.h"

#include <vector>

namespace meniscus {

/// What sources did in a step.
struct FeedReport {
  double volume_added = 0;  ///< new drops' and Drop::inflow, cm^3
  std::size_t new_drops = 0;
};

/// Lets liquid flow from sources: solids with an inflow. A source's stream is a drop that hangs from its disc: what
/// touches the disc stays on it, with the velocity of the liquid there, and the drop's volume grows by speed times area
/// times time, to rounding. Where the stream breaks, what hangs on goes on being fed. If nothing hangs there, liquid
/// gathers until it is enough for a new drop: a cap of 60 to 120 degrees on the whole disc.
class SourceFeed {
 public:
  /// Feeds what flows in (from, to] (s) to `drops`. A new drop gets the id next_id++ and the velocity of the flow.
  FeedReport feed(std::vector<Drop>& drops, const std::vector<Solid>& solids, double from, double to,
                  const EdgeBand& band, int& next_id);
  /// What has flowed and waits for enough to make a drop of (cm^3).
  double waiting() const;

  /// For checkpoints: see frames/checkpoint_archive.h.
  template <class Self, class Archive>
  static void visit(Self& self, Archive& archive) {
    archive("waiting", self.waiting_);
  }

 private:
  std::vector<double> waiting_;  ///< by solid, cm^3
};

}  // namespace meniscus
