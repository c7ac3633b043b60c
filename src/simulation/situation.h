// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/scene/scene.h"
#include "meniscus/state/drop.h"
#include "meniscus/state/solid.h"

#include <optional>
#include <vector>

namespace meniscus {

/// What of a scene matters for the choice of a level.
struct Situation {
  double step_phase = 0;                             ///< omega time_step, omega that of mode 2 of the smallest drop
  double edge_over_radius = 0;                       ///< edge_min over the smallest drop's radius
  double triangles = 0;                              ///< of a drop, the mean
  bool may_touch = false;                            ///< a drop is on a solid, or may come to one
  double least_bond = 0, most_bond = 0;              ///< rho g R^2/sigma of the smallest and the largest drop
  double least_angle_deg = 90, most_angle_deg = 90;  ///< contact angles of the solids, receding to advancing
  std::optional<int> substeps;                       ///< if the scene gives them
};

Situation situation_of(const Scene& scene, const std::vector<Drop>& drops, const std::vector<Solid>& solids);

}  // namespace meniscus
