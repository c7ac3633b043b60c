// SPDX-License-Identifier: GPL-3.0-or-later
#include "situation.h"

#include "step_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace meniscus {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Whether figures of drops on solids matter.
bool may_touch(const Scene& scene, const std::vector<Drop>& drops, const std::vector<Solid>& solids) {
  if (!scene.sources.empty()) return true;
  if (solids.empty()) return false;
  const auto moves = [](const SolidSpec& solid) { return !solid.keys.empty() || !solid.velocity.isZero(0); };
  if (!scene.gravity.isZero(0) || std::any_of(scene.solids.begin(), scene.solids.end(), moves)) return true;
  return std::any_of(drops.begin(), drops.end(), [&](const Drop& drop) {
    const ConstColumns x = drop.positions();
    Eigen::AlignedBox3d box;
    for (std::uint32_t v = 0; v < drop.num_rows(); ++v)
      if (drop.connectivity().degree(v) > 0) box.extend(Eigen::Vector3d(x.col(v)));
    const double reach = drop.velocities().isZero(0) ? ball_radius(drop) : infinity;  // a swing does not reach further
    return std::any_of(solids.begin(), solids.end(), [&](const Solid& s) { return s.is_near(box, 0, reach); });
  });
}

}  // namespace

Situation situation_of(const Scene& scene, const std::vector<Drop>& drops, const std::vector<Solid>& solids) {
  Situation s;
  s.may_touch = may_touch(scene, drops, solids);
  if (scene.given.substeps) s.substeps = scene.substeps;
  double smallest = infinity, largest = 0;
  const auto count = [&](double radius) {
    smallest = std::min(smallest, radius);
    largest = std::max(largest, radius);
  };
  for (const Drop& drop : drops) {
    count(ball_radius(drop));
    s.triangles += static_cast<double>(drop.mesh().number_of_faces()) / static_cast<double>(drops.size());
  }
  for (const SourceSpec& source : scene.sources) count(source.radius);
  if (std::isinf(smallest)) return s;
  const Liquid& liquid = scene.liquid;
  s.step_phase = std::sqrt(8 * liquid.surface_tension / (liquid.density * std::pow(smallest, 3))) * scene.time_step;
  s.edge_over_radius = scene.mesh.edge_min / smallest;
  const auto bond = [&](double radius) {
    const double weight = liquid.density * scene.gravity.norm() * radius * radius;
    return weight > 0 ? weight / liquid.surface_tension : 0;
  };
  s.least_bond = bond(smallest);
  s.most_bond = bond(largest);
  if (scene.solids.empty()) return s;
  s.least_angle_deg = 180;
  s.most_angle_deg = 0;
  for (const SolidSpec& solid : scene.solids) {
    s.least_angle_deg = std::min(s.least_angle_deg, solid.receding_angle * 180 / pi);
    s.most_angle_deg = std::max(s.most_angle_deg, solid.advancing_angle * 180 / pi);
  }
  return s;
}

}  // namespace meniscus
