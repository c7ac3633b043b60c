// SPDX-License-Identifier: GPL-3.0-or-later
#include "sorted_boxes.h"

#include <limits>

namespace meniscus {

SortedBoxes::SortedBoxes(const std::vector<FaceBox>& boxes) {
  Eigen::AlignedBox3d extent;
  for (const FaceBox& box : boxes) extent.extend(box.box);
  if (!boxes.empty()) extent.sizes().maxCoeff(&longest_axis_);
  std::vector<std::pair<double, std::uint32_t>> by_low_end;
  by_low_end.reserve(boxes.size());
  for (std::uint32_t k = 0; k < boxes.size(); ++k) by_low_end.emplace_back(boxes[k].box.min()[longest_axis_], k);
  std::sort(by_low_end.begin(), by_low_end.end());
  const Four none = constant(std::numeric_limits<double>::infinity());
  quads_.assign((boxes.size() + 3) / 4, {{none, none, none}, {none, none, none}, 0});
  order_.reserve(boxes.size());
  double highest = -std::numeric_limits<double>::infinity();
  for (const auto& entry : by_low_end) {
    const std::size_t i = order_.size();
    const Row row = row_of(boxes[entry.second].box);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      quads_[i / 4].low[axis][i % 4] = row.low[axis];
      quads_[i / 4].high[axis][i % 4] = row.high[axis];
    }
    quads_[i / 4].highest = highest = std::max(highest, row.high[0]);
    order_.push_back(entry.second);
  }
}

SortedBoxes::Row SortedBoxes::row_of(const Eigen::AlignedBox3d& box) const {
  Row row{};
  for (int axis = 0; axis < 3; ++axis) {
    row.low[axis] = box.min()[(longest_axis_ + axis) % 3];
    row.high[axis] = box.max()[(longest_axis_ + axis) % 3];
  }
  return row;
}

}  // namespace meniscus
