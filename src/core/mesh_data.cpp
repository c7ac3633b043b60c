// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/core/mesh_data.h"

#include "meniscus/core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace meniscus {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

/// A directed edge a -> b of triangle t.
struct DirectedEdge {
  std::uint32_t from, to, triangle;
};

void check_indices(const MeshData& data) {
  for (std::size_t t = 0; t < data.triangles.size(); ++t) {
    const auto& [a, b, c] = data.triangles[t];
    if (std::max({a, b, c}) >= data.points.size())
      throw GeometryError(fmt::format("face {} names vertex {}, but there are only {} vertices", data.face_in_file(t),
                                      std::max({a, b, c}), data.points.size()),
                          {data.face_in_file(t)});
    if (a == b || b == c || c == a)
      throw GeometryError(
          fmt::format("face {} ({} {} {}) names a vertex twice; remove it", data.face_in_file(t), a, b, c),
          {data.face_in_file(t)});
  }
}

/// All directed edges, sorted; throws if one direction occurs twice (an edge with three faces, or
/// two neighbours of opposite orientation).
std::vector<DirectedEdge> directed_edges(const MeshData& data) {
  std::vector<DirectedEdge> edges;
  edges.reserve(3 * data.triangles.size());
  for (std::uint32_t t = 0; t < data.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) edges.push_back({data.triangles[t][k], data.triangles[t][(k + 1) % 3], t});
  std::sort(edges.begin(), edges.end(), [](const DirectedEdge& e, const DirectedEdge& f) {
    return std::tie(e.from, e.to, e.triangle) < std::tie(f.from, f.to, f.triangle);
  });
  for (std::size_t i = 1; i < edges.size(); ++i)
    if (edges[i].from == edges[i - 1].from && edges[i].to == edges[i - 1].to) {
      const std::size_t f = data.face_in_file(edges[i - 1].triangle), g = data.face_in_file(edges[i].triangle);
      throw GeometryError(
          fmt::format("faces {} and {} run along edge {}-{} in the same direction: the edge has more than "
                      "two faces or its faces disagree on the outside; repair and orient the mesh first",
                      f, g, edges[i].from, edges[i].to),
          {f, g}, {edges[i].from, edges[i].to});
    }
  return edges;
}

/// Throws if the faces around a vertex form more than one fan.
void check_fans(const MeshData& data, const std::vector<DirectedEdge>& edges) {
  const std::size_t n = data.points.size();
  std::vector<std::uint32_t> first(n + 1, 0), outgoing(n, 0);
  for (const auto& e : edges) ++outgoing[e.from];
  for (std::size_t v = 0; v < n; ++v) first[v + 1] = first[v] + outgoing[v];
  const auto find = [&](std::uint32_t from, std::uint32_t to) -> std::uint32_t {
    const auto begin = edges.begin() + first[from], end = edges.begin() + first[from + 1];
    const auto it = std::lower_bound(begin, end, to, [](const DirectedEdge& e, std::uint32_t v) { return e.to < v; });
    return it != end && it->to == to ? static_cast<std::uint32_t>(it - edges.begin()) : kNone;
  };
  const auto apex = [&](const DirectedEdge& e) {
    for (std::uint32_t v : data.triangles[e.triangle])
      if (v != e.from && v != e.to) return v;
    return kNone;
  };
  for (std::uint32_t v = 0; v < n; ++v) {
    if (outgoing[v] == 0) continue;
    std::uint32_t start = first[v];
    for (std::uint32_t i = first[v]; i < first[v + 1]; ++i)  // an open fan starts at the edge that nothing enters by
      if (find(edges[i].to, v) == kNone) start = i;
    std::uint32_t seen = 0, i = start;
    do {
      ++seen;
      i = find(v, apex(edges[i]));
    } while (i != kNone && i != start && seen <= outgoing[v]);
    if (seen != outgoing[v])
      throw GeometryError(
          fmt::format("vertex {} is pinched: its {} faces form more than one fan; duplicate it, one copy a fan", v,
                      outgoing[v]),
          {}, {v});
  }
}

}  // namespace

const VertexAttribute* MeshData::attribute(const std::string& name) const {
  const auto it = std::find_if(attributes.begin(), attributes.end(), [&](const auto& a) { return a.name == name; });
  return it == attributes.end() ? nullptr : &*it;
}

std::string attribute_map_name(const std::string& attribute_name) { return "v:" + attribute_name; }

Mesh to_mesh(const MeshData& data) {
  check_indices(data);
  check_fans(data, directed_edges(data));
  Mesh mesh;
  mesh.reserve(data.points.size(), data.triangles.size() * 3 / 2, data.triangles.size());
  for (const auto& [x, y, z] : data.points) mesh.add_vertex(Point(x, y, z));
  for (std::size_t t = 0; t < data.triangles.size(); ++t) {
    const auto& [a, b, c] = data.triangles[t];
    if (mesh.add_face(VertexIndex(a), VertexIndex(b), VertexIndex(c)) == Mesh::null_face())
      throw GeometryError(fmt::format("face {} cannot be joined to its neighbours", data.face_in_file(t)),
                          {data.face_in_file(t)});
  }
  for (const auto& attribute : data.attributes) {
    auto map = mesh.add_property_map<VertexIndex, double>(attribute_map_name(attribute.name), 0.0).first;
    for (std::uint32_t v = 0; v < data.points.size(); ++v) map[VertexIndex(v)] = attribute.values[v];
  }
  return mesh;
}

MeshData to_mesh_data(const Mesh& mesh, const std::vector<VertexAttribute>& attributes) {
  MeshData data;
  data.points.reserve(mesh.number_of_vertices());
  data.triangles.reserve(mesh.number_of_faces());
  std::vector<std::uint32_t> row(mesh.num_vertices(), kNone);
  for (const auto v : mesh.vertices()) {
    row[v] = static_cast<std::uint32_t>(data.points.size());
    const Point& p = mesh.point(v);
    data.points.push_back({p.x(), p.y(), p.z()});
  }
  for (const auto f : mesh.faces()) {
    const auto h = mesh.halfedge(f);
    data.triangles.push_back({row[mesh.source(h)], row[mesh.target(h)], row[mesh.target(mesh.next(h))]});
  }
  for (const auto& attribute : attributes) {
    const auto [map, found] = mesh.property_map<VertexIndex, double>(attribute_map_name(attribute.name));
    if (!found) continue;
    VertexAttribute copy{attribute.name, attribute.type, {}};
    copy.values.reserve(data.points.size());
    for (const auto v : mesh.vertices()) copy.values.push_back(map[v]);
    data.attributes.push_back(std::move(copy));
  }
  return data;
}

}  // namespace meniscus
