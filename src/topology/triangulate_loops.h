// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/types.h"

#include <array>
#include <cstdint>
#include <vector>

namespace meniscus {

/// Corner k of a loop is points[loop[k]]; seen from the side that triangles shall face, outer loops
/// run counterclockwise and holes clockwise.
using Loops = std::vector<std::vector<std::uint32_t>>;

/// Cuts the region that the loops bound into triangles of their corners, all of positive area in
/// the plane. One loop: so that the thinnest triangle is as thick as can be, since a chord past
/// corners that are almost on it would cut what lies beyond them; holes, and more than 64 corners:
/// constrained Delaunay. Appends to `triangles`; returns false, having appended anything, if the
/// loops cross or touch each other or themselves.
bool triangulate_loops(const std::vector<Kernel::Point_2>& points, const Loops& loops,
                       std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace meniscus
