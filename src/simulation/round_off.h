// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/drop.h"
#include "meniscus/state/parameters.h"
#include "meniscus/state/solid.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace meniscus {

/// The drop is hardly larger than an edge: its mesh says how much liquid is there, and where, but not its shape.
bool is_speck(const Drop& drop, const EdgeBand& band);

/// A drop of not much more than a hundred faces, or a film so much thinner than its edges are long that it would have
/// torn: what becomes of it when no operator can step it any more does not depend on its shape. Not one of which a
/// number is not finite.
bool may_be_rounded_off(const Drop& drop, const EdgeBand& band);

/// The ball that holds a drop's target volume: what is left of one without a shape that no operator can step any more.
/// It is where the mean of the vertices gets to in dt (s) with their mean velocity, clear of the solids at `time` (s),
/// and touches nothing. Keeps that velocity, id, target volume and inflow.
Drop rounded_off(const Drop& drop, const std::vector<Solid>& solids, double time, double dt, const EdgeBand& band);

/// Rounds off a speck that meets itself, is turned over or has but four faces: few vertices leave no other way to mend
/// it. Looks at what changed only: drops whose topology version is not `version`, or that are watched for folds. And
/// rounds off a drop that may be and has been stuck for long (Drop::stuck_substeps).
/// Returns whether it did.
bool round_off_knot(Drop& drop, std::uint64_t version, const std::vector<Solid>& solids, double time,
                    const EdgeBand& band);

}  // namespace meniscus
