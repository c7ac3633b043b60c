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
constexpr double most_substeps = 64;

}  // namespace

Approach::Motion Approach::motion_of(const Drop& drop) {
  const ConstColumns v = drop.velocities();
  Motion motion;
  motion.velocity = mean_over_vertices(drop, v);
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i)
    if (drop.connectivity().degree(i) > 0)
      motion.spread = std::max(motion.spread, (v.col(i) - motion.velocity).squaredNorm());
  motion.spread = std::sqrt(motion.spread);
  motion.radius = ball_radius(drop);
  return motion;
}

/// Where a drop may be in the next dt, gravity aside: it moves all drops alike.
Eigen::AlignedBox3d Approach::swept_box(const Drop& drop, const Motion& motion, double dt) {
  const Eigen::AlignedBox3d box = bounding_box(drop);
  if (box.isEmpty()) return box;
  Eigen::AlignedBox3d swept = box.merged(box.translated(motion.velocity * dt));
  swept.min().array() -= motion.spread * dt;
  swept.max().array() += motion.spread * dt;
  return swept;
}

double Approach::substeps_for(const Motion& a, const Motion& b, double dt, double least_radius) {
  const double approach = ((a.velocity - b.velocity).norm() + a.spread + b.spread) * dt;
  return std::min(std::ceil(approach / (largest_approach * std::max(std::min(a.radius, b.radius), least_radius))),
                  most_substeps);
}

const std::vector<Cluster>& Approach::find_clusters(const std::vector<Drop>& drops, double dt, double least_radius) {
  motions_.resize(drops.size());
  boxes_.resize(drops.size());
  tbb::parallel_for(std::size_t{0}, drops.size(), [&](std::size_t d) {
    motions_[d] = motion_of(drops[d]);
    boxes_[d] = swept_box(drops[d], motions_[d], dt);
  });
  fast_.clear();
  clusters_.clear();
  substeps_.assign(drops.size(), 1);
  for (const auto& [i, j] : broad_phase_.find_pairs(boxes_)) {
    const double needed = substeps_for(motions_[i], motions_[j], dt, least_radius);
    if (!(needed > 1)) continue;
    fast_.push_back({i, j});
    substeps_[i] = std::max(substeps_[i], static_cast<int>(needed));
  }
  if (fast_.empty()) return clusters_;
  for (auto& group : groups_of(drops.size(), fast_)) {
    if (group.size() < 2) continue;
    Cluster cluster{std::move(group), 1};
    for (const std::uint32_t d : cluster.drops) cluster.substeps = std::max(cluster.substeps, substeps_[d]);
    clusters_.push_back(std::move(cluster));
  }
  return clusters_;
}

}  // namespace meniscus
