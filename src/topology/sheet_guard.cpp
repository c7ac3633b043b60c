// SPDX-License-Identifier: GPL-3.0-or-later
#include "sheet_guard.h"

#include "meniscus/geometry/self_intersection.h"

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

using Eigen::Vector3d;

/// So that a drop that blew up does not ask for a cell for each point of space.
constexpr double most_cells_along = 200;

bool holds(const std::vector<std::uint32_t>& list, std::uint32_t x) {
  return std::find(list.begin(), list.end(), x) != list.end();
}

Eigen::AlignedBox3d box_of_points(const std::array<Vector3d, 3>& points) {
  Eigen::AlignedBox3d box;
  for (const auto& p : points) box.extend(p);
  return box;
}

}  // namespace

Eigen::AlignedBox3d SheetGuard::region_of(const Drop& drop, double edge_max) {
  const ConstColumns x = drop.positions();
  const std::uint8_t* watch = drop.seam_watch();
  Eigen::AlignedBox3d region;
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i)
    if (watch[i] != 0 && drop.connectivity().degree(i) > 0) region.extend(Vector3d(x.col(i)));
  if (region.isEmpty()) return region;
  const double margin = 0.5 * region.sizes().maxCoeff() + 3 * edge_max;
  region.min().array() -= margin;
  region.max().array() += margin;
  return region;
}

SheetGuard::SheetGuard(const Drop& drop, const Eigen::AlignedBox3d& region, double cell)
    : drop_(drop), region_(region), cell_(std::max(cell, region.sizes().maxCoeff() / most_cells_along)) {
  const auto& triangles = drop.connectivity().triangles();
  for (std::uint32_t f = 0; f < triangles.size(); ++f)
    if (triangles[f][0] != Connectivity::removed) add(f);
}

template <class Visit>
void SheetGuard::for_each_cell(const Eigen::AlignedBox3d& box, Visit visit) const {
  const auto index = [&](double x) { return static_cast<std::int64_t>(std::floor(x / cell_)); };
  const Eigen::AlignedBox3d inside = box.intersection(region_);
  const auto& low = inside.min();
  const auto& high = inside.max();
  for (std::int64_t i = index(low.x()); i <= index(high.x()); ++i)
    for (std::int64_t j = index(low.y()); j <= index(high.y()); ++j)
      for (std::int64_t k = index(low.z()); k <= index(high.z()); ++k) visit(Cell{i, j, k});
}

Eigen::AlignedBox3d SheetGuard::box_of(std::uint32_t face) const { return box_of_points(face_at(face).points); }

SheetGuard::NewFace SheetGuard::face_at(std::uint32_t face) const {
  const auto& t = drop_.connectivity().triangles()[face];
  const ConstColumns x = drop_.positions();
  return {t, {Vector3d(x.col(t[0])), Vector3d(x.col(t[1])), Vector3d(x.col(t[2]))}};
}

void SheetGuard::add(std::uint32_t face) {
  const Eigen::AlignedBox3d box = box_of(face);
  if (!box.intersects(region_)) return;
  for_each_cell(box, [&](const Cell& cell) {
    auto& list = faces_[cell];
    if (list.empty() || list.back() != face) list.push_back(face);
  });
}

bool SheetGuard::meet(const NewFace& s, const NewFace& t) const {
  points_.clear();
  std::array<std::uint32_t, 6> names{};
  std::size_t known = 0;
  const auto number = [&](const NewFace& face) {
    std::array<std::uint32_t, 3> mapped{};
    for (int k = 0; k < 3; ++k) {
      const auto found = std::find(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(known), face.vertices[k]);
      mapped[k] = static_cast<std::uint32_t>(found - names.begin());
      if (mapped[k] < known) continue;
      names[known++] = face.vertices[k];
      points_.push_back({face.points[k].x(), face.points[k].y(), face.points[k].z()});
    }
    return mapped;
  };
  const auto i = number(s), j = number(t);
  if (known < 4) return true;  // the same three vertices
  return meet_elsewhere(points_, i, j);
}

bool SheetGuard::would_meet(const std::vector<NewFace>& faces, const std::vector<std::uint32_t>& replaced,
                            const std::vector<std::uint32_t>& removed) const {
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const Eigen::AlignedBox3d box = box_of_points(faces[i].points);
    if (!box.intersects(region_)) continue;
    for (std::size_t j = 0; j < i; ++j)
      if (meet(faces[i], faces[j])) return true;
    bool found = false;
    for_each_cell(box, [&](const Cell& cell) {
      const auto list = faces_.find(cell);
      if (found || list == faces_.end()) return;
      for (const std::uint32_t g : list->second) {
        const auto& t = drop_.connectivity().triangles()[g];
        if (t[0] == Connectivity::removed || holds(removed, g)) continue;
        if (holds(replaced, t[0]) || holds(replaced, t[1]) || holds(replaced, t[2])) continue;
        const NewFace other = face_at(g);
        if (box.intersects(box_of_points(other.points)) && meet(faces[i], other)) {
          found = true;
          return;
        }
      }
    });
    if (found) return true;
  }
  return false;
}

}  // namespace meniscus
