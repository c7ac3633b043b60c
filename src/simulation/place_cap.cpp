// SPDX-License-Identifier: GPL-3.0-or-later
#include "place_cap.h"

#include "meniscus/core/mesh_data.h"
#include "meniscus/geometry/shapes.h"
#include "meniscus/scene/scene.h"

#include <cmath>

namespace meniscus {
namespace {

using Eigen::Vector3d;

/// The contact radius of a spherical cap with the volume of a ball.
double cap_contact_radius(double ball_radius, double angle) {
  const double c = std::cos(angle);
  const double cap_radius = ball_radius * std::cbrt(4 / (2 - 3 * c + c * c * c));
  return cap_radius * std::sin(angle);
}

/// Height above the tangent plane becomes height above the surface. Returns whether the surface is flat enough.
bool bend_onto(const Solid& solid, const SolidContact& middle, double foot_radius, Mesh& cap) {
  Columns x = positions(cap);
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    const double height = (Vector3d(x.col(i)) - middle.point).dot(middle.normal);
    const Vector3d foot = Vector3d(x.col(i)) - height * middle.normal;
    const SolidContact contact = solid.query(foot, 0);
    if ((contact.point - foot).norm() > 0.3 * foot_radius) return false;
    const Vector3d normal = solid.query(contact.point, 0).normal;
    x.col(i) = contact.point + std::max(height, 0.0) * normal;
  }
  return true;
}

}  // namespace

double resting_angle(const Solid& solid) { return 0.5 * (solid.advancing_angle + solid.receding_angle); }

std::optional<Mesh> place_cap(const Solid& solid, const Vector3d& near, double ball_radius, double angle,
                              double edge_length) {
  const SolidContact middle = solid.query(near, 0);
  const Vector3d normal = solid.query(middle.point, 0).normal;  // of the surface: `near` may lie off an edge
  const double foot_radius = cap_contact_radius(ball_radius, angle);
  Mesh cap = make_cap(middle.point, normal, foot_radius, angle, edge_length);
  if (solid.is_plane()) return cap;
  if (!bend_onto(solid, {0, middle.point, normal}, foot_radius, cap)) return std::nullopt;
  return cap;
}

}  // namespace meniscus
