// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/simulation/approaching.h"

#include "step_parts.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

/// The most that two drops may come closer in a substep, as a share of the smaller one's radius.
constexpr double largest_approach = 0.25;
/// Of the time in which two boxes come together so much passes before drops are looked at: they deform on the way.
constexpr double share_of_gap = 0.75;

DropMotion motion_of(const Drop& drop) {
  const Eigen::Vector3d velocity = mean_over_vertices(drop, drop.velocities());
  return {velocity, top_speed(drop, velocity), ball_radius(drop)};
}

/// Where a drop may be in the next dt, gravity aside: it moves all drops alike.
Eigen::AlignedBox3d swept_box(const Drop& drop, const DropMotion& motion, double dt) {
  const Eigen::AlignedBox3d box = bounding_box(drop);
  if (box.isEmpty()) return box;
  Eigen::AlignedBox3d swept = box.merged(box.translated(motion.velocity * dt));
  swept.min().array() -= motion.spread * dt;
  swept.max().array() += motion.spread * dt;
  return swept;
}

/// How fast two drops may come closer (cm/s).
double speed_of_approach(const DropMotion& a, const DropMotion& b) {
  return (a.velocity - b.velocity).norm() + a.spread + b.spread;
}

/// How much closer two drops may come (cm).
double most_approach(const DropMotion& a, const DropMotion& b, double least_radius) {
  return largest_approach * std::max(std::min(a.radius, b.radius), least_radius);
}

}  // namespace

const std::vector<std::vector<std::uint32_t>>& Approach::find_clusters(const std::vector<Drop>& drops, double dt,
                                                                       double least_radius) {
  motions_.resize(drops.size());
  boxes_.resize(drops.size());
  tbb::parallel_for(std::size_t{0}, drops.size(), [&](std::size_t d) {
    motions_[d] = motion_of(drops[d]);
    boxes_[d] = swept_box(drops[d], motions_[d], dt);
  });
  fast_.clear();
  for (const auto& [i, j] : broad_phase_.find_pairs(boxes_))
    if (speed_of_approach(motions_[i], motions_[j]) * dt > most_approach(motions_[i], motions_[j], least_radius))
      fast_.push_back({i, j});
  clusters_.clear();
  if (fast_.empty()) return clusters_;
  for (auto& group : groups_of(drops.size(), fast_))
    if (group.size() > 1) clusters_.push_back(std::move(group));
  return clusters_;
}

double longest_step(const std::vector<Drop>& drops, double dt, double least_radius) {
  std::vector<DropMotion> motions;
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const Drop& drop : drops) {
    motions.push_back(motion_of(drop));
    boxes.push_back(bounding_box(drop));
  }
  double longest = dt;
  for (std::size_t i = 0; i < drops.size(); ++i)
    for (std::size_t j = i + 1; j < drops.size(); ++j) {
      const double speed = speed_of_approach(motions[i], motions[j]);
      const double way = std::max(most_approach(motions[i], motions[j], least_radius),
                                  share_of_gap * boxes[i].exteriorDistance(boxes[j]));
      if (speed * longest > way) longest = way / speed;
    }
  return longest;
}

}  // namespace meniscus
