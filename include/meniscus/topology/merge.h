// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/topology/boolean.h"
#include "meniscus/topology/remesh.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace meniscus {

struct MergeOptions {
  RemeshOptions remesh;     ///< of the seam; all other edges are in the band
  bool keep_air = false;    ///< air that the liquid shuts in stays as a cavity; else it is filled
  bool self_merge = false;  ///< drops that fold onto themselves fuse there; else only next to a fresh seam
};

/// What merging did, summed over pairs. Volumes in cm^3.
struct MergeReport {
  std::size_t merges = 0;     ///< pairs that became one
  std::size_t folds = 0;      ///< drops that fused with themselves
  std::size_t refused = 0;    ///< pairs that met and could not be united: they go on as they were
  std::size_t retries = 0;    ///< ladder steps of boolean() that failed
  std::size_t cuts = 0;       ///< necks that remeshing the seam cut
  std::size_t deleted = 0;    ///< pieces too small to go on as drops
  double overlap = 0;         ///< volume that both drops claimed: lost in the union, given back by an offset
  double air = 0;             ///< volume of the air that was filled

  MergeReport& operator+=(const MergeReport& other);
};

/// Unites two drops that meet (Section 5.1 of the paper): the Boolean union of their volumes, with the
/// velocities, contact states and every other vertex map carried over and the seam remeshed. The target
/// volumes add up, and so do the ledgers (see ledger.h): the overlap is given back by an offset of the
/// surface, linear momentum is kept to rounding. Where both drops wet the same plane, the seam ends in a
/// common contact line.
///
/// The result has a's id. It is one drop, more if remeshing the seam cut a neck, none if nothing was
/// left to go on. Nothing (std::nullopt) if the drops do not meet, or if the union was refused, which
/// `report` counts; both are then best left alone and tried again when they have moved.
std::optional<std::vector<Drop>> merge_drops(const Drop& a, const Drop& b, const MergeOptions& options,
                                             Remesher& remesher, MergeReport& report);

/// Unites a drop with itself where it has folded over: everywhere with options.self_merge, else near the
/// seam of a recent merge. There the two sheets beside the seam still move towards each other, and the
/// liquid goes on to fuse in the steps after the first touch. Watches a fresh seam for 30 calls.
///
/// Like merge_drops: volume, momentum and attributes are kept, and the result may be several drops. Nothing
/// if there is no fold, or if it could not be mended, which `report` counts as refused; it is tried again at
/// the next call.
std::optional<std::vector<Drop>> mend_folds(Drop& drop, const MergeOptions& options, Remesher& remesher,
                                            MergeReport& report);

}  // namespace meniscus
