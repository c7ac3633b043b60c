// SPDX-License-Identifier: GPL-3.0-or-later
#include "fold_finder.h"

#include "placed_face.h"

#include <algorithm>

namespace meniscus {
namespace {

std::vector<PlacedTriangle> placed_faces(const MeshView& mesh, const std::vector<FaceBox>& faces) {
  std::vector<PlacedTriangle> placed;
  placed.reserve(faces.size());
  for (const FaceBox& face : faces) placed.push_back(placed_face(mesh, face.face));
  return placed;
}

std::vector<FacePair> faces_that_meet(const MeshView& mesh, const std::vector<FaceBox>& faces,
                                      const SortedBoxes& boxes) {
  const std::vector<PlacedTriangle> placed = placed_faces(mesh, faces);
  std::vector<FacePair> meeting;
  for (const auto& [a, b] :
       boxes.pairs_if([&](std::uint32_t a, std::uint32_t b) { return meet(placed[a], placed[b]); }))
    meeting.push_back({std::min(faces[a].face, faces[b].face), std::max(faces[a].face, faces[b].face)});
  std::sort(meeting.begin(), meeting.end());
  return meeting;
}

}  // namespace

FoldFinder::FoldFinder(const Drop& drop, std::vector<FaceBox> faces)
    : drop_(drop),
      faces_(std::move(faces)),
      boxes_(faces_),
      place_(drop.connectivity().triangles().size(), none),
      has_moved_(faces_.size(), 0),
      is_waiting_(faces_.size(), 0),
      meeting_(faces_that_meet(view_of(drop_), faces_, boxes_)) {
  for (std::uint32_t k = 0; k < faces_.size(); ++k) place_[faces_[k].face] = k;
}

void FoldFinder::move(std::uint32_t v) {
  const Ring ring = drop_.connectivity().ring(v);
  for (int k = 0; k < ring.degree; ++k) {
    const std::uint32_t place = place_of(ring.corner[k] / 3);
    if (is_waiting_[place] != 0) continue;
    is_waiting_[place] = has_moved_[place] = 1;
    waiting_.push_back(place);
  }
}

const std::vector<FacePair>& FoldFinder::meeting() {
  if (!waiting_.empty()) look_again();
  return meeting_;
}

std::uint32_t FoldFinder::place_of(std::uint32_t face) {
  if (place_[face] == none) {
    place_[face] = static_cast<std::uint32_t>(faces_.size());
    faces_.push_back({box_now(face), face});
    has_moved_.push_back(1);
    is_waiting_.push_back(0);
  }
  return place_[face];
}

void FoldFinder::add_faces_near_waiting() {
  Eigen::AlignedBox3d box;
  for (const std::uint32_t place : waiting_) box.extend(box_now(faces_[place].face));
  for (const FaceBox& near : faces_in(view_of(drop_), box)) place_of(near.face);
}

/// The boxes are where faces were at first; those that have moved since, or are new, are looked for among themselves.
void FoldFinder::look_again() {
  add_faces_near_waiting();
  const MeshView mesh = view_of(drop_);
  const auto waits = [&](std::uint32_t face) { return is_waiting_[place_[face]] != 0; };
  meeting_.erase(
      std::remove_if(meeting_.begin(), meeting_.end(), [&](const FacePair& p) { return waits(p[0]) || waits(p[1]); }),
      meeting_.end());
  std::vector<FaceBox> moved;
  for (std::uint32_t k = 0; k < faces_.size(); ++k)
    if (has_moved_[k] != 0) moved.push_back({box_now(faces_[k].face), faces_[k].face});
  const SortedBoxes moved_boxes(moved);
  for (const std::uint32_t place : waiting_) {
    const std::uint32_t f = faces_[place].face;
    const PlacedTriangle placed = placed_face(mesh, f);
    const auto test = [&](std::uint32_t g) {
      if (meet(placed, placed_face(mesh, g))) meeting_.push_back({std::min(f, g), std::max(f, g)});
    };
    const Eigen::AlignedBox3d box = placed.box();
    boxes_.for_each_meeting(box, [&](std::uint32_t k) {
      if (has_moved_[k] == 0) test(faces_[k].face);
    });
    moved_boxes.for_each_meeting(box, [&](std::uint32_t k) {
      const std::uint32_t g = moved[k].face;
      const bool is_seen_from_there = waits(g) && g < f;
      if (g != f && !is_seen_from_there) test(g);
    });
  }
  for (const std::uint32_t place : waiting_) is_waiting_[place] = 0;
  waiting_.clear();
  std::sort(meeting_.begin(), meeting_.end());
}

Eigen::AlignedBox3d FoldFinder::box_now(std::uint32_t face) const {
  return box_of(view_of(drop_), drop_.connectivity().triangles()[face]);
}

std::vector<FacePair> faces_that_meet(const MeshView& mesh, const std::vector<FaceBox>& faces) {
  return faces_that_meet(mesh, faces, SortedBoxes(faces));
}

}  // namespace meniscus
