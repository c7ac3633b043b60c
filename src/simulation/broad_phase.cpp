// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/simulation/broad_phase.h"

#include "meniscus/core/index_sets.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <numeric>

namespace meniscus {
namespace {

/// Insertion sort: nearly nothing to do if the order is nearly right.
template <class Before>
void sort_again(std::vector<std::uint32_t>& order, Before before) {
  for (std::size_t i = 1; i < order.size(); ++i) {
    const std::uint32_t moving = order[i];
    std::size_t k = i;
    for (; k > 0 && before(moving, order[k - 1]); --k) order[k] = order[k - 1];
    order[k] = moving;
  }
}

}  // namespace

const std::vector<std::array<std::uint32_t, 2>>& BroadPhase::find_pairs(const std::vector<Eigen::AlignedBox3d>& boxes) {
  pairs_.clear();
  Eigen::AlignedBox3d all;
  for (const auto& box : boxes) all.extend(box);
  if (all.isEmpty()) return pairs_;
  Eigen::Index axis = 0;
  all.sizes().maxCoeff(&axis);
  if (order_.size() != boxes.size()) {
    order_.resize(boxes.size());
    std::iota(order_.begin(), order_.end(), 0u);
    std::sort(order_.begin(), order_.end(), [&](std::uint32_t i, std::uint32_t j) {
      return std::pair(boxes[i].min()[axis], i) < std::pair(boxes[j].min()[axis], j);
    });
  } else {
    sort_again(order_, [&](std::uint32_t i, std::uint32_t j) {
      return std::pair(boxes[i].min()[axis], i) < std::pair(boxes[j].min()[axis], j);
    });
  }
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const auto& box = boxes[order_[i]];
    if (box.isEmpty()) continue;
    for (std::size_t j = i + 1; j < order_.size() && boxes[order_[j]].min()[axis] <= box.max()[axis]; ++j)
      if (box.intersects(boxes[order_[j]])) {
        const auto [first, second] = std::minmax(order_[i], order_[j]);
        pairs_.push_back({first, second});
      }
  }
  std::sort(pairs_.begin(), pairs_.end());
  return pairs_;
}

const std::vector<std::array<std::uint32_t, 2>>& BroadPhase::find_pairs(const std::vector<Drop>& drops) {
  boxes_.resize(drops.size());
  tbb::parallel_for(std::size_t{0}, drops.size(), [&](std::size_t d) { boxes_[d] = bounding_box(drops[d]); });
  return find_pairs(boxes_);
}

std::vector<std::vector<std::uint32_t>> groups_of(std::size_t n,
                                                  const std::vector<std::array<std::uint32_t, 2>>& pairs) {
  IndexSets sets(n);
  for (const auto& [i, j] : pairs) sets.unite(i, j);
  std::vector<std::vector<std::uint32_t>> groups;
  std::vector<std::size_t> place(n, n);
  for (std::uint32_t i = 0; i < n; ++i) {
    std::size_t& group = place[sets.find(i)];
    if (group == n) {
      group = groups.size();
      groups.emplace_back();
    }
    groups[group].push_back(i);
  }
  return groups;
}

}  // namespace meniscus
