// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/mesh_data.h"

namespace meniscus {

/// How many of the other components each component lies in. `component` numbers the triangles;
/// all must be measurable and every component closed. Two components of which `crossing` holds the
/// pair (lower first, sorted) never count as one within the other.
std::vector<int> nesting_depths(const MeshData& data, const std::vector<std::uint32_t>& component,
                                std::size_t num_components, const std::vector<std::array<std::uint32_t, 2>>& crossing);

}  // namespace meniscus
