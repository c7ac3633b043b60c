// SPDX-License-Identifier: GPL-3.0-or-later
#include "fold_finder.h"

#include "boolean_parts.h"
#include "placed_face.h"

#include <algorithm>

namespace meniscus {
namespace {

using Eigen::Vector3d;

std::vector<PlacedTriangle> placed_faces(const MeshView& mesh, const std::vector<FaceBox>& faces) {
  std::vector<PlacedTriangle> placed;
  placed.reserve(faces.size());
  for (const FaceBox& face : faces) placed.push_back(placed_face(mesh, face.face));
  return placed;
}

/// What is known of the faces around a vertex.
struct Fan {
  Vector3d normal = Vector3d::Zero();  // the sum of theirs
  Vector3d across = Vector3d::Zero();  // with an edge's: on which side of a plane along the normal the edge goes
  double least = 0;                    // with a face's unit normal: no less, or it leans over
  int missing = 0;                     // faces that are not in the list, or lean over
  int turns = 0;                       // how often they go around
};

/// Of each face the vertices around which the surface is a graph over a plane, so that the faces there meet each other
/// in nothing but what they share; for others a number that is there once.
std::vector<Triangle> graph_vertices(const MeshView& mesh, const std::vector<PlacedTriangle>& faces) {
  constexpr double least_cosine = 0.1;
  std::vector<Fan> fans(static_cast<std::size_t>(mesh.points.cols()));
  for (const Triangle& t : mesh.triangles)
    if (t[0] != Connectivity::removed)
      for (const auto v : t) ++fans[v].missing;
  for (const PlacedTriangle& face : faces)
    for (const auto v : face.vertices) {
      --fans[v].missing;
      fans[v].normal += face.normal;
    }
  for (Fan& fan : fans) {
    if (fan.missing != 0) continue;
    Eigen::Index axis = 0;
    fan.normal.cwiseAbs().minCoeff(&axis);
    fan.across = fan.normal.cross(Vector3d::Unit(axis));
    fan.least = least_cosine * fan.normal.norm();
  }
  for (const PlacedTriangle& face : faces) {
    const double length = face.normal.norm();
    for (int k = 0; k < 3; ++k) {
      const Vector3d& p = face.points[k];
      Fan& fan = fans[face.vertices[k]];
      const bool is_upright = face.has_plane() && face.normal.dot(fan.normal) > fan.least * length;
      fan.missing += !is_upright;
      fan.turns +=
          fan.across.dot(face.points[(k + 1) % 3] - p) <= 0 && fan.across.dot(face.points[(k + 2) % 3] - p) > 0;
    }
  }
  std::vector<Triangle> vertices;
  vertices.reserve(faces.size());
  std::uint32_t no_vertex = ~std::uint32_t{0};
  for (const PlacedTriangle& face : faces) {
    vertices.push_back(face.vertices);
    for (auto& v : vertices.back())
      if (fans[v].missing != 0 || fans[v].turns != 1) v = no_vertex--;
  }
  return vertices;
}

std::vector<FacePair> faces_that_meet(const MeshView& mesh, const std::vector<FaceBox>& faces,
                                      const SortedBoxes& boxes) {
  const std::vector<PlacedTriangle> placed = placed_faces(mesh, faces);
  const std::vector<Triangle> around = graph_vertices(mesh, placed);
  std::vector<FacePair> meeting;
  for (const auto& [a, b] : boxes.pairs_if([&](std::uint32_t a, std::uint32_t b) {
         return !boolean_parts::share_a_vertex(around[a], around[b]) && meet(placed[a], placed[b]);
       }))
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
