// SPDX-License-Identifier: GPL-3.0-or-later
#include "sorted_boxes.h"

#include <limits>

namespace meniscus {

SortedBoxes::SortedBoxes(const std::vector<FaceBox>& boxes) : boxes_(boxes) {
  Eigen::AlignedBox3d extent;
  for (const FaceBox& box : boxes_) extent.extend(box.box);
  Eigen::Index longest = 0;
  if (!boxes_.empty()) extent.sizes().maxCoeff(&longest);
  std::vector<std::pair<double, std::uint32_t>> by_low_end;
  by_low_end.reserve(boxes_.size());
  for (std::uint32_t k = 0; k < boxes_.size(); ++k) by_low_end.emplace_back(boxes_[k].box.min()[longest], k);
  std::sort(by_low_end.begin(), by_low_end.end());
  const Four none = constant(std::numeric_limits<double>::infinity());
  quads_.assign((boxes_.size() + 3) / 4, {{none, none, none}, {none, none, none}});
  order_.reserve(boxes_.size());
  for (const auto& entry : by_low_end) {
    const std::size_t i = order_.size();
    const Eigen::AlignedBox3d& box = boxes_[entry.second].box;
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Index from = (longest + axis) % 3;
      quads_[i / 4].low[axis][i % 4] = box.min()[from];
      quads_[i / 4].high[axis][i % 4] = box.max()[from];
    }
    order_.push_back(entry.second);
  }
}

}  // namespace meniscus
