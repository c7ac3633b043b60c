// SPDX-License-Identifier: GPL-3.0-or-later
#include "triangulate_loops.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace meniscus {
namespace {

using Point2 = Kernel::Point_2;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

constexpr std::size_t most_corners = 64;  // of a loop for which all triangulations are looked at: n^3/6 triangles

/// The least height of a triangle; not positive if it turns right or not at all.
double least_height(const Point2& a, const Point2& b, const Point2& c) {
  constexpr double clear = 1e-12;  // beyond this, rounding cannot have made the sign
  const auto u = b - a, v = c - b, w = a - c;
  const double area = u.x() * v.y() - u.y() * v.x();
  const double longest = std::max({u.squared_length(), v.squared_length(), w.squared_length()});
  const double height = area / std::sqrt(longest);
  if (std::abs(area) > clear * longest) return height;
  return CGAL::left_turn(a, b, c) ? std::max(height, std::numeric_limits<double>::min()) : -1;
}

/// Of all triangulations of a simple loop the one whose thinnest triangle is thickest (rounding moves
/// corners by an absolute amount), by dynamic programming:
/// best(i, j) is that of the corners i to j. Triangles that all turn left cannot overlap.
bool triangulate_best(const std::vector<Point2>& points, const std::vector<std::uint32_t>& loop, Triangles& triangles) {
  const std::size_t n = loop.size();
  if (n < 3) return false;
  std::vector<double> values(n * n);
  std::vector<std::size_t> apexes(n * n);
  const auto best = [&](std::size_t i, std::size_t j) -> double& { return values[i * n + j]; };
  const auto apex = [&](std::size_t i, std::size_t j) -> std::size_t& { return apexes[i * n + j]; };
  for (std::size_t i = 0; i + 1 < n; ++i) best(i, i + 1) = std::numeric_limits<double>::infinity();
  for (std::size_t gap = 2; gap < n; ++gap)
    for (std::size_t i = 0, j = gap; j < n; ++i, ++j) {
      best(i, j) = -1;
      apex(i, j) = i + 1;
      for (std::size_t k = i + 1; k < j; ++k) {
        const double sides = std::min(best(i, k), best(k, j));
        if (sides <= best(i, j)) continue;
        const double worst = std::min(sides, least_height(points[loop[i]], points[loop[k]], points[loop[j]]));
        if (worst > best(i, j)) best(i, j) = worst, apex(i, j) = k;
      }
    }
  if (!(best(0, n - 1) > 0)) return false;
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, n - 1}};
  while (!open.empty()) {
    const auto [i, j] = open.back();
    open.pop_back();
    if (j - i < 2) continue;
    const std::size_t k = apex(i, j);
    triangles.push_back({loop[i], loop[k], loop[j]});
    open.push_back({i, k});
    open.push_back({k, j});
  }
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
  std::vector<std::vector<Delaunay::Vertex_handle>> handles;
  std::size_t corners = 0;
  for (const auto& loop : loops) {
    handles.emplace_back();
    for (const auto k : loop) {
      handles.back().push_back(delaunay.insert(points[k]));
      handles.back().back()->info() = k;
    }
    corners += loop.size();
  }
  // Two corners at one place, or all on a line: CGAL takes neither as ends of a constraint.
  if (delaunay.number_of_vertices() != corners || delaunay.dimension() < 2) return false;
  try {
    for (const auto& loop : handles)
      for (std::size_t k = 0; k < loop.size(); ++k) delaunay.insert_constraint(loop[k], loop[(k + 1) % loop.size()]);
  } catch (const Delaunay::Intersection_of_constraints_exception&) {
    return false;
  }
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
  if (loops.size() == 1 && loops[0].size() <= most_corners) return triangulate_best(points, loops[0], triangles);
  return triangulate_by_delaunay(points, loops, triangles);
}

}  // namespace meniscus
