// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/topology/boolean.h"

#include <algorithm>
#include <optional>

/// The stages of boolean(), each a function of flat arrays.
namespace meniscus::boolean_parts {

inline const Point& point_at(const MeshView& view, std::uint32_t v) {
  return reinterpret_cast<const Point*>(view.points.data())[v];  // a point is three doubles: core/types.h
}
inline Kernel::Triangle_3 triangle_of(const MeshView& view, std::uint32_t f) {
  const Triangle& t = view.triangles[f];
  return {point_at(view, t[0]), point_at(view, t[1]), point_at(view, t[2])};
}
inline bool is_removed(const Triangle& t) { return t[0] == Connectivity::removed; }
inline bool share_a_vertex(const Triangle& s, const Triangle& t) {
  bool found = false;  // all nine are compared: no branch to guess
  for (const auto v : s)
    for (const auto w : t) found |= v == w;
  return found;
}
inline Triangle turned(const Triangle& t) { return {t[0], t[2], t[1]}; }

/// The result in general position: faces that meet are cut along the seam, all others are kept or
/// dropped whole. Nothing if the surfaces are not in general position, or if a part of a face is no
/// simple polygon once crossings are rounded. Sets all but volumes. `near` are the result's
/// triangles in the common box that were kept whole. Precondition: sound inputs.
std::optional<BooleanResult> cut_locally(const MeshView& a, const MeshView& b, BooleanOperation operation,
                                         std::vector<std::uint32_t>& near);

/// The result by CGAL's corefinement of the whole meshes, points exact until the end, faces without
/// area removed; nothing if CGAL gives up, as it does where the exact result is not a 2-manifold.
/// The outcome is left open. Precondition: sound inputs.
std::optional<BooleanResult> corefine(const MeshView& a, const MeshView& b, BooleanOperation operation);

/// Whether the new triangles of a result have areas and meet neither each other nor those near them.
bool is_sound_at_seam(const BooleanResult& result, const std::vector<std::uint32_t>& near);

/// Drops rows of a result, and the triangles that hold one of them.
void keep_rows(BooleanResult& result, const std::vector<bool>& is_kept);

/// Drops the components of a result that enclose negative volume.
void drop_cavities(BooleanResult& result);

/// Drops the components of a result, drops and cavities, that enclose less than `least_volume` (cm^3), unless all do.
void drop_specks(BooleanResult& result, double least_volume);

/// Whether a point is inside a closed mesh, by a ray; of no meaning on the surface itself.
bool is_inside(const MeshView& mesh, const Point& point);

/// What a closed mesh encloses, cm^3.
double volume_of(const MeshView& view);

/// A result's points and triangles, not copied.
inline MeshView view_of(const BooleanResult& result) {
  return {
      {result.points.empty() ? nullptr : result.points.front().data(), static_cast<Eigen::Index>(result.points.size())},
      result.triangles};
}

/// The view's triangles, without removed ones, as a soup.
MeshData soup_of(const MeshView& view);

/// A result's points and triangles, copied or not.
MeshData data_of(const BooleanResult& result);

/// Faces that meet one of the other mesh, at most `limit` pairs.
void find_meeting_faces(const MeshView& a, const MeshView& b, std::size_t limit, std::vector<std::uint32_t>& faces_a,
                        std::vector<std::uint32_t>& faces_b);

/// The place of p, a point of triangle t but for rounding.
SurfacePoint surface_point(const MeshView& view, const Triangle& t, const Eigen::Vector3d& p);

}  // namespace meniscus::boolean_parts
