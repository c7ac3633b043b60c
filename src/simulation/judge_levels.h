// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/simulation/choose_model.h"
#include "situation.h"

#include <string>
#include <vector>

namespace meniscus {

/// What the measurements say of one level.
struct LevelVerdict {
  Level level;
  bool is_met = true;   ///< it is known to be enough
  int substeps = 1;     ///< that it needs, or the scene's
  double cost = 0;      ///< of a step of the scene, ns a triangle
  double miss = 0;      ///< the worst figure in parts of what is asked for; for levels that are not enough
  std::string reasons;  ///< why it is enough
  std::string missed;   ///< the first reason why it is not
};

/// Every level that reads the scene's liquid.
std::vector<LevelVerdict> judge_levels(const Situation& situation, const AccuracyTarget& target);

}  // namespace meniscus
