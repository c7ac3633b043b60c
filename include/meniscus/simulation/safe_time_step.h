// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/simulation/step.h"

#include <vector>

namespace meniscus {

/// The longest time step (s) inside the region where, by measurement, a level
/// does not blow up on these drops (docs/ACCURACY.md, `meniscus bench
/// stability`); infinite without drops.
///
/// paper: gamma dt stays below a share of the squared middle of the edge band,
/// and below a share of the squared radius of the smallest drop. The step is
/// not cut, since at this level the motion depends on it. Others: as many
/// substeps as step_drop takes at most, each within its limits for the smallest
/// drop.
double safe_time_step(const StepOptions& options, const std::vector<Drop>& drops);

/// The longest substep (s) for a drop of this ball radius (cm) at a level that
/// cuts its steps; infinite at `paper` and without surface tension.
/// `near_solid` is whether it may touch a solid within the step.
double longest_substep(const StepOptions& options, double ball_radius, bool near_solid);

/// step_drop takes at most so many substeps.
inline constexpr int most_substeps = 256;

}  // namespace meniscus
