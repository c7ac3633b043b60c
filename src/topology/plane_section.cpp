// SPDX-License-Identifier: GPL-3.0-or-later
#include "plane_section.h"

namespace meniscus {

double crossing(const Mesh& mesh, HalfedgeIndex h, const Plane& plane) {
  const double s = plane.distance(mesh.point(mesh.source(h))), t = plane.distance(mesh.point(mesh.target(h)));
  return s / (s - t);
}

std::optional<Section> trace_section(const Mesh& mesh, HalfedgeIndex start, const Plane& plane, double longest) {
  const auto is_above = [&](VertexIndex v) { return plane.distance(mesh.point(v)) >= 0; };
  const auto point = [&](HalfedgeIndex h) {
    const Eigen::Vector3d p = to_eigen(mesh.point(mesh.source(h))), q = to_eigen(mesh.point(mesh.target(h)));
    return Eigen::Vector3d(p + crossing(mesh, h, plane) * (q - p));
  };
  Section section;
  auto h = start;
  Eigen::Vector3d at = point(h);
  do {
    section.crossings.push_back(h);
    // h runs from above to below; its face's third vertex says which other edge crosses.
    h = mesh.opposite(is_above(mesh.target(mesh.next(h))) ? mesh.next(h) : mesh.prev(h));
    const Eigen::Vector3d next = point(h);
    section.perimeter += (next - at).norm();
    at = next;
    if (section.perimeter > longest || section.crossings.size() > mesh.num_edges()) return std::nullopt;
  } while (h != start);
  return section;
}

HalfedgeIndex walk_to_plane(const Mesh& mesh, VertexIndex v, const Plane& plane) {
  const bool starts_above = plane.distance(mesh.point(v)) >= 0;
  const double sign = starts_above ? 1 : -1;
  double here = sign * plane.distance(mesh.point(v));
  for (;;) {
    HalfedgeIndex best = Mesh::null_halfedge();
    double nearest = here;
    for (const auto h : CGAL::halfedges_around_target(mesh.halfedge(v), mesh)) {
      const bool is_above = plane.distance(mesh.point(mesh.source(h))) >= 0;
      if (is_above != starts_above) return starts_above ? mesh.opposite(h) : h;
      const double distance = sign * plane.distance(mesh.point(mesh.source(h)));
      if (distance < nearest) {
        nearest = distance;
        best = h;
      }
    }
    if (best == Mesh::null_halfedge()) return best;
    v = mesh.source(best);
    here = nearest;
  }
}

}  // namespace meniscus
