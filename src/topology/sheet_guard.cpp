// SPDX-License-Identifier: GPL-3.0-or-later
#include "sheet_guard.h"

#include "meniscus/geometry/self_intersection.h"

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

using Eigen::Vector3d;

/// So that a face far larger than others does not ask for a cell for each point of space.
constexpr double most_cells_along = 20;

bool holds(const std::vector<std::uint32_t>& list, std::uint32_t x) {
  return std::find(list.begin(), list.end(), x) != list.end();
}

Eigen::AlignedBox3d box_of_points(const std::array<Vector3d, 3>& points) {
  Eigen::AlignedBox3d box;
  for (const auto& p : points) box.extend(p);
  return box;
}

/// The corners of t that s lacks lie on one side of s, by more than rounding can tell: the two meet in what they share
/// only.
bool is_clearly_beside(const SheetGuard::NewFace& s, const SheetGuard::NewFace& t) {
  constexpr double rounding = 1e-10;
  const Vector3d u = s.points[1] - s.points[0], v = s.points[2] - s.points[0], n = u.cross(v);
  const double size = n.norm();
  double side = 0;
  for (int k = 0; k < 3; ++k) {
    if (std::find(s.vertices.begin(), s.vertices.end(), t.vertices[k]) != s.vertices.end()) continue;
    const Vector3d w = t.points[k] - s.points[0];
    const double height = n.dot(w);
    if (!(std::abs(height) > rounding * size * (w.norm() + u.norm() + v.norm())) || height * side < 0) return false;
    side = height;
  }
  return side != 0;
}

bool meet(const SheetGuard::NewFace& s, const SheetGuard::NewFace& t) {
  if (is_clearly_beside(s, t) || is_clearly_beside(t, s)) return false;
  const auto in_s = [&](std::uint32_t v) {
    return std::find(s.vertices.begin(), s.vertices.end(), v) - s.vertices.begin();
  };
  if (in_s(t.vertices[0]) < 3 && in_s(t.vertices[1]) < 3 && in_s(t.vertices[2]) < 3) return true;
  const auto at = [&](std::uint32_t v) {
    const auto k = in_s(v);
    return to_point(k < 3 ? s.points[static_cast<std::size_t>(k)]
                          : t.points[static_cast<std::size_t>(std::find(t.vertices.begin(), t.vertices.end(), v) -
                                                              t.vertices.begin())]);
  };
  return meet_elsewhere(at, s.vertices, t.vertices);
}

}  // namespace

SheetGuard::SheetGuard(const Drop& drop, WatchedRegion region, double cell)
    : drop_(drop), region_(std::move(region)), cell_(cell) {}

void SheetGuard::learn_faces() {
  learnt_ = region_.faces_of(drop_);
  grid_.emplace(learnt_);
  for (const FaceBox& face : learnt_) cell_ = std::max(cell_, face.box.sizes().maxCoeff() / most_cells_along);
}

SheetGuard::Cell SheetGuard::cell_of(const Vector3d& x) const {
  return {static_cast<std::int64_t>(std::floor(x[0] / cell_)), static_cast<std::int64_t>(std::floor(x[1] / cell_)),
          static_cast<std::int64_t>(std::floor(x[2] / cell_))};
}

template <class Visit>
void SheetGuard::for_each_cell(const Eigen::AlignedBox3d& box, Visit visit) const {
  const Cell low = cell_of(box.min()), high = cell_of(box.max());
  for (std::int64_t i = low[0]; i <= high[0]; ++i)
    for (std::int64_t j = low[1]; j <= high[1]; ++j)
      for (std::int64_t k = low[2]; k <= high[2]; ++k) visit(Cell{i, j, k});
}

template <class Visit>
bool SheetGuard::for_each_near(const Eigen::AlignedBox3d& box, Visit visit) const {
  if (!grid_->for_each_meeting(box, [&](const FaceBox& other) { return visit(other.face); })) return false;
  bool go_on = true;
  if (!added_.empty())
    for_each_cell(box, [&](const Cell& cell) {
      const auto list = added_.find(cell);
      if (go_on && list != added_.end()) go_on = std::all_of(list->second.begin(), list->second.end(), visit);
    });
  return go_on;
}

SheetGuard::NewFace SheetGuard::face_at(std::uint32_t face) const {
  const auto& t = drop_.connectivity().triangles()[face];
  const ConstColumns x = drop_.positions();
  return {t, {Vector3d(x.col(t[0])), Vector3d(x.col(t[1])), Vector3d(x.col(t[2]))}};
}

void SheetGuard::add(std::uint32_t face) {
  if (!grid_) return;
  const NewFace known = face_at(face);
  if (!region_.covers(known.points)) return;
  for_each_cell(box_of_points(known.points), [&](const Cell& cell) {
    auto& list = added_[cell];
    if (list.empty() || list.back() != face) list.push_back(face);
  });
}

bool SheetGuard::would_meet(const std::vector<NewFace>& faces, const std::vector<std::uint32_t>& replaced,
                            const std::vector<std::uint32_t>& removed) {
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (!region_.covers(faces[i].points)) continue;
    if (!grid_) learn_faces();
    for (std::size_t j = 0; j < i; ++j)
      if (meet(faces[i], faces[j])) return true;
    const Eigen::AlignedBox3d box = box_of_points(faces[i].points);
    const bool meets_none = for_each_near(box, [&](std::uint32_t g) {
      const auto& t = drop_.connectivity().triangles()[g];
      if (t[0] == Connectivity::removed || holds(removed, g)) return true;
      if (holds(replaced, t[0]) || holds(replaced, t[1]) || holds(replaced, t[2])) return true;
      const NewFace other = face_at(g);
      return !box.intersects(box_of_points(other.points)) || !meet(faces[i], other);
    });
    if (!meets_none) return true;
  }
  return false;
}

}  // namespace meniscus
