// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/types.h"
#include "meniscus/geometry/placed_triangle.h"
#include "meniscus/state/drop.h"
#include "watched_region.h"

#include <Eigen/Geometry>

#include <array>
#include <optional>
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

  /// Keeps a reference to the drop.
  SheetGuard(const Drop& drop, WatchedRegion region);
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

  /// A face is about to go away: nothing has to keep clear of it as long as it has the vertices that it has now.
  void forget(std::uint32_t face);

 private:
  /// A face that was made or moved, and the next of its cell (none: no_entry).
  struct Entry {
    std::uint32_t face, next;
  };
  static constexpr std::uint32_t no_entry = ~std::uint32_t{0};

  void learn_faces();
  /// The faces that stay and whose boxes may meet one, each once, into near_.
  void find_near(const Eigen::AlignedBox3d& box, const std::vector<std::uint32_t>& replaced,
                 const std::vector<std::uint32_t>& removed);

  const Drop& drop_;
  WatchedRegion region_;
  std::vector<FaceBox> learnt_;  // where the faces were when an operation first asked: most calls of remeshing never do
  std::optional<FaceGrid> grid_;
  std::vector<std::uint32_t> first_entry_;    // of each cell
  std::vector<Entry> entries_;                // faces made or moved since
  std::vector<Eigen::AlignedBox3d> entered_;  // by face: where its last entry has it
  std::vector<Triangle> forgotten_;           // by face, if any is: its vertices then, for its place may be used again
  std::vector<PlacedTriangle> new_, near_;    // of the operation at hand
  std::vector<std::uint32_t> seen_;           // by face: the last query that has looked at it
  std::uint32_t query_ = 0;
};

}  // namespace meniscus
