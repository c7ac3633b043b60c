// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/drop.h"

#include <string>
#include <vector>

namespace meniscus {

/// What the judge finds wrong with a drop (state/judge.h), a velocity that is not finite included, or "".
std::string unsoundness(const Drop& drop);

/// Throws SoundnessError if a frame of these drops would be garbage: the judge finds one unsound (it meets itself,
/// say), a velocity is not finite, or, with `volume_is_kept`, all drops together hold 20 % more or less than their
/// target volumes. For runs with time steps outside of the safe region (safe_time_step), where a step may fail without
/// that anything in it does.
void check_frame(const std::vector<Drop>& drops, bool volume_is_kept);

}  // namespace meniscus
