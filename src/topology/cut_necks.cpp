// SPDX-License-Identifier: GPL-3.0-or-later
#include "attribute_maps.h"
#include "cut_cycle.h"
#include "meniscus/core/error.h"
#include "meniscus/topology/split.h"
#include "plane_section.h"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/boost/graph/Euler_operations.h>
#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>

namespace meniscus {
namespace {

using Primitive = CGAL::AABB_face_graph_triangle_primitive<Mesh>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

constexpr double growth = 1.25;  // of the perimeter, to both sides of a neck
constexpr int directions = 12;   // of the axis, tried about a vertex's normal
constexpr int steps = 400;       // along the axis, an eighth of the diameter each
constexpr double snap = 0.15;    // crossings nearer to a vertex, in edge lengths, take the vertex

/// A vertex on whose other side, straight through the liquid, the surface is near.
struct ThinPlace {
  double thickness;
  VertexIndex vertex;
  Eigen::Vector3d normal;
};

std::vector<ThinPlace> thin_places(const Drop& drop, double diameter) {
  const Mesh& mesh = drop.mesh();
  SurfaceGeometry geometry;
  geometry.compute(drop.positions(), drop.connectivity());
  Tree tree(faces(mesh).begin(), faces(mesh).end(), mesh);
  std::vector<ThinPlace> places;
  for (const auto v : mesh.vertices()) {
    const Eigen::Vector3d n = geometry.normal(v);
    if (!(n.squaredNorm() > 0)) continue;
    const Kernel::Segment_3 through(mesh.point(v), mesh.point(v) - 1.05 * diameter * to_vector(n));
    std::vector<FaceIndex> hit;
    tree.all_intersected_primitives(through, std::back_inserter(hit));
    double nearest = diameter;
    for (const auto f : hit) {
      const auto h = mesh.halfedge(f);
      const std::array<VertexIndex, 3> t{mesh.source(h), mesh.target(h), mesh.target(mesh.next(h))};
      if (std::find(t.begin(), t.end(), v) != t.end()) continue;
      const Vector m = CGAL::cross_product(mesh.point(t[1]) - mesh.point(t[0]), mesh.point(t[2]) - mesh.point(t[0]));
      const double along = -(m * to_vector(n));
      if (!(along > 0)) continue;  // leaving the liquid only
      nearest = std::min(nearest, (m * (mesh.point(v) - mesh.point(t[0]))) / -along);
    }
    if (nearest < diameter && nearest > 0) places.push_back({nearest, v, n});
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const ThinPlace& a, const ThinPlace& b) { return a.thickness < b.thickness; });
  return places;
}

struct Neck {
  Plane plane;
  Section section;
};

/// The section through v by the plane at `offset` along `axis`; nothing if there is none or a long one.
std::optional<Section> section_at(const Mesh& mesh, VertexIndex v, const Plane& plane, double longest) {
  const auto h = walk_to_plane(mesh, v, plane);
  return h == Mesh::null_halfedge() ? std::nullopt : trace_section(mesh, h, plane, longest);
}

/// Follows the sections to one side of `neck` until they have grown; the narrowest one is kept.
/// False if the surface closes first.
bool grows(const Mesh& mesh, VertexIndex v, double direction, double step, Neck& neck) {
  const Plane from = neck.plane;
  for (int k = 1; k <= steps; ++k) {
    const Plane plane{from.normal, from.offset + direction * k * step};
    const auto h = walk_to_plane(mesh, v, plane);
    if (h == Mesh::null_halfedge()) return false;
    const auto section = trace_section(mesh, h, plane, growth * neck.section.perimeter);
    if (!section) return true;  // longer than that
    if (section->perimeter < neck.section.perimeter) neck = {plane, *section};
    v = mesh.source(h);
  }
  return false;
}

/// The neck about a thin place, if it is one.
std::optional<Neck> neck_at(const Mesh& mesh, const ThinPlace& place, double diameter) {
  const double longest = 3.141592653589793 * diameter;
  const Eigen::Vector3d x = to_eigen(mesh.point(place.vertex));
  const Eigen::Vector3d u = place.normal.unitOrthogonal(), w = place.normal.cross(u);
  std::optional<Neck> best;
  for (int k = 0; k < directions; ++k) {
    const double angle = 3.141592653589793 * k / directions;
    const Eigen::Vector3d axis = std::cos(angle) * u + std::sin(angle) * w;
    const Plane plane{axis, axis.dot(x) - 1e-3 * diameter};
    const auto section = section_at(mesh, place.vertex, plane, best ? best->section.perimeter : longest);
    if (section) best = Neck{plane, *section};
  }
  if (!best) return std::nullopt;
  Neck neck = *best;
  const double step = diameter / 8;
  // The narrowest place may lie to one side: start again there, so that growth is measured from it.
  for (int round = 0; round < 3; ++round) {
    const double before = neck.section.perimeter;
    const auto start = mesh.source(neck.section.crossings.front());
    const Neck from = neck;
    for (const double direction : {1.0, -1.0}) {
      Neck side = from;
      if (!grows(mesh, start, direction, step, side)) return std::nullopt;
      if (side.section.perimeter < neck.section.perimeter) neck = side;
    }
    if (!(neck.section.perimeter < before)) break;
  }
  return neck;
}

/// A fan about the mean of the section's points faces one way only.
bool is_star_shaped(const Mesh& mesh, const Neck& neck) {
  std::vector<Eigen::Vector3d> points;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto h : neck.section.crossings) {
    const Eigen::Vector3d p = to_eigen(mesh.point(mesh.source(h))), q = to_eigen(mesh.point(mesh.target(h)));
    points.push_back(p + crossing(mesh, h, neck.plane) * (q - p));
    mean += points.back();
  }
  mean /= static_cast<double>(points.size());
  int sign = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double area = neck.plane.normal.dot((points[k] - mean).cross(points[(k + 1) % points.size()] - mean));
    const int s = area > 0 ? 1 : area < 0 ? -1 : 0;
    if (s != 0 && sign != 0 && s != sign) return false;
    if (s != 0) sign = s;
  }
  return sign != 0;
}

/// The vertices of the section, made where it crosses edges away from their ends; none repeated in a row.
std::vector<VertexIndex> insert_vertices(Mesh& mesh, AttributeMaps& attributes, const Neck& neck) {
  std::vector<VertexIndex> loop;
  for (const auto h : neck.section.crossings) {
    const double t = crossing(mesh, h, neck.plane);
    const auto a = mesh.source(h), b = mesh.target(h);
    auto v = t < snap ? a : b;
    if (t >= snap && t <= 1 - snap) {
      const Eigen::Vector3d p = to_eigen(mesh.point(a)), q = to_eigen(mesh.point(b));
      v = mesh.target(CGAL::Euler::split_edge(h, mesh));
      mesh.point(v) = to_point(p + t * (q - p));
      attributes.interpolate(v, a, b, t);
    }
    const bool closes = !loop.empty() && loop.front() == v && h == neck.section.crossings.back();
    if (loop.empty() || (loop.back() != v && !closes)) loop.push_back(v);
  }
  while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
  return loop;
}

/// The halfedge from a to b, made by cutting their common face if it is not there; null if they have none.
HalfedgeIndex connect(Mesh& mesh, VertexIndex a, VertexIndex b) {
  const auto found = mesh.halfedge(a, b);
  if (found != Mesh::null_halfedge()) return found;
  for (const auto h : CGAL::halfedges_around_target(mesh.halfedge(a), mesh))
    for (auto k = mesh.next(mesh.next(h)); k != h; k = mesh.next(k))
      if (mesh.target(k) == b) {
        CGAL::Euler::split_face(h, k, mesh);
        return mesh.halfedge(a, b);
      }
  return Mesh::null_halfedge();
}

/// Cuts every face of more than three vertices about the given vertices into triangles.
void triangulate_around(Mesh& mesh, const std::vector<VertexIndex>& vertices) {
  for (const auto v : vertices) {
    std::vector<FaceIndex> around;
    for (const auto h : CGAL::halfedges_around_target(mesh.halfedge(v), mesh)) around.push_back(mesh.face(h));
    for (const auto f : around)
      for (auto h = mesh.halfedge(f); mesh.next(mesh.next(mesh.next(h))) != h;) {
        // Cut off the corner opposite to the shortest diagonal that is no edge yet.
        HalfedgeIndex best = Mesh::null_halfedge();
        double shortest = std::numeric_limits<double>::infinity();
        for (const auto k : CGAL::halfedges_around_face(h, mesh)) {
          const auto a = mesh.source(k), b = mesh.target(mesh.next(k));
          const double length2 = CGAL::squared_distance(mesh.point(a), mesh.point(b));
          if (length2 < shortest && mesh.halfedge(a, b) == Mesh::null_halfedge()) {
            shortest = length2;
            best = k;
          }
        }
        if (best == Mesh::null_halfedge()) break;
        const auto made = CGAL::Euler::split_face(mesh.prev(best), mesh.next(best), mesh);
        const auto other = mesh.opposite(made);
        h = mesh.next(mesh.next(mesh.next(made))) == made ? other : made;
      }
  }
}

void place_center(Mesh& mesh, AttributeMaps& attributes, VertexIndex center, const std::vector<VertexIndex>& loop) {
  if (center == Mesh::null_vertex()) return;
  attributes.copy(center, loop[0]);
  Eigen::Vector3d mean = to_eigen(mesh.point(loop[0]));
  for (std::size_t k = 1; k < loop.size(); ++k) {
    attributes.interpolate(center, center, loop[k], 1.0 / static_cast<double>(k + 1));
    mean += (to_eigen(mesh.point(loop[k])) - mean) / static_cast<double>(k + 1);
  }
  mesh.point(center) = to_point(mean);
}

/// Returns whether it cut. The mesh may have gained vertices on the section if not.
bool cut_at(Mesh& mesh, const Neck& neck, double gap) {
  AttributeMaps attributes;
  attributes.bind(mesh);
  const auto loop = insert_vertices(mesh, attributes, neck);
  std::vector<HalfedgeIndex> cycle;
  for (std::size_t k = 0; k < loop.size() && loop.size() >= 3; ++k)
    cycle.push_back(connect(mesh, loop[k], loop[(k + 1) % loop.size()]));
  triangulate_around(mesh, loop);
  if (std::find(cycle.begin(), cycle.end(), Mesh::null_halfedge()) != cycle.end() || !is_cuttable(mesh, cycle))
    return false;
  const auto cut = cut_along_cycle(mesh, cycle);
  for (std::size_t k = 0; k < loop.size(); ++k) attributes.copy(cut.copies[k], loop[k]);
  place_center(mesh, attributes, cut.left_center, loop);
  place_center(mesh, attributes, cut.right_center, loop);
  // The left side lies where the third vertices of the cycle's faces are.
  const double side = neck.plane.distance(mesh.point(mesh.target(mesh.next(cycle[0])))) >= 0 ? 1 : -1;
  const auto move = [&](VertexIndex v, double distance) {
    if (v != Mesh::null_vertex()) mesh.point(v) = mesh.point(v) + distance * to_vector(neck.plane.normal);
  };
  for (const auto v : loop) move(v, side * gap);
  for (const auto v : cut.copies) move(v, -side * gap);
  move(cut.left_center, side * gap);
  move(cut.right_center, -side * gap);
  return true;
}

}  // namespace

CutReport cut_necks(Drop& drop, double diameter) {
  if (!(diameter > 0) || !std::isfinite(diameter))
    throw UsageError(fmt::format("the neck diameter must be finite and above 0; it is {} cm", diameter));
  CutReport report;
  std::vector<Eigen::Vector3d> given_up;
  constexpr int most_cuts = 10000;
  for (bool again = true; again && report.cuts < most_cuts;) {
    again = false;
    for (const auto& place : thin_places(drop, diameter)) {
      const Eigen::Vector3d x = to_eigen(drop.mesh().point(place.vertex));
      const auto is_near = [&](const Eigen::Vector3d& p) { return (p - x).norm() < diameter; };
      if (std::any_of(given_up.begin(), given_up.end(), is_near)) continue;
      const auto neck = neck_at(drop.mesh(), place, diameter);
      if (!neck) continue;
      Mesh mesh = drop.mesh();
      if (!is_star_shaped(mesh, *neck) || !cut_at(mesh, *neck, 0.01 * diameter)) {
        given_up.push_back(x);
        ++report.refused;
        continue;
      }
      Drop after(std::move(mesh));
      after.set_target_volume(drop.target_volume());
      after.set_id(drop.id());
      drop = std::move(after);
      ++report.cuts;
      again = true;  // the surface is another one: look anew
      break;
    }
  }
  return report;
}

}  // namespace meniscus
