// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/simulation/step.h"

#include <functional>
#include <string>
#include <vector>

namespace meniscus {

/// Why a drop is not fit to go on after its operators ran, or "" if it is:
/// - a position or velocity is not finite,
/// - more than a twentieth of the surface turned over: faces whose normal turned by more than 90 degrees since `kept`,
///   the start of the substep,
/// - the surface is more than twice what it was,
/// - the volume went off its target by more than half of that since then.
/// The limits are far above what any sound substep does (docs/MODELS.md). One pass over faces, which marks violent ones
/// in workspace().violent_faces (find_face_changes); none while the drop's slack lasts, from which it draws.
std::string blow_up(Drop& drop, const KeptState& kept);

/// Too long steps of Level::paper crumple a drop in the air bit by bit, with nothing in any one substep that would take
/// it back; mending and remeshing then smooth the creases away, and a part of the drop with them. Throws NumericsError
/// if the drop and what was cut off it hold another volume than volume_before (cm^3), its volume before that; small
/// drops and drops on solids pass.
void check_not_crumpled(const Drop& drop, const std::vector<Drop>& cut_off, double volume_before, int id);

/// The operators of a substep: moves the drop from time - dt to time. Returns by what share of its target the volume
/// was off before it was corrected.
using Deform =
    std::function<double(Drop& drop, double time, double dt, const StepOptions& options, StepReport& report)>;

/// Runs `deform`; if the drop blew up or it threw NumericsError, takes the drop back and goes the same way in two
/// halves, each likewise, down to 1/64, and counts that in report.recoveries. So it does, down to 1/8, if the
/// correction had to take or give a fifth of the volume: the substep is too long for how the drop stretches. At
/// Level::paper gamma and alpha are per step: halves get half of them, so that the acceleration stays. What the drop
/// was at the start is then in workspace().kept, and the faces that are violent since then are marked. Throws
/// NumericsError when 1/64 fails too.
void deform_or_recover(Drop& drop, double time, double dt, const StepOptions& options, StepReport& report,
                       const Deform& deform);

}  // namespace meniscus
