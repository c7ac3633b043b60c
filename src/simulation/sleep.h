// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/drop.h"
#include "meniscus/state/parameters.h"
#include "meniscus/state/solid.h"

#include <vector>

namespace meniscus {

/// When a drop sleeps: after it has moved by less than `speed` everywhere, without a change of its mesh, for
/// `seconds`. It then stands still until something comes near.
struct SleepOptions {
  double speed = 0;      ///< cm/s
  double seconds = 0.1;  ///< s
  double margin = 0;     ///< what is this near wakes it, cm
};

/// A tenth of edge_min a second; near is edge_max.
SleepOptions sleep_options(const EdgeBand& band);

bool is_asleep(const Drop& drop, const SleepOptions& options);

/// Counts a step of dt (s) that a drop took while awake; `changed`: its mesh changed. A drop that falls asleep loses
/// the velocity that it had left.
void count_rest(Drop& drop, double dt, bool changed, const SleepOptions& options);

/// Wakes the sleepers that a moving solid, or a drop that is not at rest, may reach in the step of dt that ends
/// at `time` (s). Looks at boxes, in the order of the drops: the outcome depends on nothing else.
void wake_drops(std::vector<Drop>& drops, const std::vector<Solid>& solids, double time, double dt,
                const SleepOptions& options);

}  // namespace meniscus
