// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/types.h"
#include "meniscus/state/drop.h"
#include "watched_region.h"

#include <Eigen/Geometry>

#include <array>
#include <optional>
#include <unordered_map>
#include <vector>

namespace meniscus {

/// Keeps edge operations from making a surface meet itself where two of its sheets are close together:
/// near the seam of a merge, and on solids. Exact; from the first operation that reaches into its region on it knows
/// the faces that meet it, and those that operations make from them.
class SheetGuard {
 public:
  /// A face that an operation is about to make.
  struct NewFace {
    std::array<std::uint32_t, 3> vertices;  ///< vertices in common with other faces are not where they meet
    std::array<Eigen::Vector3d, 3> points;
  };

  /// Keeps a reference to the drop. `cell`: the length of the grid's cells, near that of an edge.
  SheetGuard(const Drop& drop, WatchedRegion region, double cell);
  SheetGuard(const SheetGuard&) = delete;
  SheetGuard& operator=(const SheetGuard&) = delete;

  /// Whether the new faces meet each other, or a face that stays: one that holds none of `replaced` vertices, or is
  /// not among the `removed` faces.
  bool would_meet(const std::vector<NewFace>& faces, const std::vector<std::uint32_t>& replaced,
                  const std::vector<std::uint32_t>& removed);

  /// Whether a point is in the region.
  bool covers(const Eigen::Vector3d& x) const { return region_.covers(x); }

  /// A face was made or moved. No matter if it is known already.
  void add(std::uint32_t face);

 private:
  using Cell = std::array<std::int64_t, 3>;
  struct Hash {
    std::size_t operator()(const Cell& c) const {
      return static_cast<std::size_t>(c[0] * 73856093 ^ c[1] * 19349663 ^ c[2] * 83492791);
    }
  };
  Cell cell_of(const Eigen::Vector3d& x) const;
  template <class Visit>
  void for_each_cell(const Eigen::AlignedBox3d& box, Visit visit) const;
  void learn_faces();
  /// Calls visit(face) for the known faces whose boxes may meet one, some twice, until it returns false; then returns
  /// false too.
  template <class Visit>
  bool for_each_near(const Eigen::AlignedBox3d& box, Visit visit) const;
  NewFace face_at(std::uint32_t face) const;

  const Drop& drop_;
  WatchedRegion region_;
  double cell_;
  std::vector<FaceBox> learnt_;  // where the faces were when an operation first asked: most calls of remeshing never do
  std::optional<FaceGrid> grid_;
  std::unordered_map<Cell, std::vector<std::uint32_t>, Hash> added_;  // those made or moved since
};

}  // namespace meniscus
