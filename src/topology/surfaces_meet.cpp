// SPDX-License-Identifier: GPL-3.0-or-later
#include "boolean_parts.h"
#include "face_grid.h"

namespace meniscus {

bool surfaces_meet(const MeshView& a, const MeshView& b) {
  using boolean_parts::triangle_of;
  const Eigen::AlignedBox3d common = box_of(a).intersection(box_of(b));
  if (common.isEmpty()) return false;
  const std::vector<FaceBox> in_a = faces_in(a, common), in_b = faces_in(b, common);
  const FaceGrid grid(in_b);
  for (const auto& s : in_a) {
    const bool none = grid.for_each_meeting(
        s.box, [&](const FaceBox& t) { return !CGAL::do_intersect(triangle_of(a, s.face), triangle_of(b, t.face)); });
    if (!none) return true;
  }
  return false;
}

}  // namespace meniscus
