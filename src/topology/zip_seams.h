// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/topology/boolean.h"

#include <vector>

namespace meniscus {

/// Where two drops have just met, their surfaces part again at a sharp angle: a wedge of air, as thin as one likes,
/// around the neck. Its slivers and its two sheets, which still fly at each other, are what fails in the next
/// step. So the rings of faces beside the seam make way for a strip between the two sheets, as wide as
/// the gap is there: a neck that the mesh can hold. The strip takes the rings' place as far out as the mean gap is
/// `least_gap` (cm), or as near to that as the surface allows.
///
/// A seam stays as it is if `is_fixed` (by row: on a solid, say) holds for a vertex beside it, if its rings are no
/// annulus, or if the strip would meet the surface or another strip. Returns the rows at the strips' borders,
/// ascending; rows that are no longer needed are gone from the result, whose volume is measured anew.
std::vector<std::uint32_t> zip_seams(BooleanResult& result, const std::vector<std::uint8_t>& is_fixed,
                                     double least_gap);

}  // namespace meniscus
