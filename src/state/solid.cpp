// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/state/solid.h"

#include "meniscus/core/error.h"
#include "triangle_mesh_distance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

using Eigen::Vector3d;

void check_size(const char* what, double value) {
  if (!(value > 0) || !std::isfinite(value))
    throw UsageError(fmt::format("a solid's {} is {}; it must be finite and greater than 0", what, value));
}

void check_finite(const char* what, const Vector3d& value) {
  if (!value.allFinite())
    throw UsageError(
        fmt::format("a solid's {} is ({}, {}, {}); it must be finite", what, value.x(), value.y(), value.z()));
}

void check_edge_radius(double radius) {
  if (!(radius >= 0) || !std::isfinite(radius))
    throw UsageError(fmt::format("a solid's edge radius is {}; it must be finite and at least 0", radius));
}

/// Half the box of a disc across a unit axis.
Vector3d disc_reach(const Vector3d& axis, double radius) {
  return radius * (1 - axis.array().square()).max(0.0).sqrt();
}

/// The contact of a ball; `fallback` is the normal at its very centre.
SolidContact ball_contact(const Vector3d& center, double radius, const Vector3d& x, const Vector3d& fallback) {
  const double r = (x - center).norm();
  const Vector3d normal = r > 0 ? Vector3d((x - center) / r) : fallback;
  return {r - radius, center + radius * normal, normal};
}

/// A unit axis from a to b.
Vector3d unit_axis(const Vector3d& a, const Vector3d& b, double length) {
  check_finite("end", a);
  check_finite("end", b);
  check_size("length", length);
  return (b - a) / length;
}

Eigen::AlignedBox3d around(const Vector3d& center, const Vector3d& half_size) {
  return {Vector3d(center - half_size), Vector3d(center + half_size)};
}

}  // namespace

Solid Solid::plane(const Vector3d& point, const Vector3d& normal) {
  check_finite("point", point);
  const double length = normal.stableNorm();
  check_size("normal's length", length);
  return Solid(Plane{point, normal / length});
}

Solid Solid::sphere(const Vector3d& center, double radius) {
  check_finite("centre", center);
  check_size("radius", radius);
  Solid solid(Sphere{center, radius});
  solid.bounds_ = around(center, Vector3d::Constant(radius));
  return solid;
}

Solid Solid::box(const Vector3d& center, const Vector3d& size, const Eigen::Matrix3d& rotation, double edge_radius) {
  check_finite("centre", center);
  for (const double side : {size.x(), size.y(), size.z()}) check_size("size", side);
  if (!rotation.isUnitary(1e-9) || !(rotation.determinant() > 0))
    throw UsageError("a solid box is turned by a matrix that is no rotation");
  check_edge_radius(edge_radius);
  Solid solid(Box{center, 0.5 * size, rotation, std::min(edge_radius, 0.5 * size.minCoeff())});
  solid.bounds_ = around(center, rotation.cwiseAbs() * (0.5 * size));
  return solid;
}

Solid Solid::cylinder(const Vector3d& a, const Vector3d& b, double radius, double edge_radius) {
  const double length = (b - a).stableNorm();
  const Vector3d axis = unit_axis(a, b, length);
  check_size("radius", radius);
  check_edge_radius(edge_radius);
  Solid solid(Cylinder{a, axis, length, radius, std::min({edge_radius, radius, 0.5 * length})});
  const Vector3d reach = disc_reach(axis, radius);
  solid.bounds_ = around(a, reach).merged(around(b, reach));
  return solid;
}

Solid Solid::capsule(const Vector3d& a, const Vector3d& b, double radius) {
  const double length = (b - a).stableNorm();
  const Vector3d axis = unit_axis(a, b, length);
  check_size("radius", radius);
  Solid solid(Capsule{a, axis, length, radius});
  const Vector3d reach = Vector3d::Constant(radius);
  solid.bounds_ = around(a, reach).merged(around(b, reach));
  return solid;
}

Solid Solid::mesh(const MeshData& data) {
  auto distance = std::make_shared<const TriangleMeshDistance>(data);
  Solid solid(TriangleMesh{distance});
  solid.bounds_ = distance->bounds();
  return solid;
}

Solid Solid::disc(const Vector3d& center, const Vector3d& normal, double radius) {
  check_finite("centre", center);
  const double length = normal.stableNorm();
  check_size("normal's length", length);
  check_size("radius", radius);
  const Vector3d unit = normal / length;
  Solid solid(Disc{center, unit, radius});
  const Vector3d reach = disc_reach(unit, radius);
  solid.bounds_ = around(center, reach).merged(around(center - radius * unit, reach));
  return solid;
}

void Solid::set_velocity(const Vector3d& velocity) {
  check_finite("velocity", velocity);
  velocity_ = velocity;
  keys_.clear();
}

void Solid::set_keys(std::vector<Key> keys) {
  for (std::size_t k = 0; k < keys.size(); ++k) {
    check_finite("key position", keys[k].position);
    if (!std::isfinite(keys[k].time) || (k > 0 && keys[k].time <= keys[k - 1].time))
      throw UsageError(
          fmt::format("key {} of a moving solid is at time {}; times must be finite and increase", k, keys[k].time));
  }
  keys_ = std::move(keys);
  velocity_.setZero();
}

Vector3d Solid::velocity(double time) const {
  if (keys_.empty()) return velocity_;
  if (time <= keys_.front().time || time > keys_.back().time) return Vector3d::Zero();
  const auto next =
      std::lower_bound(keys_.begin(), keys_.end(), time, [](const Key& key, double t) { return key.time < t; });
  const auto last = next - 1;
  return (next->position - last->position) / (next->time - last->time);
}

Vector3d Solid::offset(double time) const {
  if (keys_.empty()) return velocity_ * time;
  if (time <= keys_.front().time) return keys_.front().position;
  if (time >= keys_.back().time) return keys_.back().position;
  const auto next =
      std::lower_bound(keys_.begin(), keys_.end(), time, [](const Key& key, double t) { return key.time < t; });
  const auto last = next - 1;
  const double share = (time - last->time) / (next->time - last->time);
  return (1 - share) * last->position + share * next->position;
}

SolidContact Solid::query(const Vector3d& x, double time) const {
  const Vector3d moved = offset(time);
  const Vector3d local = x - moved;
  SolidContact result = std::visit([&](const auto& shape) { return contact(shape, local); }, shape_);
  result.point += moved;
  return result;
}

bool Solid::is_near(const Eigen::AlignedBox3d& box, double time, double margin) const {
  if (box.isEmpty()) return false;
  const Vector3d moved = offset(time);
  if (const auto* plane = std::get_if<Plane>(&shape_)) {
    const double reach = plane->normal.cwiseAbs().dot(0.5 * box.sizes());
    return plane->normal.dot(box.center() - moved - plane->point) - reach <= margin;
  }
  return bounds_.translated(moved).exteriorDistance(box) <= margin;
}

bool Solid::is_near(const Vector3d& x, double time, double margin) const {
  const Vector3d local = x - offset(time);
  if (const auto* plane = std::get_if<Plane>(&shape_)) return plane->normal.dot(local - plane->point) <= margin;
  if (const auto* mesh = std::get_if<TriangleMesh>(&shape_)) return mesh->distance->is_near(local, margin);
  return bounds_.exteriorDistance(local) <= margin;
}

SolidContact Solid::contact(const Plane& plane, const Vector3d& x) {
  const double distance = (x - plane.point).dot(plane.normal);
  return {distance, x - distance * plane.normal, plane.normal};
}

SolidContact Solid::contact(const Sphere& sphere, const Vector3d& x) {
  return ball_contact(sphere.center, sphere.radius, x, Vector3d::UnitZ());
}

SolidContact Solid::contact(const Box& box, const Vector3d& x) {
  const Vector3d local = box.rotation.transpose() * (x - box.center);
  const Vector3d core = box.half_size.array() - box.edge_radius;  // the rounded box is a ball's sweep over it
  const Vector3d nearest = local.cwiseMax(-core).cwiseMin(core);
  const double outside = (local - nearest).norm();
  if (outside > 0) {
    const Vector3d normal = (local - nearest) / outside;
    const Vector3d point = nearest + box.edge_radius * normal;
    return {outside - box.edge_radius, box.center + box.rotation * point, box.rotation * normal};
  }
  Eigen::Index axis;  // of the nearest face; maxCoeff takes the first of equals
  const double distance = (local.cwiseAbs() - box.half_size).maxCoeff(&axis);
  const double side = local[axis] < 0 ? -1 : 1;
  Vector3d point = local;
  point[axis] = side * box.half_size[axis];
  return {distance, box.center + box.rotation * point, side * box.rotation.col(axis)};
}

SolidContact Solid::contact(const Cylinder& cylinder, const Vector3d& x) {
  // In the plane through the axis and x, the cylinder is a rectangle with rounded corners.
  const double along = (x - cylinder.start).dot(cylinder.axis);
  const Vector3d across = x - cylinder.start - along * cylinder.axis;
  const double r = across.norm(), edge = cylinder.edge_radius;
  const Vector3d radial = r > 0 ? Vector3d(across / r) : cylinder.axis.unitOrthogonal();
  const double end = along < 0.5 * cylinder.length ? 0 : cylinder.length;  // the nearer end's place and normal
  const double end_side = end == 0 ? -1 : 1;
  const double beyond_side = r - cylinder.radius, beyond_end = end_side * (along - end);
  const auto at = [&](double height, double radius) -> Vector3d {
    return cylinder.start + height * cylinder.axis + radius * radial;
  };
  const double corner_side = beyond_side + edge, corner_end = beyond_end + edge;  // from the rounding's centre
  if (corner_side > 0 && corner_end > 0) {                                        // nearest to the rim
    const double outside = std::hypot(corner_side, corner_end);
    const double out = corner_side / outside, up = corner_end / outside;
    const Vector3d normal = out * radial + up * end_side * cylinder.axis;
    return {outside - edge, at(end + end_side * edge * (up - 1), cylinder.radius + edge * (out - 1)), normal};
  }
  if (beyond_side >= beyond_end) return {beyond_side, at(along, cylinder.radius), radial};
  return {beyond_end, at(end, r), end_side * cylinder.axis};
}

SolidContact Solid::contact(const Capsule& capsule, const Vector3d& x) {
  const double along = std::clamp((x - capsule.start).dot(capsule.axis), 0.0, capsule.length);
  return ball_contact(capsule.start + along * capsule.axis, capsule.radius, x, capsule.axis.unitOrthogonal());
}

SolidContact Solid::contact(const TriangleMesh& mesh, const Vector3d& x) { return mesh.distance->query(x); }

SolidContact Solid::contact(const Disc& disc, const Vector3d& x) {
  const double above = (x - disc.center).dot(disc.normal);
  const Vector3d foot = x - above * disc.normal, across = foot - disc.center;
  const double r = across.norm();
  constexpr double rounding = 1e-9;
  if (r <= (1 + rounding) * disc.radius) return {above < -disc.radius ? -above : above, foot, disc.normal};
  const Vector3d rim = disc.center + disc.radius / r * across;
  const double distance = (x - rim).norm();
  return {distance, rim, (x - rim) / distance};
}

Vector3d Solid::rim_point(const Vector3d& x, double time, double edge) const {
  const Vector3d nearest = query(x, time).point;
  const auto* disc = std::get_if<Disc>(&shape_);
  if (!disc) return nearest;
  const Vector3d center = disc->center + offset(time), across = nearest - center;
  const double r = across.norm(), R = disc->radius;
  const double chord = R - std::sqrt(std::max(0.0, R * R - edge * edge));
  return R - r < std::min(chord, R / 3) ? Vector3d(center + R / r * across) : nearest;
}

}  // namespace meniscus
