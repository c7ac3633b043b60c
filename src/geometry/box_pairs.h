// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>

#include <cstdint>
#include <functional>
#include <vector>

namespace meniscus {

/// Calls visit(i, j) once for every two boxes that meet, until it returns false. Boxes are closed and
/// must be finite. The order is the same in every run.
void for_each_pair_of_boxes(const std::vector<Eigen::AlignedBox3d>& boxes,
                            const std::function<bool(std::uint32_t, std::uint32_t)>& visit);

}  // namespace meniscus
