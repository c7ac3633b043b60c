// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/simulation/approaching.h"

#include "meniscus/simulation/broad_phase.h"
#include "step_parts.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

using Eigen::Vector3d;

/// The most that two drops may come closer in a substep, as a share of the smaller one's radius.
constexpr double largest_approach = 0.25;
constexpr double most_substeps = 64;

struct Motion {
  Vector3d velocity = Vector3d::Zero();  ///< the mean over vertices
  double spread = 0;                     ///< the most that a vertex departs from it, cm/s
  double radius = 0;                     ///< of the ball of the drop's volume, cm
};

Motion motion_of(const Drop& drop) {
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
Eigen::AlignedBox3d swept_box(const Drop& drop, const Motion& motion, double dt) {
  const Eigen::AlignedBox3d box = bounding_box(drop);
  if (box.isEmpty()) return box;
  Eigen::AlignedBox3d swept = box.merged(box.translated(motion.velocity * dt));
  swept.min().array() -= motion.spread * dt;
  swept.max().array() += motion.spread * dt;
  return swept;
}

double substeps_for(const Motion& a, const Motion& b, double dt, double least_radius) {
  const double approach = ((a.velocity - b.velocity).norm() + a.spread + b.spread) * dt;
  return std::min(std::ceil(approach / (largest_approach * std::max(std::min(a.radius, b.radius), least_radius))),
                  most_substeps);
}

}  // namespace

std::vector<Cluster> clusters_of_approaching_drops(const std::vector<Drop>& drops, double dt, double least_radius,
                                                   BroadPhase& broad_phase) {
  std::vector<Motion> motions(drops.size());
  std::vector<Eigen::AlignedBox3d> boxes(drops.size());
  tbb::parallel_for(std::size_t{0}, drops.size(), [&](std::size_t d) {
    motions[d] = motion_of(drops[d]);
    boxes[d] = swept_box(drops[d], motions[d], dt);
  });
  std::vector<std::array<std::uint32_t, 2>> fast;
  std::vector<int> substeps(drops.size(), 1);
  for (const auto& [i, j] : broad_phase.find_pairs(boxes)) {
    const double needed = substeps_for(motions[i], motions[j], dt, least_radius);
    if (!(needed > 1)) continue;
    fast.push_back({i, j});
    substeps[i] = std::max(substeps[i], static_cast<int>(needed));
  }
  std::vector<Cluster> clusters;
  for (auto& group : groups_of(drops.size(), fast)) {
    Cluster cluster{std::move(group), 1};
    for (const std::uint32_t d : cluster.drops) cluster.substeps = std::max(cluster.substeps, substeps[d]);
    clusters.push_back(std::move(cluster));
  }
  return clusters;
}

}  // namespace meniscus
