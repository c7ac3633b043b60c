// SPDX-License-Identifier: GPL-3.0-or-later
#include "boolean_parts.h"
#include "face_grid.h"

#include <algorithm>

namespace meniscus {
namespace {

/// Calls visit(f, g) for faces that meet, until it returns false; then returns false too.
template <class Visit>
bool for_each_meeting_pair(const MeshView& a, const MeshView& b, Visit visit) {
  using boolean_parts::triangle_of;
  const Eigen::AlignedBox3d common = box_of(a).intersection(box_of(b));
  if (common.isEmpty()) return true;
  const std::vector<FaceBox> in_a = faces_in(a, common);
  if (in_a.empty()) return true;
  const std::vector<FaceBox> in_b = faces_in(b, common);
  const FaceGrid grid(in_b);
  for (const auto& s : in_a) {
    const bool go_on = grid.for_each_meeting(s.box, [&](const FaceBox& t) {
      return !CGAL::do_intersect(triangle_of(a, s.face), triangle_of(b, t.face)) || visit(s.face, t.face);
    });
    if (!go_on) return false;
  }
  return true;
}

void sort_and_unique(std::vector<std::uint32_t>& faces) {
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
}

}  // namespace

bool surfaces_meet(const MeshView& a, const MeshView& b) {
  return !for_each_meeting_pair(a, b, [](std::uint32_t, std::uint32_t) { return false; });
}

void boolean_parts::find_meeting_faces(const MeshView& a, const MeshView& b, std::size_t limit,
                                       std::vector<std::uint32_t>& faces_a, std::vector<std::uint32_t>& faces_b) {
  for_each_meeting_pair(a, b, [&](std::uint32_t f, std::uint32_t g) {
    faces_a.push_back(f);
    faces_b.push_back(g);
    return faces_a.size() < limit;
  });
  sort_and_unique(faces_a);
  sort_and_unique(faces_b);
}

}  // namespace meniscus
