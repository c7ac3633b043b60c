// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/core/error.h"
#include "meniscus/geometry/inspect.h"
#include "meniscus/topology/merge_meshes.h"
#include "meniscus/topology/split.h"

#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace meniscus {
namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using Place = std::array<double, 3>;

/// Points are named by where they are from here on, so that attributes find them again.
struct Welded {
  std::vector<Point> points;
  std::vector<std::vector<std::size_t>> polygons;
  std::map<Place, std::uint32_t> old;  // the first of the soup's points at each place
};

Welded weld(const MeshData& soup) {
  Welded welded;
  std::map<Place, std::size_t> number;
  std::set<std::array<std::size_t, 3>> seen;
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    std::vector<std::size_t> polygon;
    for (const auto v : soup.triangles[t]) {
      if (v >= soup.points.size()) break;
      Place place = soup.points[v];
      for (double& x : place) {
        if (!std::isfinite(x))
          throw GeometryError(fmt::format("vertex {} has a coordinate that is not a finite number; nothing can be "
                                          "known about where it should be",
                                          v),
                              {}, {v});
        x += 0.0;  // -0 is 0
      }
      const auto [at, is_new] = number.emplace(place, welded.points.size());
      if (is_new) {
        welded.points.emplace_back(place[0], place[1], place[2]);
        welded.old.emplace(place, v);
      }
      polygon.push_back(at->second);
    }
    if (polygon.size() < 3) continue;
    std::array<std::size_t, 3> key{polygon[0], polygon[1], polygon[2]};
    std::sort(key.begin(), key.end());
    if (key[0] == key[1] || key[1] == key[2] || !seen.insert(key).second) continue;
    welded.polygons.push_back(polygon);
  }
  return welded;
}

void fill_holes(Mesh& mesh) {
  std::vector<HalfedgeIndex> holes;
  std::vector<bool> seen(mesh.num_halfedges(), false);
  for (const auto h : mesh.halfedges()) {
    if (!mesh.is_border(h) || seen[h]) continue;
    holes.push_back(h);
    for (const auto other : CGAL::halfedges_around_face(h, mesh)) seen[other] = true;
  }
  for (const auto h : holes) {
    std::vector<FaceIndex> faces;
    PMP::triangulate_hole(mesh, h, std::back_inserter(faces));
  }
}

MeshData with_attributes(MeshData data, const Welded& welded, const MeshData& soup) {
  data.comments = soup.comments;
  for (const auto& attribute : soup.attributes) {
    VertexAttribute copy{attribute.name, attribute.type, {}};
    for (const auto& p : data.points) copy.values.push_back(attribute.values[welded.old.at(p)]);
    data.attributes.push_back(std::move(copy));
  }
  return data;
}

/// Turns each component of a closed mesh so that it encloses a positive volume; one that encloses none has no outside.
void turn_outward(Mesh& mesh) {
  auto component = mesh.add_property_map<FaceIndex, std::size_t>("f:component", 0).first;
  std::vector<std::vector<FaceIndex>> faces(PMP::connected_components(mesh, component));
  for (const auto f : mesh.faces()) faces[component[f]].push_back(f);
  for (const auto& part : faces) {
    const Eigen::Vector3d origin = to_eigen(mesh.point(mesh.source(mesh.halfedge(part.front()))));
    double six_volumes = 0;
    for (const auto f : part) {
      const auto h = mesh.halfedge(f);
      const auto corner = [&](VertexIndex v) -> Eigen::Vector3d { return to_eigen(mesh.point(v)) - origin; };
      six_volumes += corner(mesh.source(h)).dot(corner(mesh.target(h)).cross(corner(mesh.target(mesh.next(h)))));
    }
    if (six_volumes < 0) PMP::reverse_face_orientations(part, mesh);
  }
  mesh.remove_property_map(component);
}

/// Components that overlap become one.
MeshData unite_components(const MeshData& data) {
  std::vector<MeshData> parts;
  for (const auto& piece : connected_components(to_mesh(data))) parts.push_back(to_mesh_data(piece, data.attributes));
  MeshMergeReport report;
  auto united = merge_meshes(parts, BooleanOperation::unite, {}, report);
  if (!united) throw GeometryError("its components cannot be united: " + report.message);
  united->comments = data.comments;
  return *std::move(united);
}

}  // namespace

MeshData repair_soup(const MeshData& soup) {
  Welded welded = weld(soup);
  if (welded.polygons.empty()) throw GeometryError("the mesh has no faces");
  PMP::orient_polygon_soup(welded.points, welded.polygons);
  Mesh mesh;
  PMP::polygon_soup_to_polygon_mesh(welded.points, welded.polygons, mesh);
  PMP::remove_degenerate_faces(mesh);
  fill_holes(mesh);
  mesh.collect_garbage();
  if (CGAL::is_closed(mesh)) turn_outward(mesh);
  MeshData data = with_attributes(to_mesh_data(mesh), welded, soup);
  if (CGAL::is_closed(mesh) && connected_components(mesh).size() > 1 && !inspect(data).sound)
    return unite_components(data);
  require_sound(data);
  return data;
}

}  // namespace meniscus
