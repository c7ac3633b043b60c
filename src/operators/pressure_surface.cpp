// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/core/chunks.h"
#include "pressure_arrays.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// s and W are kept from vanishing where the surface meets the solid at a small or large angle.
constexpr double least_slant = 0.3, least_mass = 0.3;

/// Solids whose normal varies by less than this mean square over the wetted area let the drop move along.
constexpr double flat_enough = 0.1;

Vector3d area_vector_of(const FaceGeometry& face) {
  return {face.area_vector[0], face.area_vector[1], face.area_vector[2]};
}

/// A face lies on a solid if its three vertices do and it looks into it.
void find_wet_faces(const Drop& drop, PressureSurface& surface) {
  const auto& triangles = drop.connectivity().triangles();
  const auto& faces = drop.workspace().geometry.faces();
  const Contact* contact = drop.contact();
  surface.wet_face.assign(triangles.size(), 0);
  surface.air_area = drop.workspace().geometry.area();
  surface.wet_area = 0;
  surface.wall_normal.setZero();
  surface.in_contact = false;
  surface.rigid.setIdentity();
  surface.rigid_directions = 3;
  if (!touches_solid(drop)) return;
  Matrix3d spread = Matrix3d::Zero();
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    const auto& [a, b, c] = triangles[f];
    if (a == Connectivity::removed) continue;
    const FaceGeometry& face = faces[f];
    const double area = face.area[0] + face.area[1] + face.area[2];
    const bool on_solid = is_colliding(contact[a]) && is_colliding(contact[b]) && is_colliding(contact[c]);
    if (!on_solid || !(area_vector_of(face).dot(drop.contact_normals().col(a)) < 0)) continue;
    surface.wet_face[f] = 1;
    surface.wet_area += area;
    const Vector3d normal = drop.contact_normals().col(a);
    surface.wall_normal += area * normal;
    spread += area * normal * normal.transpose();
  }
  surface.in_contact = surface.wet_area > 0;
  surface.air_area -= surface.wet_area;
  surface.wall_normal.normalize();
  if (!surface.in_contact) return;
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(spread / surface.wet_area);  // eigenvalues increase
  surface.rigid_directions = 0;
  surface.rigid.setZero();
  for (int k = 0; k < 2 && eigen.eigenvalues()[k] < flat_enough; ++k)
    surface.rigid.col(surface.rigid_directions++) = eigen.eigenvectors().col(k);
}

/// What the ring of a vertex says, its wet faces apart.
struct RingSums {
  Vector3d air_vector = Vector3d::Zero();    ///< sum of the air faces' area vectors
  Vector3d wet_gradient = Vector3d::Zero();  ///< of the wetted area, at the vertex
  double air_area = 0;
  int wet_faces = 0, line_edges = 0;
};

/// Writes the weights of the vertex's row of L as it goes.
RingSums ring_sums(const Drop& drop, const std::vector<std::uint8_t>& wet_face, std::uint32_t v, double* weight) {
  const ConstColumns x = drop.positions();
  const auto& faces = drop.workspace().geometry.faces();
  const Ring ring = drop.connectivity().ring(v);
  RingSums sums;
  std::fill(weight, weight + ring.degree, 0.0);
  std::uint8_t previous = wet_face[ring.corner[ring.degree - 1] / 3];
  for (int k = 0; k < ring.degree; ++k) {
    const int next = k + 1 == ring.degree ? 0 : k + 1;
    const std::uint32_t f = ring.corner[k] / 3, corner = ring.corner[k] - 3 * f;
    const FaceGeometry& face = faces[f];
    const Vector3d area_vector = area_vector_of(face);
    const double area = face.area[0] + face.area[1] + face.area[2];
    sums.line_edges += wet_face[f] != previous;
    previous = wet_face[f];
    if (wet_face[f] != 0) {
      ++sums.wet_faces;
      const Vector3d opposite = x.col(ring.neighbour[next]) - x.col(ring.neighbour[k]);
      if (area > 0) sums.wet_gradient += 0.5 / area * area_vector.cross(opposite);
      continue;
    }
    sums.air_vector += area_vector;
    sums.air_area += area;
    weight[k] += 0.5 * face.cotangent[(corner + 2) % 3];
    weight[next] += 0.5 * face.cotangent[(corner + 1) % 3];
  }
  return sums;
}

/// The same for a vertex off solids, none of whose faces is wet: the geometry has it all.
RingSums ring_sums_off_solids(const Drop& drop, std::uint32_t v, double* weight) {
  const SurfaceGeometry& geometry = drop.workspace().geometry;
  RingSums sums;
  sums.air_vector = geometry.area_vector(v);
  sums.air_area = 3 * geometry.lumped_area(v);
  std::copy_n(ring_weights(geometry.edge_weights(), drop.connectivity(), v), drop.connectivity().degree(v), weight);
  return sums;
}

Role role_of(const RingSums& sums, int degree, bool is_colliding, double line_length) {
  if (sums.wet_faces == degree) return Role::wetted;
  if (!(sums.air_vector.squaredNorm() > 0)) return Role::pinned;
  if (sums.wet_faces == 0) return is_colliding ? Role::touching : Role::free;
  return sums.line_edges == 2 && line_length > 0 ? Role::line : Role::pinned;
}

void look_at_vertex(const Drop& drop, std::uint32_t v, PressureSurface& surface) {
  surface.role[v] = Role::absent;
  surface.direction[v].setZero();
  surface.form[v].setZero();
  surface.moment[v].setZero();
  surface.volume_gradient[v] = surface.mass[v] = surface.wet_gradient[v] = surface.stiffness.diagonal[v] = 0;
  surface.slant[v] = 1;
  const Ring ring = drop.connectivity().ring(v);
  double* const row = &surface.stiffness.weight[Connectivity::width * std::size_t{v}];
  std::fill(row, row + Connectivity::width, 0.0);
  if (ring.degree == 0) return;
  double* weight = row;
  if (ring.degree > Connectivity::width)
    weight = surface.stiffness.long_weight[drop.connectivity().long_ring(v)].data();
  const bool colliding = is_colliding(drop.contact()[v]);
  const RingSums sums =
      colliding ? ring_sums(drop, surface.wet_face, v, weight) : ring_sums_off_solids(drop, v, weight);
  for (int k = 0; k < ring.degree; ++k) surface.stiffness.diagonal[v] += weight[k];

  const Vector3d wall = drop.contact_normals().col(v);
  const Vector3d along =
      colliding ? Vector3d(sums.wet_gradient - sums.wet_gradient.dot(wall) * wall) : Vector3d(Vector3d::Zero());
  const Role role = surface.role[v] = role_of(sums, ring.degree, colliding, along.norm());
  if (!is_moving(role)) return;
  const Vector3d n = sums.air_vector.normalized();
  Vector3d g = n;
  surface.direction[v] = n;
  if (role == Role::line) {
    const Vector3d m = along.normalized();
    const double s = surface.slant[v] = std::max(m.dot(n), least_slant);
    surface.direction[v] = m / s;
    g = s * m;
    surface.wet_gradient[v] = along.dot(surface.direction[v]);
  }
  surface.form[v] = surface.rigid.transpose() * g;
  surface.volume_gradient[v] = sums.air_vector.dot(surface.direction[v]) / 3;
  surface.moment[v] =
      surface.volume_gradient[v] * surface.rigid.transpose() * (drop.positions().col(v) - surface.center);
  surface.mass[v] = std::max(surface.volume_gradient[v], least_mass * sums.air_area / 3);
}

void find_frame(const Drop& drop, const std::vector<Solid>& solids, double time, PressureSurface& surface) {
  surface.frame.setZero();
  double area = 0;
  for (std::uint32_t v = 0; surface.in_contact && v < drop.num_rows(); ++v) {
    if (surface.role[v] != Role::line && surface.role[v] != Role::wetted) continue;
    const double share = drop.workspace().geometry.lumped_area(v);
    surface.frame += share * solids[static_cast<std::size_t>(drop.contact_solid()[v])].velocity(time);
    area += share;
  }
  if (area > 0) surface.frame /= area;
}

void resize(std::size_t n, const Connectivity& connectivity, PressureSurface& surface) {
  surface.role.resize(n);
  for (auto* array : {&surface.direction, &surface.form, &surface.moment}) array->resize(n);
  for (auto* array : {&surface.volume_gradient, &surface.mass, &surface.slant, &surface.wet_gradient, &surface.force,
                      &surface.head, &surface.stiffness.diagonal})
    array->resize(n);
  surface.stiffness.weight.resize(Connectivity::width * n);
  surface.stiffness.fit_long_rings(connectivity);
}

}  // namespace

PressureArrays& pressure_arrays(Drop& drop) {
  auto& arrays = drop.workspace().pressure;
  if (!arrays) arrays = std::make_shared<PressureArrays>();
  return *arrays;
}

void look_at_surface(Drop& drop, const std::vector<Solid>& solids, double time, PressureArrays& arrays) {
  PressureSurface& surface = arrays.surface;
  const std::size_t n = drop.num_rows();
  resize(n, drop.connectivity(), surface);
  drop.workspace().geometry.compute(std::as_const(drop).positions(), drop.connectivity());
  measure_solid(std::as_const(drop).positions(), drop.connectivity(), surface);
  find_wet_faces(drop, surface);
  for_each_chunk(n, [&](std::size_t begin, std::size_t end) {
    for (auto v = static_cast<std::uint32_t>(begin); v < end; ++v) look_at_vertex(drop, v, surface);
  });
  find_frame(drop, solids, time, surface);
  surface.rotation = surface.in_contact ? Vector3d(Vector3d::Zero()) : tangential_rotation(drop, surface.center);

  arrays.speed_old.assign(n, 0);
  const ConstColumns x = drop.positions(), velocity = drop.velocities();
  for_each_chunk(n, [&](std::size_t begin, std::size_t end) {
    for (auto v = static_cast<std::uint32_t>(begin); v < end; ++v) {
      if (is_on_surface(surface.role[v])) {
        const Vector3d turning = surface.rotation.cross(Vector3d(x.col(v)) - surface.center);
        arrays.speed_old[v] = (velocity.col(v) - surface.frame - turning).dot(surface.direction[v]);
      } else if (surface.role[v] == Role::line) {
        const Vector3d slip =
            velocity.col(v) - solids[static_cast<std::size_t>(drop.contact_solid()[v])].velocity(time);
        arrays.speed_old[v] = surface.slant[v] * surface.slant[v] * slip.dot(surface.direction[v]);
      }
    }
  });
}

}  // namespace meniscus
