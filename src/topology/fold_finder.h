// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/drop.h"
#include "sorted_boxes.h"

#include <cstdint>
#include <vector>

namespace meniscus {

/// Some faces of a drop, and which of them meet each other elsewhere than in what they share. When vertices move, the
/// faces at them belong to it, and those that these may then meet.
class FoldFinder {
 public:
  /// Keeps a reference to the drop, whose mesh must not change.
  FoldFinder(const Drop& drop, std::vector<FaceBox> faces);

  /// The vertex has another place now.
  void move(std::uint32_t v);
  /// Pairs of faces that meet, in order.
  const std::vector<FacePair>& meeting();

 private:
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  /// Of a face, which belongs to the list from then on.
  std::uint32_t place_of(std::uint32_t face);
  void add_faces_near_waiting();
  void look_again();
  Eigen::AlignedBox3d box_now(std::uint32_t face) const;

  const Drop& drop_;
  std::vector<FaceBox> faces_;                        // where they were at first
  const SortedBoxes boxes_;                           // theirs, without those that have joined since
  std::vector<std::uint32_t> place_;                  // of a face in the list
  std::vector<std::uint8_t> has_moved_, is_waiting_;  // has_moved_: or has joined since
  std::vector<std::uint32_t> waiting_;                // places of faces that have moved since the last look
  std::vector<FacePair> meeting_;
};

/// Which of the faces meet each other elsewhere than in what they share, in order.
std::vector<FacePair> faces_that_meet(const MeshView& mesh, const std::vector<FaceBox>& faces);

}  // namespace meniscus
