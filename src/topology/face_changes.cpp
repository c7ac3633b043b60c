// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/topology/face_changes.h"

#include "meniscus/core/chunks.h"
#include "meniscus/geometry/four_triangles.h"

#include <Eigen/Geometry>

#include <algorithm>

namespace meniscus {
namespace {

using Eigen::Vector3d;

/// An edge that turns or stretches by more than this share of its length in a substep.
constexpr double large_change = 0.5;

FourMasks changes_much(const FourVectors& before, const FourVectors& now) {
  const FourVectors change = now - before;
  return ~(change.dot(change) < large_change * large_change * before.dot(before));
}

/// What find_face_changes looks at.
class FaceLook {
 public:
  FaceLook(Drop& drop, const ConstColumns& before)
      : before_(before),
        x_(std::as_const(drop).positions()),
        solid_normals_(std::as_const(drop).contact_normals()),
        normals_(drop.workspace().geometry.normals()),
        contact_(drop.contact()),
        has_normals_(drop.workspace().geometry.faces().size() == drop.connectivity().triangles().size()),
        touches_solid_(touches_solid(drop)) {
    if (x_.cols() > 0) origin_ = constant(x_.col(0));
  }

  /// Which of four faces changed much, and which face away from the normals at their vertices.
  struct Found {
    FourMasks changed, away;
  };

  /// Looks at four faces; adds six times their volumes.
  Found at(const FourTriangles& four, Four& volume_before, Four& volume) const {
    const FourVectors was = four.corner(before_.data(), 0), is = four.corner(x_.data(), 0);
    const FourVectors p = four.corner(before_.data(), 1) - was, q = four.corner(before_.data(), 2) - was;
    const FourVectors s = four.corner(x_.data(), 1) - is, t = four.corner(x_.data(), 2) - is;
    const FourVectors normal_before = p.cross(q), normal = s.cross(t);
    volume_before += normal_before.dot(was - origin_);
    volume += normal.dot(is - origin_);
    Found found{~(normal.dot(normal_before) > 0) | changes_much(p, s) | changes_much(q, t) | changes_much(q - p, t - s),
                {}};
    if (has_normals_)
      for (std::size_t corner = 0; corner < 3; ++corner)
        found.away |= normal.dot(four.corner(normals_.data(), corner)) < 0;
    return found;
  }

  /// Whether `away`, as found, does not tell of a face: it lies on a solid, or some vertex of it may.
  bool is_in_doubt(const std::array<std::uint32_t, 3>& face, bool away) const {
    return touches_solid_ && (away || is_wetted(face));
  }

  /// Whether a face faces away from its solid, or else from the normals at its vertices off solids.
  bool faces_away(const std::array<std::uint32_t, 3>& face) const {
    const auto [a, b, c] = face;
    const Vector3d normal = (x_.col(b) - x_.col(a)).cross(x_.col(c) - x_.col(a));
    if (is_wetted(face))
      return !(normal.dot(solid_normals_.col(a) + solid_normals_.col(b) + solid_normals_.col(c)) < 0);
    return has_normals_ && std::any_of(face.begin(), face.end(), [&](std::uint32_t v) {
             return !is_colliding(contact_[v]) && normal.dot(normals_.col(v)) < 0;
           });
  }

 private:
  bool is_wetted(const std::array<std::uint32_t, 3>& face) const {
    return is_colliding(contact_[face[0]]) && is_colliding(contact_[face[1]]) && is_colliding(contact_[face[2]]);
  }

  const ConstColumns before_;
  const ConstColumns x_, solid_normals_, normals_;
  const Contact* const contact_;
  const bool has_normals_, touches_solid_;
  FourVectors origin_{};
};

/// The areas, for the few substeps in which some face is violent.
void add_areas(const Drop& drop, const ConstColumns& before, FaceChanges& changes) {
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

FaceChanges find_face_changes(Drop& drop, const ConstColumns& before, std::vector<std::uint8_t>& violent) {
  const auto& triangles = drop.connectivity().triangles();
  const FaceLook look(drop, before);
  violent.resize(triangles.size());
  FaceChanges changes = sum_over_chunks(triangles.size(), FaceChanges{}, [&](std::size_t begin, std::size_t end) {
    FaceChanges part;
    Four volume_before{}, volume{};
    for (std::size_t first = begin; first < end; first += 4) {
      const auto [changed, away] = look.at(FourTriangles(triangles, first, end), volume_before, volume);
      for (std::size_t f = first; f < std::min(first + 4, end); ++f) {
        const auto& face = triangles[f];
        const bool is_there = face[0] != Connectivity::removed, seems_away = away[f - first] != 0;
        const bool is_away = is_there && look.is_in_doubt(face, seems_away) ? look.faces_away(face) : seems_away;
        violent[f] = is_there && (is_away || changed[f - first] != 0);
        part.violent += violent[f];
      }
    }
    part.volume_before = sum(volume_before) / 6;
    part.volume = sum(volume) / 6;
    return part;
  });
  if (changes.violent > 0)
    add_areas(drop, before, changes);
  else
    violent.clear();
  return changes;
}

}  // namespace meniscus
