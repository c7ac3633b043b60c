// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/drop.h"

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <vector>

namespace meniscus {

/// Which boxes of a list meet. Sorts along the axis of the greatest extent and keeps the order from call
/// to call, so that boxes that moved a little cost little.
class BroadPhase {
 public:
  /// All pairs i < j whose boxes meet (touching included), in ascending order. Empty boxes meet nothing.
  /// The view is void after the next call.
  const std::vector<std::array<std::uint32_t, 2>>& find_pairs(const std::vector<Eigen::AlignedBox3d>& boxes);
  /// The same for the boxes of drops.
  const std::vector<std::array<std::uint32_t, 2>>& find_pairs(const std::vector<Drop>& drops);
  /// Those boxes, of the last call with drops.
  const std::vector<Eigen::AlignedBox3d>& boxes() const { return boxes_; }

 private:
  std::vector<Eigen::AlignedBox3d> boxes_;
  std::vector<std::uint32_t> order_;
  std::vector<std::array<std::uint32_t, 2>> pairs_;
};

/// Indices 0 .. n - 1 in groups joined by pairs; groups in the order of their smallest index, each
/// ascending.
std::vector<std::vector<std::uint32_t>> groups_of(std::size_t n,
                                                  const std::vector<std::array<std::uint32_t, 2>>& pairs);

}  // namespace meniscus
