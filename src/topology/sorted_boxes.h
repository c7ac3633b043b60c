// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "face_grid.h"
#include "meniscus/geometry/four_triangles.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace meniscus {

/// Boxes in the order of their lower ends along the longest side of what holds them all, four in a register: to find
/// all pairs that meet. For boxes of surfaces, of which a plane across meets few. Coordinates are no NaN.
class SortedBoxes {
 public:
  /// Keeps a reference to the boxes.
  explicit SortedBoxes(const std::vector<FaceBox>& boxes);

  /// Calls visit(a, b) for every two boxes that meet, a before b in the list, each pair once, until it returns false;
  /// then returns false too. The order depends on nothing but the boxes.
  template <class Visit>
  bool for_each_pair(Visit visit) const {
    for (std::uint32_t i = 0; i < order_.size(); ++i) {
      const Quad& own = quads_[i / 4];
      const auto lane = static_cast<int>(i % 4);
      const double end = own.high[0][lane];
      const Four low_y = constant(own.low[1][lane]), high_y = constant(own.high[1][lane]);
      const Four low_z = constant(own.low[2][lane]), high_z = constant(own.high[2][lane]);
      for (std::size_t q = (i + 1) / 4; q < quads_.size() && !(quads_[q].low[0][0] > end); ++q) {
        const Quad& other = quads_[q];
        const auto meets = (other.low[0] <= end) & (other.low[1] <= high_y) & (other.high[1] >= low_y) &
                           (other.low[2] <= high_z) & (other.high[2] >= low_z);
        if ((meets[0] | meets[1] | meets[2] | meets[3]) == 0) continue;
        for (int k = 0; k < 4; ++k) {
          const std::size_t j = 4 * q + static_cast<std::size_t>(k);
          if (meets[k] == 0 || j <= i) continue;
          const auto [a, b] = std::minmax(order_[i], order_[j]);
          if (!visit(boxes_[a], boxes_[b])) return false;
        }
      }
    }
    return true;
  }

 private:
  /// Four boxes; along [0] they are sorted. Behind the last come boxes that meet none.
  struct Quad {
    std::array<Four, 3> low, high;
  };

  const std::vector<FaceBox>& boxes_;
  std::vector<std::uint32_t> order_;  // places in the list
  std::vector<Quad> quads_;
};

}  // namespace meniscus
