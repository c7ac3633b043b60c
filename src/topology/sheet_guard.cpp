// SPDX-License-Identifier: GPL-3.0-or-later
#include "sheet_guard.h"

#include "placed_face.h"

#include <algorithm>
#include <utility>

namespace meniscus {
namespace {

bool holds(const std::vector<std::uint32_t>& list, std::uint32_t x) {
  return std::find(list.begin(), list.end(), x) != list.end();
}

}  // namespace

SheetGuard::SheetGuard(const Drop& drop, WatchedRegion region) : drop_(drop), region_(std::move(region)) {}

void SheetGuard::learn_faces() {
  learnt_ = region_.faces_of(drop_);
  grid_.emplace(learnt_);
  first_entry_.assign(grid_->num_cells(), no_entry);
}

void SheetGuard::add(std::uint32_t face) {
  if (!grid_) return;
  const PlacedTriangle known = placed_face(view_of(drop_), face);
  if (!region_.covers(known.points)) return;
  if (entered_.size() <= face) entered_.resize(drop_.connectivity().triangles().size());
  const Eigen::AlignedBox3d box = known.box();
  if (entered_[face].min() == box.min() && entered_[face].max() == box.max()) return;
  entered_[face] = box;
  grid_->for_each_cell(box, [&](std::size_t cell) {
    entries_.push_back({face, first_entry_[cell]});
    first_entry_[cell] = static_cast<std::uint32_t>(entries_.size() - 1);
  });
}

void SheetGuard::forget(std::uint32_t face) {
  const auto& triangles = drop_.connectivity().triangles();
  constexpr std::uint32_t removed = Connectivity::removed;
  forgotten_.resize(std::max(forgotten_.size(), triangles.size()), Triangle{removed, removed, removed});
  forgotten_[face] = triangles[face];
}

void SheetGuard::find_near(const Eigen::AlignedBox3d& box, const std::vector<std::uint32_t>& replaced,
                           const std::vector<std::uint32_t>& removed) {
  near_.clear();
  seen_.resize(drop_.connectivity().triangles().size(), 0);
  ++query_;
  const MeshView mesh = view_of(drop_);
  const auto look_at = [&](std::uint32_t face) {
    if (std::exchange(seen_[face], query_) == query_) return;
    const Triangle& t = mesh.triangles[face];
    if (t[0] == Connectivity::removed || holds(removed, face)) return;
    if (face < forgotten_.size() && forgotten_[face] == t) return;
    if (holds(replaced, t[0]) || holds(replaced, t[1]) || holds(replaced, t[2])) return;
    if (box.intersects(box_of(mesh, t))) near_.push_back(placed_face(mesh, face));
  };
  grid_->for_each_cell(box, [&](std::size_t cell) {
    for (std::uint32_t k = first_entry_[cell]; k != no_entry; k = entries_[k].next) look_at(entries_[k].face);
  });
  grid_->for_each_meeting(box, [&](const FaceBox& other) {
    look_at(other.face);
    return true;
  });
}

bool SheetGuard::would_meet(const std::vector<NewFace>& faces, const std::vector<std::uint32_t>& replaced,
                            const std::vector<std::uint32_t>& removed) {
  if (std::none_of(faces.begin(), faces.end(), [&](const NewFace& face) { return region_.covers(face.points); }))
    return false;
  if (!grid_) learn_faces();
  new_.clear();
  Eigen::AlignedBox3d all;
  for (const NewFace& face : faces) {
    new_.emplace_back(face.vertices, face.points);
    all.extend(new_.back().box());
  }
  find_near(all, replaced, removed);
  for (std::size_t i = 0; i < new_.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      if (meet(new_[i], new_[j])) return true;
    const Eigen::AlignedBox3d box = new_[i].box();
    for (const PlacedTriangle& near : near_)
      if (box.intersects(near.box()) && meet(new_[i], near)) return true;
  }
  return false;
}

}  // namespace meniscus
