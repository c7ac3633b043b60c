// SPDX-License-Identifier: GPL-3.0-or-later
#include "sleep.h"

#include "step_parts.h"

#include <algorithm>

namespace meniscus {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

/// The drop's box, grown by `margin` to all sides.
AlignedBox3d box_of(const Drop& drop, double margin) {
  const AlignedBox3d box = bounding_box(drop);
  if (box.isEmpty()) return box;
  return {Vector3d(box.min().array() - margin), Vector3d(box.max().array() + margin)};
}

bool is_reached_by_solid(const AlignedBox3d& box, const std::vector<Solid>& solids, double time, double dt) {
  return std::any_of(solids.begin(), solids.end(), [&](const Solid& solid) {
    const double moved = (solid.offset(time) - solid.offset(time - dt)).norm();
    return moved > 0 && solid.is_near(box, time, moved);
  });
}

}  // namespace

SleepOptions sleep_options(const EdgeBand& band) {
  SleepOptions options;
  options.speed = 0.1 * band.edge_min;
  options.margin = band.edge_max;
  return options;
}

bool is_asleep(const Drop& drop, const SleepOptions& options) { return drop.rest_time() >= options.seconds; }

void count_rest(Drop& drop, double dt, bool changed, const SleepOptions& options) {
  const bool rests = !changed && top_speed(drop) < options.speed;
  drop.set_rest_time(rests ? drop.rest_time() + dt : 0);
  if (is_asleep(drop, options)) drop.velocities().setZero();
}

void wake_drops(std::vector<Drop>& drops, const std::vector<Solid>& solids, double time, double dt,
                const SleepOptions& options) {
  std::vector<AlignedBox3d> movers;
  for (const Drop& drop : drops)
    if (drop.rest_time() == 0) movers.push_back(box_of(drop, top_speed(drop) * dt));
  for (Drop& drop : drops) {
    if (!is_asleep(drop, options)) continue;
    const AlignedBox3d box = box_of(drop, options.margin);
    const bool reached =
        is_reached_by_solid(box, solids, time, dt) ||
        std::any_of(movers.begin(), movers.end(), [&](const AlignedBox3d& mover) { return mover.intersects(box); });
    if (reached) drop.set_rest_time(0);
  }
}

}  // namespace meniscus
