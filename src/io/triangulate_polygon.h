// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace meniscus::io {

/// Appends the n - 2 triangles of a polygon of n >= 4 corners (indices into `points`), oriented as it is.
///
/// A strictly convex polygon is cut as a fan from its first corner; any other by clipping ears, seen
/// along the axis closest to its Newell normal, with exact predicates. The triangles do not overlap
/// if the polygon is simple in that view; where it has no ear (it crosses itself, is flat, or is not
/// finite) the rest becomes a fan. Takes time O(n^2) at most.
/// False, and nothing appended, if the polygon is not convex and has more than 10,000 corners.
bool triangulate_polygon(const std::vector<std::array<double, 3>>& points, const std::vector<std::uint32_t>& corners,
                         std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace meniscus::io
