// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/mesh_data.h"

namespace meniscus {

/// Pairs of triangles of any soup that meet elsewhere than in a shared vertex or edge: triangles
/// that touch, too. Decided exactly. Pairs are sorted, the lower triangle first.
///
/// Triangles that are not measurable (see measure.h), that have no area, or that repeat the three
/// vertices of an earlier one take no part. Stops after `limit` pairs (which ones is the same in
/// every run). O(n log^2 n) plus the number of pairs whose boxes overlap.
std::vector<std::array<std::uint32_t, 2>> self_intersections(const MeshData& data, std::size_t limit);

}  // namespace meniscus
