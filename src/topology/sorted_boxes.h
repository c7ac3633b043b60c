// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "face_grid.h"
#include "meniscus/core/chunks.h"
#include "meniscus/geometry/four_triangles.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace meniscus {

/// Boxes in the order of their lower ends along the longest side of what holds them all, four in a register: to find
/// those that meet each other, or a given one. For boxes of surfaces, of which a plane across meets few. Coordinates
/// are no NaN. Boxes are told of by their places in the list that they came in.
class SortedBoxes {
 public:
  using Pair = std::pair<std::uint32_t, std::uint32_t>;

  explicit SortedBoxes(const std::vector<FaceBox>& boxes);

  /// The pairs a < b of boxes that meet for which test(a, b) is true, each once. It is asked on all threads; the order
  /// depends on nothing but the boxes.
  template <class Test>
  std::vector<Pair> pairs_if(const Test& test) const {
    struct Found {
      std::vector<Pair> pairs;
      Found& operator+=(const Found& other) {
        pairs.insert(pairs.end(), other.pairs.begin(), other.pairs.end());
        return *this;
      }
    };
    constexpr std::size_t least_rows = 2048;
    return sum_over_chunks(
               order_.size(), Found{},
               [&](std::size_t begin, std::size_t end) {
                 Found part;
                 for (std::size_t i = begin; i < end; ++i)
                   look_behind(i, [&](std::uint32_t a, std::uint32_t b) {
                     if (test(a, b)) part.pairs.push_back({a, b});
                   });
                 return part;
               },
               least_rows)
        .pairs;
  }

  /// Calls visit(a) for every box that meets `query`.
  template <class Visit>
  void for_each_meeting(const Eigen::AlignedBox3d& query, Visit visit) const {
    const Row row = row_of(query);
    const auto first = std::lower_bound(quads_.begin(), quads_.end(), row.low[0],
                                        [](const Quad& quad, double low) { return quad.highest < low; });
    look_from(static_cast<std::size_t>(first - quads_.begin()), row, [&](std::size_t j) { visit(order_[j]); });
  }

 private:
  /// Four boxes; along [0] they are sorted. Behind the last come boxes that meet none.
  struct Quad {
    std::array<Four, 3> low, high;
    double highest;  // high[0] up to here
  };
  /// One, with its coordinates in the same order.
  struct Row {
    std::array<double, 3> low, high;
  };

  Row row_of(const Eigen::AlignedBox3d& box) const;

  /// Calls visit(j) for the boxes from quad `first` on that meet one.
  template <class Visit>
  void look_from(std::size_t first, const Row& own, Visit visit) const {
    const Four low_x = constant(own.low[0]), high_x = constant(own.high[0]);
    const Four low_y = constant(own.low[1]), high_y = constant(own.high[1]);
    const Four low_z = constant(own.low[2]), high_z = constant(own.high[2]);
    const std::size_t last = quads_.size();
    const Quad* const quads = quads_.data();
    for (std::size_t q = first; q < last && !(quads[q].low[0][0] > own.high[0]); ++q) {
      const Quad& other = quads[q];
      const auto meets = (other.low[0] <= high_x) & (other.high[0] >= low_x) & (other.low[1] <= high_y) &
                         (other.high[1] >= low_y) & (other.low[2] <= high_z) & (other.high[2] >= low_z);
      const unsigned lanes = lanes_where(meets);
      if (lanes == 0) continue;
      for (std::size_t k = 0; k < 4; ++k)
        if ((lanes >> k & 1) != 0) visit(4 * q + k);
    }
  }

  /// Calls visit(a, b), a < b, for box i and those behind it that meet it.
  template <class Visit>
  void look_behind(std::size_t i, const Visit& visit) const {
    const Quad& own = quads_[i / 4];
    const std::size_t k = i % 4;
    const Row row{{own.low[0][k], own.low[1][k], own.low[2][k]}, {own.high[0][k], own.high[1][k], own.high[2][k]}};
    look_from((i + 1) / 4, row, [&](std::size_t j) {
      if (j <= i) return;
      const auto [a, b] = std::minmax(order_[i], order_[j]);
      visit(a, b);
    });
  }

  Eigen::Index longest_axis_ = 0;     // of all of them
  std::vector<std::uint32_t> order_;  // places in the list
  std::vector<Quad> quads_;
};

}  // namespace meniscus
