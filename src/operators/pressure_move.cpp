// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/operators/external_forces.h"
#include "meniscus/operators/lift_films.h"
#include "pressure_arrays.h"

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// In lengths of edge_min: what a vertex may move on its own and go into a solid.
constexpr double most_move = 0.5, most_depth = 0.2;
/// A drop that turns by less in a substep (radians) keeps its rotation, whatever becomes of its shape.
constexpr double least_turn = 1e-12;
/// Films lower than this (in lengths of edge_min) come down no further.
constexpr double low_film = 0.05;
/// A patch on a solid smaller than this (in edge_min^2) comes off, if it shrinks and the drop rises: its
/// vertices by `lift` of edge_min.
constexpr double least_patch = 3, lift = 0.05;

/// U of speeds, in space.
Vector3d translation_in_space(const PressureArrays& arrays) { return arrays.surface.rigid * arrays.translation; }

Matrix3d turn_by(const Vector3d& rotation, double dt) {
  const double angle = rotation.norm() * dt;
  return angle > 0 ? Eigen::AngleAxisd(angle, rotation.normalized()).toRotationMatrix()
                   : Matrix3d(Matrix3d::Identity());
}

/// The mean velocity of the line along its solid, relative to it: what the wetted vertices go along with.
Vector3d mean_slip(const PressureArrays& arrays) {
  const PressureSurface& surface = arrays.surface;
  Vector3d sum = Vector3d::Zero();
  double length = 0;
  for (std::size_t v = 0; v < surface.role.size(); ++v) {
    if (surface.role[v] != Role::line) continue;
    sum += surface.wet_gradient[v] * arrays.speed[v] * surface.direction[v];
    length += surface.wet_gradient[v];
  }
  return length > 0 ? Vector3d(sum / length) : Vector3d(Vector3d::Zero());
}

/// Where each vertex goes in a substep, on the solution in `arrays`.
class Motion {
 public:
  Motion(const Drop& drop, const std::vector<Solid>& solids, double time, double dt, const PressureArrays& arrays)
      : drop_(drop),
        arrays_(arrays),
        surface_(arrays.surface),
        dt_(dt),
        drift_(surface_.frame + translation_in_space(arrays)),
        slip_(mean_slip(arrays)),
        turn_(turn_by(surface_.rotation, dt)) {
    for (const Solid& solid : solids) solid_velocity_.push_back(solid.velocity(time + dt));
  }

  Vector3d end(std::uint32_t v) const {
    const Vector3d x = drop_.positions().col(v);
    switch (surface_.role[v]) {
      case Role::free:
      case Role::touching: {
        const Vector3d r = x - surface_.center + dt_ * arrays_.deformation[v] * surface_.direction[v];
        return surface_.center + dt_ * drift_ + turn_ * r;
      }
      case Role::line:
        return x + dt_ * (wall(v) + arrays_.speed[v] * surface_.direction[v]);
      case Role::wetted:
        return x + dt_ * (wall(v) + slip_);
      case Role::pinned:
        return drop_.contact_solid()[v] >= 0 ? Vector3d(x + dt_ * wall(v)) : Vector3d(x + dt_ * drift_);
      default:
        return x;
    }
  }
  const Vector3d& wall(std::uint32_t v) const {
    return solid_velocity_[static_cast<std::size_t>(drop_.contact_solid()[v])];
  }
  const Vector3d& drift() const { return drift_; }

 private:
  const Drop& drop_;
  const PressureArrays& arrays_;
  const PressureSurface& surface_;
  double dt_;
  Vector3d drift_, slip_;
  Matrix3d turn_;
  std::vector<Vector3d> solid_velocity_;
};

/// Patches on solids that let go: contact ends, the vertices are lifted.
void let_go(Drop& drop, const std::vector<Solid>& solids, const PressureOptions& options,
            const PressureArrays& arrays) {
  const PressureSurface& surface = arrays.surface;
  if (!surface.in_contact) return;
  double rise = 0;
  for (std::size_t v = 0; v < surface.role.size(); ++v)
    if (is_on_surface(surface.role[v]))
      rise += surface.volume_gradient[v] * (drop.positions().col(v) - surface.center).dot(surface.wall_normal) *
              arrays.speed[v];
  if (!(rise > 0)) return;
  const auto& triangles = drop.connectivity().triangles();
  const auto& faces = drop.workspace().geometry.faces();
  for (std::size_t s = 0; s < solids.size(); ++s) {
    const auto is_here = [&](std::uint32_t v) {
      return is_colliding(drop.contact()[v]) && drop.contact_solid()[v] == static_cast<std::int32_t>(s);
    };
    double area = 0, growth = 0;
    for (std::size_t f = 0; f < triangles.size(); ++f)
      if (surface.wet_face[f] != 0 && is_here(triangles[f][0]))
        area += faces[f].area[0] + faces[f].area[1] + faces[f].area[2];
    if (!(area > 0) || area >= least_patch * options.edge_min * options.edge_min) continue;
    for (std::uint32_t v = 0; v < surface.role.size(); ++v)
      if (surface.role[v] == Role::line && is_here(v)) growth += surface.wet_gradient[v] * arrays.speed[v];
    if (!(growth < 0)) continue;
    for (std::uint32_t v = 0; v < surface.role.size(); ++v) {
      if (!is_here(v)) continue;
      drop.positions().col(v) += lift * options.edge_min * drop.contact_normals().col(v);
      drop.contact()[v] = Contact::free;
      drop.contact_solid()[v] = -1;
    }
  }
}

/// Vertices on solids, at `time`: those that went into one lie on it, those that left one are free.
void find_contact_anew(Drop& drop, const std::vector<Solid>& solids, double time, double edge_max) {
  ExternalForcesOptions options;
  options.gravity.setZero();
  options.no_slip = false;
  options.touching_distance = touching_distance;
  options.longest_edge = edge_max;
  apply_external_forces(drop, solids, time, 0, options);
}

/// U + rotation x r + u n on the free surface, without what would go into a solid that it touches.
Vector3d surface_velocity(const Drop& drop, const Motion& motion, const PressureArrays& arrays, std::uint32_t v) {
  const Vector3d r = drop.positions().col(v) - arrays.surface.center;
  const Vector3d velocity =
      motion.drift() + arrays.surface.rotation.cross(r) + arrays.deformation[v] * drop.workspace().geometry.normal(v);
  if (!is_colliding(drop.contact()[v])) return velocity;
  const Vector3d normal = drop.contact_normals().col(v);
  return velocity - std::min(0.0, (velocity - motion.wall(v)).dot(normal)) * normal;
}

void write_velocities(Drop& drop, const Motion& motion, const PressureArrays& arrays) {
  Columns velocity = drop.velocities();
  for (std::uint32_t v = 0; v < drop.num_rows(); ++v) {
    const Role role = arrays.surface.role[v];
    const bool colliding = is_colliding(drop.contact()[v]);
    if (is_on_surface(role))
      velocity.col(v) = surface_velocity(drop, motion, arrays, v);
    else
      velocity.col(v) = colliding ? motion.wall(v) : motion.drift();
    if (role == Role::line) velocity.col(v) += arrays.speed[v] * arrays.surface.direction[v];
    if (!colliding) drop.set_line_status(v, LineStatus::advancing);
  }
}

}  // namespace

bool PressureStep::is_short_enough(double dt) const {
  const PressureArrays& arrays = pressure_arrays(drop_);
  const PressureSurface& surface = arrays.surface;
  const double along = arrays.translation.norm(), most = most_move * options_.edge_min;
  for (std::size_t v = 0; v < surface.role.size(); ++v) {
    if (!is_moving(surface.role[v])) continue;
    const double own = surface.role[v] == Role::line
                           ? std::max(0.0, std::abs(arrays.speed[v]) / surface.slant[v] - along)
                           : std::abs(arrays.deformation[v]);
    if (!(own * dt <= most)) return false;
  }
  const double deepest = most_depth * options_.edge_min;
  const Motion motion(drop_, solids_, time_, dt, arrays);
  Eigen::AlignedBox3d box;
  for (std::uint32_t v = 0; v < surface.role.size() && !solids_.empty(); ++v)
    if (is_on_surface(surface.role[v])) box.extend(motion.end(v));
  for (const Solid& solid : solids_) {
    if (!solid.is_near(box, time_ + dt, 0)) continue;
    for (std::uint32_t v = 0; v < surface.role.size(); ++v) {
      if (!is_on_surface(surface.role[v])) continue;
      const Vector3d end = motion.end(v);
      if (!solid.is_near(end, time_ + dt, 0)) continue;
      const double at_end = solid.query(end, time_ + dt).distance;
      if (!(at_end < -deepest)) continue;
      const double at_start = solid.query(drop_.positions().col(v), time_).distance;
      if (solid.inflow && at_start < -deepest) continue;  // behind the disc of a source liquid passes
      // No substep is short enough for a vertex that was too deep before it.
      if (std::min(at_start, 0.0) - at_end > 0.5 * deepest) return false;
    }
  }
  return true;
}

PressureReport PressureStep::move() {
  PressureArrays& arrays = pressure_arrays(drop_);
  PressureSurface& surface = arrays.surface;
  const auto n = static_cast<std::uint32_t>(drop_.num_rows());
  if (n == 0 || !(surface.volume > 0)) return report_;
  const Motion motion(drop_, solids_, time_, dt_, arrays);
  const bool turns = surface.rotation.norm() * dt_ > least_turn;  // on a solid it does not
  const Matrix3d inertia_before =
      turns ? inertia_about(surface.center, std::as_const(drop_).positions(), drop_.connectivity())
            : Matrix3d(Matrix3d::Zero());
  arrays.shift.resize(n);
  for (std::uint32_t v = 0; v < n; ++v) arrays.shift[v] = motion.end(v);
  Columns x = drop_.positions();
  for (std::uint32_t v = 0; v < n; ++v) x.col(v) = arrays.shift[v];
  let_go(drop_, solids_, options_, arrays);
  find_contact_anew(drop_, solids_, time_ + dt_, options_.edge_max);

  even_out(drop_, options_, arrays);
  stop_at_discs(drop_, solids_, time_ + dt_,
                [&](std::uint32_t v) -> Vector3d { return drop_.positions().col(v) - arrays.shift[v]; });
  measure_solid(std::as_const(drop_).positions(), drop_.connectivity(), surface);
  if (turns) {  // the angular momentum stays
    const Matrix3d inertia = inertia_about(surface.center, std::as_const(drop_).positions(), drop_.connectivity());
    surface.rotation = inertia.determinant() > 0 ? Vector3d(inertia.ldlt().solve(inertia_before * surface.rotation))
                                                 : Vector3d(Vector3d::Zero());
  }
  write_velocities(drop_, motion, arrays);
  report_.velocity = motion.drift();
  lift_films(drop_, solids_, time_ + dt_, low_film * options_.edge_min);
  report_.relative_volume_error = surface.volume / drop_.target_volume() - 1;
  return report_;
}

}  // namespace meniscus
