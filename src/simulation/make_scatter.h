// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/scene/scene.h"
#include "meniscus/state/solid.h"

#include <vector>

namespace meniscus {

/// A ball that holds a drop: center and radius, cm.
struct BoundingBall {
  Eigen::Vector3d center;
  double radius;

  /// Whether two balls are less than `gap` apart.
  bool is_near(const BoundingBall& other, double gap) const {
    const double reach = radius + other.radius + gap;
    return (center - other.center).squaredNorm() < reach * reach;
  }
};

/// The ball about the middle of a mesh's box that holds it.
BoundingBall bounding_ball(const Mesh& mesh);

/// The drops of a spec of shape scatter, largest first: their balls keep the spec's gap from each other and from those
/// in `taken`, which they join, and do not touch solids other than their own. Places come from a generator
/// that gives the same numbers everywhere (mt19937_64).
/// Throws UsageError if they do not fit in, saying how many did.
std::vector<Mesh> make_scatter(const Scene& scene, const DropSpec& spec, const std::vector<Solid>& solids,
                               std::vector<BoundingBall>& taken);

}  // namespace meniscus
