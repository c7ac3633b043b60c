// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/simulation/step.h"

#include <vector>

namespace meniscus {

/// The longest time step (s) inside the region that was mapped as safe for one drop at a time (docs/ACCURACY.md;
/// `meniscus bench stability`): inside, a level did not blow up. It is that of the smallest drop, R the radius of the
/// ball of its volume; infinite without drops and without what moves them.
///
/// paper: 0.04 R^2/gamma in the air; zero with solids: drops that fall on them fold at every time step.
/// calibrated, pressure: 20 sqrt(rho R^3/sigma), the longest that was mapped: nothing failed; with solids no longer than
/// in which a drop moves by 128 R, for which the most substeps of a step do.
double safe_time_step(const StepOptions& options, const std::vector<Drop>& drops, const std::vector<Solid>& solids);

}  // namespace meniscus
