// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/topology/split.h"

#include "attribute_maps.h"
#include "meniscus/geometry/self_intersection.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <numeric>

namespace meniscus {
namespace {

/// The component of each vertex, numbered in the order of smallest vertex index; none for vertices
/// that have no faces.
struct Labels {
  static constexpr std::uint32_t none = ~std::uint32_t{0};
  std::vector<std::uint32_t> of_vertex;
  std::uint32_t count = 0;
};

Labels label_components(const Mesh& mesh) {
  Labels labels;
  labels.of_vertex.assign(mesh.num_vertices(), Labels::none);
  std::vector<VertexIndex> stack;
  for (const auto seed : mesh.vertices()) {
    if (mesh.is_isolated(seed) || labels.of_vertex[seed] != Labels::none) continue;
    const auto label = labels.count++;
    labels.of_vertex[seed] = label;
    stack.push_back(seed);
    while (!stack.empty()) {
      const auto v = stack.back();
      stack.pop_back();
      for (const auto w : CGAL::vertices_around_target(mesh.halfedge(v), mesh))
        if (labels.of_vertex[w] == Labels::none) {
          labels.of_vertex[w] = label;
          stack.push_back(w);
        }
    }
  }
  return labels;
}

std::array<VertexIndex, 3> corners(const Mesh& mesh, FaceIndex f) {
  const auto h = mesh.halfedge(f);
  return {mesh.source(h), mesh.target(h), mesh.target(mesh.next(h))};
}

/// The vertices and faces of each component, in index order.
struct Component {
  std::vector<VertexIndex> vertices;
  std::vector<FaceIndex> faces;
};

struct Components {
  std::vector<Component> list;
  std::vector<std::uint32_t> row;  // the place of a vertex among those of its component
};

Components components_of(const Mesh& mesh) {
  const Labels labels = label_components(mesh);
  Components components{std::vector<Component>(labels.count), std::vector<std::uint32_t>(mesh.num_vertices())};
  for (const auto v : mesh.vertices()) {
    if (labels.of_vertex[v] == Labels::none) continue;
    std::vector<VertexIndex>& vertices = components.list[labels.of_vertex[v]].vertices;
    components.row[v] = static_cast<std::uint32_t>(vertices.size());
    vertices.push_back(v);
  }
  for (const auto f : mesh.faces()) components.list[labels.of_vertex[mesh.target(mesh.halfedge(f))]].faces.push_back(f);
  return components;
}

Mesh extract(const Mesh& mesh, const Component& component, const std::vector<std::uint32_t>& row) {
  Mesh piece;
  piece.reserve(static_cast<Mesh::size_type>(component.vertices.size()),
                static_cast<Mesh::size_type>(3 * component.faces.size() / 2),
                static_cast<Mesh::size_type>(component.faces.size()));
  std::vector<AttributeSource> sources;
  for (const auto v : component.vertices) {
    piece.add_vertex(mesh.point(v));
    sources.push_back(same_as(v));
  }
  for (const auto f : component.faces) {
    const auto [a, b, c] = corners(mesh, f);
    piece.add_face(VertexIndex(row[b]), VertexIndex(row[c]), VertexIndex(row[a]));
  }
  gather_attributes(mesh, piece, sources);
  return piece;
}

double volume_of(const Mesh& mesh, const Component& component) {
  const Eigen::Vector3d origin = to_eigen(mesh.point(component.vertices.front()));
  double six = 0;
  for (const auto f : component.faces) {
    const auto [a, b, c] = corners(mesh, f);
    const Eigen::Vector3d p = to_eigen(mesh.point(b)) - origin, q = to_eigen(mesh.point(c)) - origin;
    six += (to_eigen(mesh.point(a)) - origin).dot(p.cross(q));
  }
  return six / 6;
}

/// A piece of so few faces that meets itself cannot be mended: it has no vertices to spare.
bool is_knot(const Mesh& mesh, const Component& component, const std::vector<std::uint32_t>& row) {
  constexpr std::size_t most_faces = 16;
  if (component.faces.size() > most_faces) return false;
  MeshData soup;
  for (const auto f : component.faces) {
    const auto [a, b, c] = corners(mesh, f);
    soup.triangles.push_back({row[a], row[b], row[c]});
  }
  for (const auto v : component.vertices) {
    const Point& p = mesh.point(v);
    soup.points.push_back({p.x(), p.y(), p.z()});
  }
  return !self_intersections(soup, 1).empty();
}

/// Adds `lost` to the target volumes: evenly, but at most 5 % of a piece's own, the rest by volume.
void share(double lost, std::vector<Drop>& pieces) {
  constexpr double most = 0.05;
  const double even = lost / static_cast<double>(pieces.size());
  double rest = lost, open_volume = 0, all_volume = 0;
  std::vector<bool> is_full(pieces.size());
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const double volume = pieces[k].target_volume();
    const double delta = std::clamp(even, -most * volume, most * volume);
    is_full[k] = delta != even;
    pieces[k].set_target_volume(volume + delta);
    rest -= delta;
    all_volume += volume;
    if (!is_full[k]) open_volume += volume;
  }
  const bool none_open = open_volume == 0;
  for (std::size_t k = 0; k < pieces.size(); ++k)
    if (none_open || !is_full[k]) {
      const double volume = pieces[k].volume();
      pieces[k].set_target_volume(pieces[k].target_volume() + rest * volume / (none_open ? all_volume : open_volume));
    }
}

}  // namespace

std::vector<Mesh> connected_components(const Mesh& mesh) {
  std::vector<Mesh> pieces;
  const Components components = components_of(mesh);
  for (const auto& component : components.list) pieces.push_back(extract(mesh, component, components.row));
  return pieces;
}

std::vector<Drop> split_components(Drop drop, SplitReport& report, double least_volume) {
  report = {};
  const Mesh& mesh = drop.mesh();
  const auto [components, row] = components_of(mesh);
  if (std::none_of(components.begin(), components.end(),
                   [&](const Component& component) { return volume_of(mesh, component) >= least_volume; }))
    least_volume = 0;
  std::vector<const Component*> kept;
  for (const auto& component : components) {
    const double volume = volume_of(mesh, component);
    if (!(volume > 0)) {
      ++report.deleted_empty;
    } else if (component.faces.size() == 4 || volume < least_volume || is_knot(mesh, component, row)) {
      ++report.deleted;
      report.volume_deleted += volume;
    } else {
      kept.push_back(&component);
    }
  }
  std::vector<Drop> pieces;
  report.pieces = kept.size();
  if (kept.size() == 1 && components.size() == 1) {
    pieces.push_back(std::move(drop));
    return pieces;
  }
  double enclosed = 0;
  for (const auto* component : kept) {
    pieces.emplace_back(extract(mesh, *component, row));
    pieces.back().set_id(drop.id());
    enclosed += pieces.back().target_volume();
  }
  report.volume_shared = drop.target_volume() - enclosed;
  if (!pieces.empty()) share(report.volume_shared, pieces);
  return pieces;
}

}  // namespace meniscus
