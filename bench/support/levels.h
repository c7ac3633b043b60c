// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/parameters.h"

namespace meniscus::bench {

/// The levels that every chart and the map of failure measure: a new level joins with one line.
struct NamedLevel {
  const char* name;
  Level level;
};
inline constexpr NamedLevel levels[] = {
    {"paper", Level::paper},
    {"calibrated", Level::calibrated},
    {"pressure", Level::pressure},
};

}  // namespace meniscus::bench
