// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/topology/boolean.h"

#include <Eigen/Geometry>

#include <array>
#include <vector>

namespace meniscus {

/// A triangle and its closed box.
struct FaceBox {
  Eigen::AlignedBox3d box;
  std::uint32_t face;
};

/// Two triangles, the first with the smaller index.
using FacePair = std::array<std::uint32_t, 2>;

/// Boxes in the cells of a regular grid, to find those that meet a given one. Made for many boxes of
/// like size; others cost time, not correctness.
class FaceGrid {
 public:
  /// Keeps a reference to the boxes.
  explicit FaceGrid(const std::vector<FaceBox>& boxes);

  /// Calls visit(box) for every box of the grid that meets `query`, each once, until it returns
  /// false; then returns false too. The order depends on nothing but the boxes.
  template <class Visit>
  bool for_each_meeting(const Eigen::AlignedBox3d& query, Visit visit) const {
    if (boxes_.empty() || !extent_.intersects(query)) return true;
    const Eigen::Array3i low = cell(query.min()), high = cell(query.max());
    for (int z = low.z(); z <= high.z(); ++z)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int x = low.x(); x <= high.x(); ++x) {
          const std::size_t c = index(x, y, z);
          for (std::uint32_t k = first_[c]; k < first_[c + 1]; ++k) {
            const FaceBox& other = boxes_[entries_[k]];
            if (!other.box.intersects(query)) continue;
            const Eigen::Array3i home = cell(other.box.min().cwiseMax(query.min()));  // so that each is seen once
            if (home.x() == x && home.y() == y && home.z() == z && !visit(other)) return false;
          }
        }
    return true;
  }

  /// Calls visit(index) for every cell that a box reaches into; what lies outside of the grid counts to its outermost
  /// cells.
  template <class Visit>
  void for_each_cell(const Eigen::AlignedBox3d& box, Visit visit) const {
    const Eigen::Array3i low = cell(box.min()), high = cell(box.max());
    for (int z = low.z(); z <= high.z(); ++z)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int x = low.x(); x <= high.x(); ++x) visit(index(x, y, z));
  }
  std::size_t num_cells() const { return first_.empty() ? 1 : first_.size() - 1; }

 private:
  Eigen::Array3i cell(const Eigen::Vector3d& p) const {
    const Eigen::Array3d at = (p - extent_.min()).array() * per_length_;
    return at.max(0.0).min((cells_ - 1).cast<double>()).cast<int>();
  }
  std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * cells_.y() + y) * cells_.x() + x;
  }
  bool try_cells(double cell_size);

  const std::vector<FaceBox>& boxes_;
  Eigen::AlignedBox3d extent_;
  Eigen::Array3d per_length_ = Eigen::Array3d::Zero();
  Eigen::Array3i cells_ = Eigen::Array3i::Ones();
  std::vector<std::uint32_t> first_, entries_;
};

inline Eigen::AlignedBox3d box_of(const MeshView& view, const Triangle& t) {
  const Eigen::Vector3d a = view.points.col(t[0]), b = view.points.col(t[1]), c = view.points.col(t[2]);
  return {a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
}

/// The box of all triangles of a view; empty if there are none.
Eigen::AlignedBox3d box_of(const MeshView& view);

/// The triangles whose boxes meet `region`.
std::vector<FaceBox> faces_in(const MeshView& view, const Eigen::AlignedBox3d& region);

}  // namespace meniscus
