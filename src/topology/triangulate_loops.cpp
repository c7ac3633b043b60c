// SPDX-License-Identifier: GPL-3.0-or-later
#include "triangulate_loops.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

namespace meniscus {
namespace {

using Point2 = Kernel::Point_2;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

constexpr std::size_t most_ears = 24;  // corners of a loop for which looking at all ears is the quicker way

/// How near a triangle is to an equilateral one, times a constant.
double shape(const Point2& a, const Point2& b, const Point2& c) {
  const auto u = b - a, v = c - b, w = a - c;
  return (u.x() * v.y() - u.y() * v.x()) / (u.squared_length() + v.squared_length() + w.squared_length());
}

bool is_in_triangle(const Point2& p, const Point2& a, const Point2& b, const Point2& c) {
  return !CGAL::right_turn(a, b, p) && !CGAL::right_turn(b, c, p) && !CGAL::right_turn(c, a, p);
}

bool cut_ears(const std::vector<Point2>& points, std::vector<std::uint32_t> loop, Triangles& triangles) {
  const auto is_ear = [&](std::size_t k, std::size_t before, std::size_t after) {
    const Point2 &a = points[loop[before]], &b = points[loop[k]], &c = points[loop[after]];
    if (!CGAL::left_turn(a, b, c)) return false;
    for (std::size_t j = 0; j < loop.size(); ++j)
      if (j != k && j != before && j != after && is_in_triangle(points[loop[j]], a, b, c)) return false;
    return true;
  };
  while (loop.size() > 3) {
    std::size_t best = loop.size();
    double best_shape = -1;
    const std::size_t n = loop.size();
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t before = (k + n - 1) % n, after = (k + 1) % n;
      const double s = shape(points[loop[before]], points[loop[k]], points[loop[after]]);
      if (s > best_shape && is_ear(k, before, after)) best = k, best_shape = s;
    }
    if (best == n) return false;
    triangles.push_back({loop[(best + n - 1) % n], loop[best], loop[(best + 1) % n]});
    loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(best));
  }
  if (loop.size() < 3 || !CGAL::left_turn(points[loop[0]], points[loop[1]], points[loop[2]])) return false;
  triangles.push_back({loop[0], loop[1], loop[2]});
  return true;
}

using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<int, Kernel, CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Delaunay =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
                                               CGAL::No_constraint_intersection_tag>;

/// Numbers the faces by how many constraints lie between them and the outside.
void mark_depths(Delaunay& delaunay) {
  constexpr int unseen = -1;
  for (const auto f : delaunay.all_face_handles()) f->info() = unseen;
  std::vector<Delaunay::Face_handle> now{delaunay.infinite_face()}, next;
  for (int depth = 0; !now.empty(); ++depth, now.swap(next), next.clear())
    while (!now.empty()) {
      const auto f = now.back();
      now.pop_back();
      if (f->info() != unseen) continue;
      f->info() = depth;
      for (int k = 0; k < 3; ++k)
        if (f->neighbor(k)->info() == unseen) (f->is_constrained(k) ? next : now).push_back(f->neighbor(k));
    }
}

bool triangulate_by_delaunay(const std::vector<Point2>& points, const Loops& loops, Triangles& triangles) {
  Delaunay delaunay;
  std::size_t corners = 0;
  try {
    for (const auto& loop : loops) {
      std::vector<Delaunay::Vertex_handle> handles;
      for (const auto k : loop) {
        handles.push_back(delaunay.insert(points[k]));
        handles.back()->info() = k;
      }
      corners += loop.size();
      for (std::size_t k = 0; k < loop.size(); ++k)
        delaunay.insert_constraint(handles[k], handles[(k + 1) % loop.size()]);
    }
  } catch (const Delaunay::Intersection_of_constraints_exception&) {
    return false;
  }
  if (delaunay.number_of_vertices() != corners) return false;
  std::size_t constraints = 0;
  for (auto e = delaunay.constrained_edges_begin(); e != delaunay.constrained_edges_end(); ++e) ++constraints;
  if (constraints != corners) return false;  // a side passes through a corner
  mark_depths(delaunay);
  for (const auto f : delaunay.finite_face_handles())
    if (f->info() % 2 == 1) triangles.push_back({f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()});
  return true;
}

}  // namespace

bool triangulate_loops(const std::vector<Point2>& points, const Loops& loops, Triangles& triangles) {
  if (loops.size() == 1 && loops[0].size() <= most_ears) return cut_ears(points, loops[0], triangles);
  return triangulate_by_delaunay(points, loops, triangles);
}

}  // namespace meniscus
