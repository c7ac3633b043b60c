// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/topology/boolean.h"

#include <Eigen/Geometry>

namespace meniscus {

/// The union of a solid with itself where its surface has folded over: a closed surface that crosses
/// itself is cut along the curves where it does, and what lies inside the liquid is taken away.
///
/// Looks at the faces that meet `region` only. Outcomes: `disjoint`, nothing crosses there and the result
/// is empty; `crossing`, with seam vertices that name two faces of the same mesh, on_a and on_b, kept_a the
/// old vertices and kept_b empty; `refused` (rounding) where the surface is not in general position, such as
/// a fold between faces that share a vertex. Air shut in by the fold is dropped unless `keep_cavities`.
/// The result is checked at the seam like that of boolean(). Precondition: a closed, finite mesh.
BooleanResult unite_with_itself(const MeshView& mesh, const Eigen::AlignedBox3d& region, bool keep_cavities);

}  // namespace meniscus
