// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/drop.h"
#include "meniscus/state/solid.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace meniscus {

/// cm: vertices this near to a solid touch it.
inline constexpr double touching_distance = 1e-9;

/// Puts free vertices that sank into a solid through the drop's own wetted area, or touch that, above it again, by 0.02
/// of the mean length of their edges: in between there is liquid, too thin for the mesh to show. So, too, those so low
/// over a convex solid that it would come through their faces. What sank in beside the wetted area is left to the next
/// step's collisions. For the end of a substep, after operators that move the free surface without looking at solids.
/// Not in the paper.
///
/// Reads contact state and solids at `time` (s); writes positions (cm) of free vertices,
/// and takes from their velocities (cm/s) what would go into the solid. Vertices up to `low` (cm) above the
/// wetted area lose that speed, too. Both are marked in workspace().films. What is deep behind a source's disc passes
/// there; a drop that touches nothing is left as it is.
void lift_films(Drop& drop, const std::vector<Solid>& solids, double time, double low = 0);

/// The same for vertices that a step has just put on a solid: those of `landed` that came down through the drop's own
/// wetted area are above it and free. The wetted area is that of the faces whose three vertices `was_wetted` (one a
/// row); without it a falling top would lie flat on the bottom, and the two meet.
void lift_landed(Drop& drop, const std::vector<Solid>& solids, double time, const std::vector<std::uint32_t>& landed,
                 const std::vector<std::uint8_t>& was_wetted);

/// Free vertices that came through a source's disc from in front of it, where `before` has them (cm, by row), stop on
/// it: lift_films takes what is deep behind a disc for what passes there. Liquid that runs off a tilted disc does so.
/// What comes past the rim from the side passes.
/// Reads contact state and solids at `time` (s); writes positions (cm) of free vertices.
void stop_at_discs(Drop& drop, const std::vector<Solid>& solids, double time,
                   const std::function<Eigen::Vector3d(std::uint32_t)>& before);

}  // namespace meniscus
