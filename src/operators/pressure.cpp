// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/operators/pressure.h"

#include "meniscus/core/error.h"
#include "pressure_arrays.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

using Eigen::Vector3d;

/// beta of the time step: the mass at the old speed takes it too, so that it adds inertia, not damping.
constexpr double beta_free = 0.25, beta_contact = 0.6;
/// chi: on the new speed alone, and so a damping, of drops on solids.
constexpr double chi_contact = 0.3;
/// eta/nu: Lamb's decay over modes 2 to 8 (docs/MODELS.md).
constexpr double viscosity_to_eta = 2.456;
/// Share of the missing volume that a substep takes back, and the shortest time that this may take, in radians of the
/// lowest mode: however short the substep is, the surface must not rush.
constexpr double volume_gain = 0.5, shortest_volume_phase = 0.03;
constexpr int most_solves = 8;
/// A line that recedes meets friction of at most this share of sigma (1 - cos theta_r), the pull on it where the
/// surface lies flat. With more it could not keep up with a drop that runs, and would draw out a film thinner than any
/// mesh holds. A tenth of xi is left, for a line must not rush where hardly any liquid goes with it.
constexpr double most_receding_friction = 0.25, least_friction = 0.1;

double surface_length(const PressureSurface& surface) {
  return surface.air_area > 0 ? 3 * surface.volume / surface.air_area : 0;
}

/// c = 2 sigma/(rho R).
double tension_over_mass(const PressureSurface& surface, const Liquid& liquid) {
  const double R = surface_length(surface);
  return R > 0 ? 2 * liquid.surface_tension / (liquid.density * R) : 0;
}

void resize_for_solve(std::size_t n, PressureArrays& arrays) {
  for (auto* array : {&arrays.speed, &arrays.rhs_without_line, &arrays.rhs, &arrays.friction, &arrays.inverse_diagonal,
                      &arrays.residual, &arrays.preconditioned, &arrays.search, &arrays.product, &arrays.deformation})
    array->resize(n);
  arrays.fixed.resize(n);
  arrays.blocked.assign(n, 0);
}

/// xi of a line vertex (g/(cm s)), less where it recedes too fast for its friction.
double line_friction(const Drop& drop, const std::vector<Solid>& solids, std::uint32_t v,
                     const PressureOptions& options, const PressureArrays& arrays) {
  const double xi = options.contact_line_friction;
  if (arrays.surface.role[v] != Role::line ||
      arrays.status_before[v] != static_cast<std::uint8_t>(LineStatus::receding))
    return xi;
  const Solid& solid = solids[static_cast<std::size_t>(drop.contact_solid()[v])];
  const double pull = options.liquid.surface_tension * (1 - std::cos(solid.receding_angle));
  const double speed = std::abs(arrays.speed_old[v]) / arrays.surface.slant[v];
  if (xi * speed <= most_receding_friction * pull) return xi;
  return std::max(most_receding_friction * pull / speed, least_friction * xi);
}

}  // namespace

PressureStep::PressureStep(Drop& drop, const std::vector<Solid>& solids, double time, const PressureOptions& options)
    : drop_(drop), solids_(solids), options_(options), time_(time) {
  PressureArrays& arrays = pressure_arrays(drop);
  look_at_surface(drop, solids, time, arrays);
  find_forces(drop, options, arrays.surface);
  const PressureSurface& surface = arrays.surface;
  resize_for_solve(drop.num_rows(), arrays);
  arrays.status_before.assign(drop.line_statuses(), drop.line_statuses() + drop.num_rows());
  const double c = tension_over_mass(surface, options.liquid);
  if (!surface.in_contact && c > 0) longest_step_ = surface_length(surface) / (2 * std::sqrt(c));
  Vector3d U = Vector3d::Zero();
  for (std::size_t v = 0; v < surface.role.size(); ++v) U += arrays.speed_old[v] * surface.moment[v];
  if (surface.volume > 0) U /= surface.volume;
  if (options.velocity && !surface.in_contact) {
    for (std::size_t v = 0; v < surface.role.size(); ++v)
      arrays.speed_old[v] += surface.form[v].dot(*options.velocity - U);
    report_.velocity = U = *options.velocity;
  }
  for (std::size_t v = 0; v < surface.role.size(); ++v)
    if (is_moving(surface.role[v]))
      top_speed_ = std::max(top_speed_, std::abs(arrays.speed_old[v] - surface.form[v].dot(U)) / surface.slant[v]);
}

bool PressureStep::solve(double dt) {
  PressureArrays& arrays = pressure_arrays(drop_);
  const PressureSurface& surface = arrays.surface;
  const std::size_t n = drop_.num_rows();
  dt_ = dt;
  std::copy(arrays.status_before.begin(), arrays.status_before.end(), drop_.line_statuses());
  if (n == 0 || !(surface.volume > 0) || !(surface.air_area > 0)) return true;

  const double c = tension_over_mass(surface, options_.liquid), tension = options_.liquid.surface_tension;
  const double stiffening = (surface.in_contact ? beta_contact : beta_free) * dt * dt * c;
  const double damping =
      dt * viscosity_to_eta * options_.liquid.viscosity + (surface.in_contact ? chi_contact * dt * dt * c : 0);
  PressureMass mass{
      drop_.connectivity(), surface, options_.liquid.density, options_.liquid.density * surface_length(surface) / 2,
      stiffening,           nullptr};
  mass.multiply(arrays.speed_old, arrays.rhs_without_line, arrays.deformation);
  for (std::size_t v = 0; v < n; ++v) {
    arrays.rhs_without_line[v] += dt * surface.force[v];
    const double xi = line_friction(drop_, solids_, static_cast<std::uint32_t>(v), options_, arrays);
    arrays.friction[v] = dt * xi * surface.wet_gradient[v] / surface.slant[v];
  }
  mass.stiffening += damping;
  if (surface.in_contact) mass.friction = &arrays.friction;
  mass.inverse_diagonal(arrays.inverse_diagonal);

  const double shortest = c > 0 ? shortest_volume_phase * surface_length(surface) / (2 * std::sqrt(c)) : 0;
  const double missing = drop_.target_volume() - surface.volume;
  const double flux = drop_.inflow() + volume_gain * missing / std::max(dt, shortest);
  arrays.speed = arrays.speed_old;
  std::fill(arrays.blocked.begin(), arrays.blocked.end(), std::uint8_t{0});
  for (int k = 0; k < most_solves; ++k) {
    apply_line(drop_, solids_, dt, tension, arrays);
    const ConstrainedSolve solve = solve_constrained(mass, flux, options_, arrays);
    report_.iterations += solve.iterations;
    ++report_.solves;
    if (!solve.converged)
      throw NumericsError(
          fmt::format("drop {}: the pressure did not converge in {} iterations; use a smaller time step", drop_.id(),
                      solve.iterations));
    std::size_t changed = block_touching(drop_, arrays);
    if (surface.in_contact) {
      mass.multiply(arrays.speed, arrays.product, arrays.deformation);
      changed += update_line(drop_, solids_, dt, tension, solve.pressure, arrays);
    }
    if (changed == 0) break;
  }
  arrays.translation = mass.translation(arrays.speed);
  for (std::size_t v = 0; v < n; ++v)
    arrays.deformation[v] = is_moving(surface.role[v]) ? arrays.speed[v] - surface.form[v].dot(arrays.translation) : 0;
  // What the solve's tolerance left does not touch free fall.
  if (!surface.in_contact && std::none_of(arrays.blocked.begin(), arrays.blocked.end(), [](auto b) { return b != 0; }))
    arrays.translation = mass.translation(arrays.speed_old) + dt * options_.gravity;
  return is_short_enough(dt);
}

}  // namespace meniscus
