// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/types.h"
#include "meniscus/state/solid.h"

#include <optional>

namespace meniscus {

/// A cap at its contact angle (radians, through the liquid) about the point of a solid's surface nearest to
/// `near`, with the volume of a ball of radius `ball_radius` (cm). It is made on the tangent plane there; then each
/// vertex goes as high above the surface as it was above the plane. Nothing if the solid bends or ends so near
/// that the cap would not fit: some part of its foot moves by more than 0.3 of the contact radius.
std::optional<Mesh> place_cap(const Solid& solid, const Eigen::Vector3d& near, double ball_radius, double angle,
                              double edge_length);

/// The angle at which a drop is laid on a solid if none is given: midway between its two.
double resting_angle(const Solid& solid);

}  // namespace meniscus
