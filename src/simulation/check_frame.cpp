// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/simulation/check_frame.h"

#include "meniscus/core/error.h"
#include "meniscus/state/judge.h"

#include <fmt/format.h>

#include <cmath>

namespace meniscus {
namespace {

constexpr double most_volume_error = 0.2;

}  // namespace

std::string unsoundness(const Drop& drop) {
  std::string defect = judge::defect(drop);
  if (defect.empty() && !drop.velocities().allFinite()) defect = "a velocity is not finite";
  return defect;
}

void check_frame(const std::vector<Drop>& drops, bool volume_is_kept) {
  double volume = 0, target = 0;
  for (const Drop& drop : drops) {
    if (const std::string defect = unsoundness(drop); !defect.empty())
      throw SoundnessError(fmt::format("drop {} is unsound: {}", drop.id(), defect));
    volume += drop.volume();
    target += drop.target_volume();
  }
  if (volume_is_kept && std::abs(volume - target) > most_volume_error * target)
    throw SoundnessError(fmt::format("the drops hold {:.0f} % {} than they ought to",
                                     100 * std::abs(volume / target - 1), volume < target ? "less" : "more"));
}

}  // namespace meniscus
