// SPDX-License-Identifier: GPL-3.0-or-later
#include "boolean_parts.h"

// Without CGAL_NDEBUG, CGAL 5.5.1 passes over edges between patches that it has classified already, misses that a
// result is no 2-manifold there, and goes round a vertex of it for ever. Its assertions are defined by now and stay on.
#include <CGAL/assertions.h>
#ifndef CGAL_NDEBUG
#define CGAL_NDEBUG
#endif
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>

#include <algorithm>
#include <map>
#include <tuple>

namespace meniscus::boolean_parts {
namespace {

namespace PMP = CGAL::Polygon_mesh_processing;

/// An input as CGAL wants it, and where its elements come from.
struct Side {
  Mesh mesh;
  std::vector<std::uint32_t> old_vertex;               // of the mesh's first vertices
  std::vector<Triangle> old_triangle;                  // of each face, also after it was cut; in old indices
  std::map<std::array<double, 3>, VertexIndex> place;  // of vertices, once cut
};

std::array<double, 3> key(const Point& p) { return {p.x(), p.y(), p.z()}; }

Side side_of(const MeshView& view) {
  Side side;
  std::vector<std::uint32_t> row(static_cast<std::size_t>(view.points.cols()), Connectivity::removed);
  for (const auto& t : view.triangles)
    if (!is_removed(t))
      for (const auto v : t) row[v] = 0;
  for (std::uint32_t v = 0; v < row.size(); ++v)
    if (row[v] == 0) {
      row[v] = side.mesh.add_vertex(point_at(view, v));
      side.old_vertex.push_back(v);
    }
  for (const auto& t : view.triangles) {
    if (is_removed(t)) continue;
    side.mesh.add_face(VertexIndex(row[t[0]]), VertexIndex(row[t[1]]), VertexIndex(row[t[2]]));
    side.old_triangle.push_back(t);
  }
  return side;
}

/// Follows the faces as CGAL cuts them and copies them into the result.
struct Tracker : PMP::Corefinement::Default_visitor<Mesh> {
  Side* a;
  Side* b;
  Triangle current{};

  std::vector<Triangle>& old_triangle(const Mesh& mesh) {
    return &mesh == &a->mesh ? a->old_triangle : b->old_triangle;
  }
  void before_subface_creations(FaceIndex f, Mesh& mesh) { current = old_triangle(mesh)[f]; }
  void after_subface_created(FaceIndex f, Mesh& mesh) {
    auto& old = old_triangle(mesh);
    if (old.size() <= f) old.resize(f + 1);
    old[f] = current;
  }
};

/// Of the old triangles about a vertex of the cut mesh, the first: CGAL's order follows the addresses of its nodes.
Triangle first_old_triangle(const Side& side, VertexIndex v) {
  Triangle first = side.old_triangle[side.mesh.face(side.mesh.halfedge(v))];
  for (const auto f : CGAL::faces_around_target(side.mesh.halfedge(v), side.mesh))
    first = std::min(first, side.old_triangle[f]);
  return first;
}

/// Where a place of the cut mesh comes from; nothing if no vertex lies there.
std::optional<SurfacePoint> origin(const MeshView& view, const Side& side, const std::array<double, 3>& place) {
  const auto found = side.place.find(place);
  if (found == side.place.end()) return std::nullopt;
  const VertexIndex v = found->second;
  if (std::size_t{v} < side.old_vertex.size()) {
    const std::uint32_t old = side.old_vertex[v];
    return SurfacePoint{{old, old, old}, {1, 0, 0}};
  }
  return surface_point(view, first_old_triangle(side, v), Eigen::Vector3d(place[0], place[1], place[2]));
}

void find_places(Side& side) {
  for (const auto v : side.mesh.vertices()) side.place.emplace(key(side.mesh.point(v)), v);
}

/// With the least index first.
Triangle rotated(Triangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

/// The output in the order that BooleanResult promises, and in no other respect in CGAL's: that may differ from run to
/// run.
BooleanResult sorted_result(const MeshView& a, const MeshView& b, Side& side_a, Side& side_b, const Mesh& out) {
  find_places(side_a);
  find_places(side_b);
  struct Row {
    int group;  // 0: kept of A, 1: kept of B, 2: seam
    std::uint32_t old;
    std::array<double, 3> place;
    VertexIndex vertex;
    SeamVertex seam;
  };
  std::vector<Row> rows;
  for (const auto v : out.vertices()) {
    const auto place = key(out.point(v));
    const auto on_a = origin(a, side_a, place), on_b = origin(b, side_b, place);
    Row row{2, 0, place, v, {}};
    if (on_a && on_b)
      row.seam = {*on_a, *on_b};
    else
      row.group = on_a ? 0 : 1, row.old = (on_a ? on_a : on_b)->corners[0];
    rows.push_back(row);
  }
  std::sort(rows.begin(), rows.end(), [](const Row& r, const Row& s) {
    return std::tie(r.group, r.old, r.place) < std::tie(s.group, s.old, s.place);
  });
  BooleanResult result;
  result.step = BooleanStep::corefined;
  std::vector<std::uint32_t> number(out.num_vertices());
  std::vector<int> group(out.num_vertices());
  for (const Row& row : rows) {
    number[row.vertex] = static_cast<std::uint32_t>(result.points.size());
    group[row.vertex] = row.group;
    result.points.push_back(key(out.point(row.vertex)));
    if (row.group == 0) result.kept_a.push_back(row.old);
    if (row.group == 1) result.kept_b.push_back(row.old);
    if (row.group == 2) result.seam.push_back(row.seam);
  }
  std::vector<Triangle> of[3];
  for (const auto f : out.faces()) {
    const auto h = out.halfedge(f);
    const std::array<VertexIndex, 3> v{out.source(h), out.target(h), out.target(out.next(h))};
    const bool all_a = group[v[0]] == 0 && group[v[1]] == 0 && group[v[2]] == 0;
    const bool all_b = group[v[0]] == 1 && group[v[1]] == 1 && group[v[2]] == 1;
    of[all_a ? 0 : all_b ? 1 : 2].push_back(rotated({number[v[0]], number[v[1]], number[v[2]]}));
  }
  for (auto& triangles : of) {
    std::sort(triangles.begin(), triangles.end());
    result.triangles.insert(result.triangles.end(), triangles.begin(), triangles.end());
  }
  result.whole_a = of[0].size();
  result.whole_b = of[1].size();
  return result;
}

}  // namespace

std::optional<BooleanResult> corefine(const MeshView& a, const MeshView& b, BooleanOperation operation) {
  Side side_a = side_of(a), side_b = side_of(b);
  Tracker tracker;
  tracker.a = &side_a;
  tracker.b = &side_b;
  Mesh out;
  const auto np = CGAL::parameters::visitor(tracker).throw_on_self_intersection(true);
  try {
    const bool is_manifold = operation == BooleanOperation::unite
                                 ? PMP::corefine_and_compute_union(side_a.mesh, side_b.mesh, out, np)
                             : operation == BooleanOperation::intersect
                                 ? PMP::corefine_and_compute_intersection(side_a.mesh, side_b.mesh, out, np)
                                 : PMP::corefine_and_compute_difference(side_a.mesh, side_b.mesh, out, np);
    if (!is_manifold) return std::nullopt;
    PMP::remove_degenerate_faces(out);
    out.collect_garbage();
  } catch (const std::exception&) {
    return std::nullopt;
  }
  return sorted_result(a, b, side_a, side_b, out);
}

}  // namespace meniscus::boolean_parts
