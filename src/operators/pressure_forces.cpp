// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/core/chunks.h"
#include "pressure_arrays.h"

namespace meniscus {
namespace {

using Eigen::Vector3d;

/// The potential of gravity on a solid, -rho g . x; in flight, where gravity deforms nothing, of the rotation,
/// -rho |rotation x r|^2 / 2.
void find_heads(const Drop& drop, const PressureOptions& options, PressureSurface& surface) {
  const ConstColumns x = drop.positions();
  const double density = options.liquid.density;
  for_each_chunk(drop.num_rows(), [&](std::size_t begin, std::size_t end) {
    for (auto v = static_cast<std::uint32_t>(begin); v < end; ++v) {
      const Vector3d r = x.col(v) - surface.center;
      surface.head[v] =
          -density * (surface.in_contact ? options.gravity.dot(r) : 0.5 * surface.rotation.cross(r).squaredNorm());
    }
  });
}

/// dA_air/dx at v.
Vector3d area_gradient(const Drop& drop, const PressureSurface& surface, std::uint32_t v) {
  const ConstColumns x = drop.positions();
  const Ring ring = drop.connectivity().ring(v);
  const double* const weight = ring_weights(surface.stiffness, drop.connectivity(), v);  // those of the air faces
  Vector3d sum = Vector3d::Zero();
  for (int k = 0; k < ring.degree; ++k) sum += weight[k] * (x.col(v) - x.col(ring.neighbour[k]));
  return sum;
}

/// dE/dx at v, E the integral of the head over the liquid: exact on each triangle for a head that is linear,
/// N (h_1 + h_2 + h_3 + h_v)/12, N its area vector.
Vector3d head_gradient(const Drop& drop, const PressureSurface& surface, std::uint32_t v) {
  const auto& faces = drop.workspace().geometry.faces();
  const Ring ring = drop.connectivity().ring(v);
  Vector3d sum = Vector3d::Zero();
  for (int k = 0; k < ring.degree; ++k) {
    const std::uint32_t f = ring.corner[k] / 3;
    if (surface.wet_face[f] != 0) continue;
    const std::uint32_t p = ring.neighbour[k], q = ring.neighbour[k + 1 == ring.degree ? 0 : k + 1];
    const double head = (2 * surface.head[v] + surface.head[p] + surface.head[q]) / 12;
    const auto& area_vector = faces[f].area_vector;
    sum += head * Vector3d(area_vector[0], area_vector[1], area_vector[2]);
  }
  return sum;
}

/// Gives a drop in flight the force rho V g as a whole.
void make_it_fall(const PressureOptions& options, PressureSurface& surface) {
  Vector3d total = Vector3d::Zero();
  for (std::size_t v = 0; v < surface.force.size(); ++v) total += surface.force[v] * surface.form[v];
  const Vector3d missing = options.liquid.density * surface.volume * options.gravity - total;
  for (std::size_t v = 0; v < surface.force.size(); ++v)
    surface.force[v] += surface.moment[v].dot(missing) / surface.volume;
}

}  // namespace

void find_forces(const Drop& drop, const PressureOptions& options, PressureSurface& surface) {
  const bool has_head = surface.in_contact || surface.rotation != Vector3d::Zero();
  if (has_head) find_heads(drop, options, surface);
  const double tension = options.liquid.surface_tension;
  for_each_chunk(drop.num_rows(), [&](std::size_t begin, std::size_t end) {
    for (auto v = static_cast<std::uint32_t>(begin); v < end; ++v) {
      surface.force[v] = 0;
      if (!is_moving(surface.role[v])) continue;
      Vector3d gradient = tension * area_gradient(drop, surface, v);
      if (has_head) gradient += head_gradient(drop, surface, v);
      surface.force[v] = -surface.direction[v].dot(gradient);
    }
  });
  if (!surface.in_contact) make_it_fall(options, surface);
}

}  // namespace meniscus
