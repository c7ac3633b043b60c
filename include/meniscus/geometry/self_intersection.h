// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/mesh_data.h"
#include "meniscus/core/types.h"

#include <algorithm>
#include <array>
#include <utility>

namespace meniscus {

/// Pairs of triangles of any soup that meet elsewhere than in a shared vertex or edge: triangles
/// that touch, too. Decided exactly. Pairs are sorted, the lower triangle first.
///
/// Triangles that are not measurable (see measure.h), that have no area, or that repeat the three
/// vertices of an earlier one take no part. Stops after `limit` pairs (which ones is the same in
/// every run). O(n log^2 n) plus the number of pairs whose boxes overlap.
std::vector<std::array<std::uint32_t, 2>> self_intersections(const MeshData& data, std::size_t limit);

/// Whether two triangles of positive area meet elsewhere than in the corners that they share, the first num_shared of
/// each: the exact test behind self_intersections. Precondition: 0 <= num_shared <= 2.
bool meet_elsewhere(const std::array<Point, 3>& s, const std::array<Point, 3>& t, int num_shared);

/// The same for triangles by index; point_of(v) is where vertex v is.
template <class PointOf>
bool meet_elsewhere(PointOf point_of, std::array<std::uint32_t, 3> s, std::array<std::uint32_t, 3> t) {
  int num_shared = 0;
  for (int k = 0; k < 3; ++k) {
    const auto found = std::find(t.begin() + num_shared, t.end(), s[k]);
    if (found == t.end()) continue;
    std::swap(s[k], s[num_shared]);
    std::swap(*found, t[num_shared]);
    ++num_shared;
  }
  return meet_elsewhere(std::array<Point, 3>{point_of(s[0]), point_of(s[1]), point_of(s[2])},
                        {point_of(t[0]), point_of(t[1]), point_of(t[2])}, num_shared);
}

}  // namespace meniscus
