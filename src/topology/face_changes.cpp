// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/topology/face_changes.h"

#include "meniscus/core/chunks.h"

#include <Eigen/Geometry>

#include <algorithm>

namespace meniscus {
namespace {

using Eigen::Vector3d;

/// An edge that turns or stretches by more than this share of its length in a substep.
constexpr double large_change = 0.5;

bool changes_much(const Vector3d& before, const Vector3d& now) {
  return !((now - before).squaredNorm() < large_change * large_change * before.squaredNorm());
}

/// The areas, for the few substeps in which some face is violent.
void add_areas(const Drop& drop, const Eigen::Matrix3Xd& before, FaceChanges& changes) {
  const ConstColumns x = drop.positions();
  for (const auto& [a, b, c] : drop.connectivity().triangles()) {
    if (a == Connectivity::removed) continue;
    const Vector3d then = 0.5 * (before.col(b) - before.col(a)).cross(before.col(c) - before.col(a));
    const Vector3d now = 0.5 * (x.col(b) - x.col(a)).cross(x.col(c) - x.col(a));
    changes.area_before += then.norm();
    changes.area += now.norm();
    if (now.dot(then) < 0) changes.turned_area += now.norm();
  }
}

}  // namespace

FaceChanges& FaceChanges::operator+=(const FaceChanges& other) {
  area_before += other.area_before;
  area += other.area;
  turned_area += other.turned_area;
  volume_before += other.volume_before;
  volume += other.volume;
  violent += other.violent;
  return *this;
}

FaceChanges find_face_changes(Drop& drop, const Eigen::Matrix3Xd& before, std::vector<std::uint8_t>& violent) {
  const auto& triangles = drop.connectivity().triangles();
  const SurfaceGeometry& geometry = drop.workspace().geometry;
  const ConstColumns x = std::as_const(drop).positions(), n = std::as_const(drop).contact_normals();
  const Contact* const contact = drop.contact();
  const bool has_normals = geometry.faces().size() == triangles.size();
  const auto faces_away = [&](const std::array<std::uint32_t, 3>& face, const Vector3d& normal) {
    const auto [a, b, c] = face;
    if (is_colliding(contact[a]) && is_colliding(contact[b]) && is_colliding(contact[c]))
      return !(normal.dot(n.col(a) + n.col(b) + n.col(c)) < 0);
    return has_normals && std::any_of(face.begin(), face.end(), [&](std::uint32_t v) {
             return !is_colliding(contact[v]) && normal.dot(geometry.normal(v)) < 0;
           });
  };
  const Vector3d origin = x.cols() == 0 ? Vector3d::Zero() : Vector3d(x.col(0));
  violent.resize(triangles.size());
  FaceChanges changes = sum_over_chunks(triangles.size(), FaceChanges{}, [&](std::size_t begin, std::size_t end) {
    double volume_before = 0, volume = 0;
    std::size_t count = 0;
    for (std::size_t f = begin; f < end; ++f) {
      const auto [a, b, c] = triangles[f];
      bool is_violent = false;
      if (a != Connectivity::removed) {
        const Vector3d was = before.col(a), is = x.col(a);
        const Vector3d p = before.col(b) - was, q = before.col(c) - was, normal_before = p.cross(q);
        const Vector3d s = x.col(b) - is, t = x.col(c) - is, normal = s.cross(t);
        volume_before += normal_before.dot(was - origin);
        volume += normal.dot(is - origin);
        is_violent = !(normal.dot(normal_before) > 0) || changes_much(p, s) || changes_much(q, t) ||
                     changes_much(q - p, t - s) || faces_away(triangles[f], normal);
        count += is_violent;
      }
      violent[f] = is_violent;
    }
    FaceChanges part;
    part.volume_before = volume_before / 6;
    part.volume = volume / 6;
    part.violent = count;
    return part;
  });
  if (changes.violent > 0)
    add_areas(drop, before, changes);
  else
    violent.clear();
  return changes;
}

}  // namespace meniscus
