// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/types.h"

#include <functional>
#include <vector>

/// Closed meshes of simple shapes, made by code: outward, deterministic, their vertices on the exact
/// surface, their edges near `edge_length` (cm). Shapes smaller than the edge get the fewest faces
/// that still close.
///
/// All throw UsageError for sizes or edge lengths that are not finite and positive, and for more
/// than 50 million faces; that is estimated before anything is allocated.
namespace meniscus {

/// A sphere: the icosahedron with each edge cut in `frequency` >= 1 equal arcs.
/// 10 n^2 + 2 vertices, all 6-valent but twelve.
Mesh make_icosphere(const Eigen::Vector3d& center, double radius, int frequency);

/// The icosphere whose mean edge is nearest to edge_length.
Mesh make_sphere(const Eigen::Vector3d& center, double radius, double edge_length);

/// An axis-aligned ellipsoid. Semi-axes within 1.5 of each other: an icosphere, stretched. Others:
/// rings about the axis that is least like the other two; where those differ (by q), edges stretch by
/// up to sqrt(q).
Mesh make_ellipsoid(const Eigen::Vector3d& center, const Eigen::Vector3d& semi_axes, double edge_length);

/// An axis-aligned box around `center`: welded grids, each square cut along a diagonal.
Mesh make_box(const Eigen::Vector3d& center, const Eigen::Vector3d& size, double edge_length);

/// The part of a ball on one side of a plane: a drop at rest on a solid. The flat bottom is centred
/// at `center`, `axis` is the solid's outward normal (any length > 0), contact_angle is in (0, pi),
/// measured through the liquid.
Mesh make_cap(const Eigen::Vector3d& center, const Eigen::Vector3d& axis, double contact_radius, double contact_angle,
              double edge_length);

/// A torus about the z axis. Throws UsageError too if minor >= major.
Mesh make_torus(const Eigen::Vector3d& center, double major, double minor, double edge_length);

/// Two balls joined by a neck, along z, centred at the origin; `length` is from tip to tip. The
/// profile is smooth (C1): ball, then a fillet arc of at most ball_radius that touches both the ball
/// and the neck's cylinder. Throws UsageError too unless neck_radius < ball_radius and the balls lie
/// far enough apart for the neck to be the narrowest place.
Mesh make_dumbbell(double length, double ball_radius, double neck_radius, double edge_length);

/// A piece of a meridian: (distance from the axis, height) for s in [0, 1], at any speed.
using ProfilePiece = std::function<Eigen::Vector2d(double s)>;

/// The solid of revolution about the z axis. The pieces join end to end, with the inside on their
/// left; their ends are kept, so that corners stay. The meridian starts and ends on the axis (a
/// distance below 1e-9 of the largest counts as 0), or is a closed curve that avoids it.
/// Throws UsageError too if it does neither, if pieces do not join, or if it crosses the axis.
Mesh make_surface_of_revolution(const std::vector<ProfilePiece>& meridian, double edge_length);

}  // namespace meniscus
