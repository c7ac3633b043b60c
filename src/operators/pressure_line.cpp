// SPDX-License-Identifier: GPL-3.0-or-later
#include "pressure_arrays.h"

#include <cmath>

namespace meniscus {
namespace {

constexpr double rounding = 1e-4;  // of cosines

const Solid& solid_of(const Drop& drop, const std::vector<Solid>& solids, std::uint32_t v) {
  return solids[static_cast<std::size_t>(drop.contact_solid()[v])];
}

struct Cosines {
  double advancing, receding;
  /// The line sticks between the two.
  bool has_hysteresis() const { return receding - advancing > 1e-9; }
};

Cosines cosines(const Solid& solid) { return {std::cos(solid.advancing_angle), std::cos(solid.receding_angle)}; }

}  // namespace

void apply_line(const Drop& drop, const std::vector<Solid>& solids, double dt, double tension, PressureArrays& arrays) {
  const PressureSurface& surface = arrays.surface;
  arrays.rhs = arrays.rhs_without_line;
  for (std::uint32_t v = 0; v < surface.role.size(); ++v) {
    arrays.fixed[v] = !is_moving(surface.role[v]) || arrays.blocked[v] != 0;
    if (surface.role[v] != Role::line) continue;
    const Cosines bounds = cosines(solid_of(drop, solids, v));
    const LineStatus status = drop.line_status(v);
    if (bounds.has_hysteresis() && status == LineStatus::stuck)
      arrays.fixed[v] = 1;
    else
      arrays.rhs[v] += dt * tension * surface.wet_gradient[v] *
                       (status == LineStatus::receding ? bounds.receding : bounds.advancing);
  }
}

std::size_t update_line(Drop& drop, const std::vector<Solid>& solids, double dt, double tension, double pressure,
                        PressureArrays& arrays) {
  const PressureSurface& surface = arrays.surface;
  std::size_t changed = 0;
  for (std::uint32_t v = 0; v < surface.role.size(); ++v) {
    if (surface.role[v] != Role::line) continue;
    const Cosines bounds = cosines(solid_of(drop, solids, v));
    if (!bounds.has_hysteresis()) continue;
    const LineStatus status = drop.line_status(v);
    LineStatus next = status;
    if (status == LineStatus::stuck) {
      // The cosine that the line would need to stand still, by virtual work.
      const double reaction =
          (arrays.product[v] - arrays.rhs_without_line[v] + pressure * surface.volume_gradient[v]) / dt;
      const double unit = tension * surface.wet_gradient[v];
      if (unit <= 0) continue;
      if (reaction > (bounds.receding + rounding) * unit) next = LineStatus::receding;
      if (reaction < (bounds.advancing - rounding) * unit) next = LineStatus::advancing;
    } else if (status == LineStatus::advancing ? arrays.speed[v] < 0 : arrays.speed[v] > 0) {
      next = LineStatus::stuck;
    }
    if (next == status) continue;
    drop.set_line_status(v, next);
    ++changed;
  }
  return changed;
}

std::size_t block_touching(const Drop& drop, PressureArrays& arrays) {
  constexpr double facing = -0.05;
  const PressureSurface& surface = arrays.surface;
  std::size_t blocked = 0;
  for (std::uint32_t v = 0; v < surface.role.size(); ++v) {
    if (surface.role[v] != Role::touching || arrays.blocked[v] != 0 || !(arrays.speed[v] > 0)) continue;
    if (!(surface.direction[v].dot(drop.contact_normals().col(v)) < facing)) continue;
    arrays.blocked[v] = 1;
    ++blocked;
  }
  return blocked;
}

}  // namespace meniscus
