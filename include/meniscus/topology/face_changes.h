// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/drop.h"

namespace meniscus {

/// What the operators of a substep did to the faces of a drop, in sums over them (cm^2, cm^3).
struct FaceChanges {
  double volume_before = 0, volume = 0;
  std::size_t violent = 0;           ///< faces that may fold soon: see find_face_changes
  double area_before = 0, area = 0;  ///< zero if no face is violent: then no edge grew by half
  double turned_area = 0;            ///< of faces whose normal turned by more than 90 degrees

  FaceChanges& operator+=(const FaceChanges& other);
};

/// Compares each face with what it was where its vertices were at `before` (3 x rows, cm), in one pass.
///
/// A face is violent if it turned over, or an edge of it turned or stretched by half its length, as where a drop
/// crumples or hits a solid; on a solid if it does not face it; elsewhere if it faces away from the normal at a vertex
/// (as of the last drop.workspace().geometry). `violent` becomes 1 at those, by face; it is left empty if there are
/// none.
FaceChanges find_face_changes(Drop& drop, const ConstColumns& before, std::vector<std::uint8_t>& violent);

}  // namespace meniscus
