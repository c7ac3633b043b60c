// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/simulation/broad_phase.h"
#include "meniscus/topology/merge.h"

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <vector>

namespace meniscus {

/// A drop that a step made and that has no number yet.
inline constexpr int no_id = -1;

/// Working arrays of remeshing, one set a thread.
using Remeshers = tbb::enumerable_thread_specific<Remesher>;

/// Unites all drops that meet (Section 5.1 of the paper): boxes first, then the exact test for pairs whose boxes
/// meet, then groups of drops that meet one another. Within a group every pair is tried, in the order of the
/// drops, until none is left to unite: ten drops on one become one.
///
/// A united drop takes the first one's place and id; what was cut off while its seam was remeshed comes
/// behind its group, with no_id. Drops whose centres of mass move apart are left alone: pieces that have just
/// pinched off. Groups stay in the order of their first drops. Drops whose union was refused stay as they
/// are. Groups are united in parallel, with the same result for any number of threads.
MergeReport merge_touching_drops(std::vector<Drop>& drops, BroadPhase& broad_phase, const MergeOptions& options,
                                 Remeshers& remeshers);

}  // namespace meniscus
