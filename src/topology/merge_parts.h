// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/ledger.h"
#include "meniscus/topology/merge.h"

#include <Eigen/Geometry>

namespace meniscus {

/// Calls of mend_folds for which the surface near a seam is watched.
inline constexpr std::uint8_t watched_calls = 30;
/// The same for a violent face.
inline constexpr std::uint8_t violent_watched_calls = 5;

/// Counts the watch of every vertex down; it does not end where another sheet of the surface is within `reach` (cm).
void count_down_watch(Drop& drop, double reach);

/// The drop that a Boolean result of a and b (or of a with itself) describes, its seam remeshed, with the given
/// ledger and target volume.
std::vector<Drop> rebuild(const Drop& a, const Drop& b, BooleanResult result, const Ledger& ledger,
                          double target_volume, const MergeOptions& options, Remesher& remesher, MergeReport& report);

/// The faces of a drop that meet a region, as a soup of the drop's rows.
MeshData soup_in(const Drop& drop, const Eigen::AlignedBox3d& region);

}  // namespace meniscus
