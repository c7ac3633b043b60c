// SPDX-License-Identifier: GPL-3.0-or-later
#include "face_grid.h"

#include <cmath>

namespace meniscus {
namespace {

/// A grid may have this many entries and cells a box.
constexpr std::size_t most_per_box = 8, most_cells_per_box = 32;

}  // namespace

FaceGrid::FaceGrid(const std::vector<FaceBox>& boxes) : boxes_(boxes) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& box : boxes_) {
    extent_.extend(box.box);
    sum += box.box.sizes();
  }
  if (boxes_.empty()) return;
  double size = (sum / static_cast<double>(boxes_.size())).maxCoeff();
  while (!try_cells(size)) size *= 2;
}

bool FaceGrid::try_cells(double cell_size) {
  const Eigen::Array3d sizes = extent_.sizes();
  const double most = static_cast<double>(most_cells_per_box * boxes_.size() + 1);
  Eigen::Array3d cells = Eigen::Array3d::Ones();
  if (cell_size > 0) cells = (sizes / cell_size).ceil().max(1.0).min(most);
  if (cells.prod() > most) return false;
  for (int d = 0; d < 3; ++d) {
    per_length_[d] = cells[d] / sizes[d];
    if (std::isfinite(per_length_[d])) continue;  // else the faces lie flat, up to numbers next to zero
    per_length_[d] = 0;
    cells[d] = 1;
  }
  cells_ = cells.cast<int>();
  first_.assign(static_cast<std::size_t>(cells.prod()) + 1, 0);
  std::size_t count = 0;
  for (const auto& box : boxes_)
    count += static_cast<std::size_t>((cell(box.box.max()) - cell(box.box.min()) + 1).prod());
  if (count > most_per_box * boxes_.size() && first_.size() > 2) return false;
  for (const auto& box : boxes_) for_each_cell(box.box, [&](std::size_t c) { ++first_[c + 1]; });
  for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
  entries_.resize(first_.back());
  std::vector<std::uint32_t> at(first_.begin(), first_.end() - 1);
  for (std::uint32_t k = 0; k < boxes_.size(); ++k)
    for_each_cell(boxes_[k].box, [&](std::size_t c) { entries_[at[c]++] = k; });
  return true;
}

Eigen::AlignedBox3d box_of(const MeshView& view) {
  Eigen::AlignedBox3d box;
  for (const auto& t : view.triangles)
    if (t[0] != Connectivity::removed)
      for (const auto v : t) box.extend(view.points.col(v));
  return box;
}

std::vector<FaceBox> faces_in(const MeshView& view, const Eigen::AlignedBox3d& region) {
  std::vector<FaceBox> faces;
  for (std::uint32_t f = 0; f < view.triangles.size(); ++f) {
    const Triangle& t = view.triangles[f];
    if (t[0] == Connectivity::removed) continue;
    const Eigen::AlignedBox3d box = box_of(view, t);
    if (region.intersects(box)) faces.push_back({box, f});
  }
  return faces;
}

}  // namespace meniscus
