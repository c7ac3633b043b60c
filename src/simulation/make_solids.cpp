// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/simulation/simulation.h"

namespace meniscus {

std::vector<Solid> make_solids(const Scene& scene) {
  std::vector<Solid> solids;
  for (const SolidSpec& spec : scene.solids) {
    Solid solid = Solid::plane(spec.point, spec.normal);
    solid.name = spec.name;
    solid.advancing_angle = spec.advancing_angle;
    solid.receding_angle = spec.receding_angle;
    solid.friction_speed = spec.friction_speed;
    solids.push_back(solid);
  }
  return solids;
}

}  // namespace meniscus
