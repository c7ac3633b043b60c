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

/// Whether two triangles of positive area meet elsewhere than in a vertex or edge that they share by
/// index: the exact test behind self_intersections. Precondition: at most two common vertices.
bool meet_elsewhere(const std::vector<std::array<double, 3>>& points, std::array<std::uint32_t, 3> s,
                    std::array<std::uint32_t, 3> t);

}  // namespace meniscus
