// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/core/mesh_arrays.h"

#include "meniscus/core/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace meniscus {
namespace {

using Size = Mesh::size_type;
using Indices = std::vector<std::uint32_t>;

/// CGAL's list of removed elements, first to last: each knows the next, so the first is the one that none knows.
template <class Next>
Indices removed_in_order(const Indices& removed, std::size_t size, Next next) {
  std::vector<bool> follows(size, false);
  for (const std::uint32_t i : removed)
    if (next(i) < size) follows[next(i)] = true;
  Indices order;
  for (const std::uint32_t i : removed)
    if (!follows[i]) order.push_back(i);
  while (!order.empty() && next(order.back()) < size && order.size() < removed.size())
    order.push_back(static_cast<std::uint32_t>(next(order.back())));
  return order;
}

/// Whether an element was removed, one a flag. Throws unless each is there and named once.
std::vector<bool> removed_flags(const Indices& removed, std::size_t size, const char* what) {
  std::vector<bool> flags(size, false);
  for (const std::uint32_t i : removed) {
    if (i >= size || flags[i])
      throw GeometryError(fmt::format("removed {} {}: there is no such {}, or it is named twice", what, i, what));
    flags[i] = true;
  }
  return flags;
}

/// Looks at every index before CGAL walks along any.
class Check {
 public:
  explicit Check(const MeshArrays& arrays)
      : arrays_(arrays),
        no_vertex_(removed_flags(arrays.removed_vertices, arrays.vertex_halfedge.size(), "vertex")),
        no_edge_(removed_flags(arrays.removed_edges, arrays.halfedges.size() / 2, "edge")),
        no_face_(removed_flags(arrays.removed_faces, arrays.face_halfedge.size(), "face")) {}

  void all() const {
    require(arrays_.halfedges.size() % 2 == 0, "halfedge", arrays_.halfedges.size());
    for (std::size_t h = 0; h < arrays_.halfedges.size(); ++h)
      if (!no_edge_[h / 2]) halfedge(h);
    std::vector<std::uint32_t> incoming(arrays_.vertex_halfedge.size(), 0), sides(arrays_.face_halfedge.size(), 0);
    for (std::size_t h = 0; h < arrays_.halfedges.size(); ++h) {
      if (no_edge_[h / 2]) continue;
      ++incoming[arrays_.halfedges[h].target];
      ++sides[arrays_.halfedges[h].face];
    }
    for (std::size_t f = 0; f < arrays_.face_halfedge.size(); ++f)
      if (!no_face_[f]) face(f, sides[f]);
    for (std::size_t v = 0; v < arrays_.vertex_halfedge.size(); ++v)
      if (!no_vertex_[v]) vertex(v, incoming[v]);
  }

 private:
  static void require(bool holds, const char* what, std::size_t i) {
    if (!holds) throw GeometryError(fmt::format("{} {} is not joined as in a closed mesh of triangles", what, i));
  }
  bool is_halfedge(std::size_t h) const { return h < arrays_.halfedges.size() && !no_edge_[h / 2]; }
  const MeshArrays::Halfedge& at(std::size_t h) const { return arrays_.halfedges[h]; }

  void halfedge(std::size_t h) const {
    const auto& [target, face, next] = at(h);
    require(target < no_vertex_.size() && !no_vertex_[target] && face < no_face_.size() && !no_face_[face], "halfedge",
            h);
    require(is_halfedge(next) && next / 2 != h / 2 && at(next ^ 1u).target == target && at(next).face == face,
            "halfedge", h);
    require(is_halfedge(at(next).next) && at(at(next).next).next == h, "halfedge", h);
    require(at(h ^ 1u).target != target, "halfedge", h);
  }
  void face(std::size_t f, std::uint32_t sides) const {
    const std::uint32_t h = arrays_.face_halfedge[f];
    require(sides == 3 && is_halfedge(h) && at(h).face == f, "face", f);
  }
  /// The halfedges that point to a vertex form one fan and come from a vertex each.
  void vertex(std::size_t v, std::uint32_t incoming) const {
    const std::uint32_t first = arrays_.vertex_halfedge[v];
    require(is_halfedge(first) && at(first).target == v, "vertex", v);
    Indices neighbours;
    std::uint32_t h = first;
    do {
      h = at(h).next ^ 1u;
      neighbours.push_back(at(h ^ 1u).target);
    } while (h != first && neighbours.size() <= incoming);
    require(neighbours.size() == incoming && incoming >= 3, "vertex", v);
    std::sort(neighbours.begin(), neighbours.end());
    require(std::adjacent_find(neighbours.begin(), neighbours.end()) == neighbours.end(), "vertex", v);
  }

  const MeshArrays& arrays_;
  std::vector<bool> no_vertex_, no_edge_, no_face_;
};

}  // namespace

MeshArrays mesh_arrays(const Mesh& mesh) {
  MeshArrays arrays;
  Indices vertices, edges, faces;
  arrays.vertex_halfedge.assign(mesh.num_vertices(), 0);
  for (Size v = 0; v < mesh.num_vertices(); ++v) {
    if (mesh.is_removed(VertexIndex(v)))
      vertices.push_back(v);
    else
      arrays.vertex_halfedge[v] = mesh.halfedge(VertexIndex(v));
  }
  arrays.halfedges.assign(mesh.num_halfedges(), {0, 0, 0});
  for (Size e = 0; e < mesh.num_edges(); ++e) {
    if (mesh.is_removed(EdgeIndex(e))) {
      edges.push_back(e);
      continue;
    }
    for (const auto h : {HalfedgeIndex(2 * e), HalfedgeIndex(2 * e + 1)})
      arrays.halfedges[h] = {mesh.target(h), mesh.face(h), mesh.next(h)};
  }
  arrays.face_halfedge.assign(mesh.num_faces(), 0);
  for (Size f = 0; f < mesh.num_faces(); ++f) {
    if (mesh.is_removed(FaceIndex(f)))
      faces.push_back(f);
    else
      arrays.face_halfedge[f] = mesh.halfedge(FaceIndex(f));
  }
  arrays.removed_vertices = removed_in_order(
      vertices, mesh.num_vertices(), [&](std::uint32_t v) -> std::size_t { return mesh.halfedge(VertexIndex(v)); });
  arrays.removed_edges = removed_in_order(edges, mesh.num_edges(), [&](std::uint32_t e) -> std::size_t {
    return Size{mesh.next(HalfedgeIndex(2 * e))} / 2;  // a list of even halfedges; its end is past all of them
  });
  arrays.removed_faces = removed_in_order(faces, mesh.num_faces(),
                                          [&](std::uint32_t f) -> std::size_t { return mesh.halfedge(FaceIndex(f)); });
  if (arrays.removed_vertices.size() != vertices.size() || arrays.removed_edges.size() != edges.size() ||
      arrays.removed_faces.size() != faces.size())
    throw std::logic_error("a mesh's list of removed elements is not whole");
  return arrays;
}

Mesh to_mesh(const MeshArrays& arrays) {
  Check(arrays).all();
  const auto size = [](const auto& list) { return static_cast<Size>(list.size()); };
  Mesh mesh;
  mesh.reserve(size(arrays.vertex_halfedge), size(arrays.halfedges) / 2, size(arrays.face_halfedge));
  for (Size v = 0; v < size(arrays.vertex_halfedge); ++v) mesh.add_vertex(Point(0, 0, 0));
  for (Size e = 0; e < size(arrays.halfedges) / 2; ++e) mesh.add_edge();
  for (Size f = 0; f < size(arrays.face_halfedge); ++f) mesh.add_face();
  for (auto v = size(arrays.removed_vertices); v-- > 0;) mesh.remove_vertex(VertexIndex(arrays.removed_vertices[v]));
  for (auto e = size(arrays.removed_edges); e-- > 0;) mesh.remove_edge(EdgeIndex(arrays.removed_edges[e]));
  for (auto f = size(arrays.removed_faces); f-- > 0;) mesh.remove_face(FaceIndex(arrays.removed_faces[f]));
  for (const auto v : mesh.vertices()) mesh.set_halfedge(v, HalfedgeIndex(arrays.vertex_halfedge[v]));
  for (const auto h : mesh.halfedges()) {
    mesh.set_target(h, VertexIndex(arrays.halfedges[h].target));
    mesh.set_face(h, FaceIndex(arrays.halfedges[h].face));
    mesh.set_next(h, HalfedgeIndex(arrays.halfedges[h].next));
  }
  for (const auto f : mesh.faces()) mesh.set_halfedge(f, HalfedgeIndex(arrays.face_halfedge[f]));
  return mesh;
}

}  // namespace meniscus
