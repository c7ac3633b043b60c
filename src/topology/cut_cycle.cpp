// SPDX-License-Identifier: GPL-3.0-or-later
#include "cut_cycle.h"

#include <CGAL/boost/graph/Euler_operations.h>

#include <algorithm>

namespace meniscus {
namespace {

/// The halfedges into the vertex between `in` and `out` (source of out = target of in), on the right
/// of that path, in order; the last is opposite(out).
std::vector<HalfedgeIndex> incoming_on_the_right(const Mesh& mesh, HalfedgeIndex in, HalfedgeIndex out) {
  std::vector<HalfedgeIndex> incoming;
  // Turning clockwise about the vertex from `in` sweeps its left side; the other way sweeps its right.
  for (auto h = in; h != mesh.opposite(out);) {
    h = mesh.prev(mesh.opposite(h));
    incoming.push_back(h);
  }
  return incoming;
}

int faces_between(const Mesh& mesh, HalfedgeIndex in, HalfedgeIndex out) {
  int faces = 0;
  for (auto h = in; h != mesh.opposite(out); h = mesh.opposite(mesh.next(h))) ++faces;
  return faces;
}

/// Fills the loop of faceless halfedges that starts at `first`, and returns the centre if there is one.
VertexIndex cap(Mesh& mesh, HalfedgeIndex first) {
  const auto face = mesh.add_face();
  mesh.set_halfedge(face, first);
  int edges = 0;
  auto h = first;
  do {
    mesh.set_face(h, face);
    ++edges;
    h = mesh.next(h);
  } while (h != first);
  if (edges == 3) return Mesh::null_vertex();
  return mesh.target(CGAL::Euler::add_center_vertex(first, mesh));
}

}  // namespace

bool is_cuttable(const Mesh& mesh, const std::vector<HalfedgeIndex>& cycle) {
  const std::size_t n = cycle.size();
  if (n < 3) return false;
  std::vector<VertexIndex> vertices;
  vertices.reserve(n);
  for (const auto h : cycle) vertices.push_back(mesh.source(h));
  std::sort(vertices.begin(), vertices.end());
  if (std::adjacent_find(vertices.begin(), vertices.end()) != vertices.end()) return false;
  for (std::size_t i = 0; i < n; ++i) {
    const auto in = cycle[(i + n - 1) % n], out = cycle[i];
    // The left side of the path in-out is swept by turning clockwise from `in`.
    if (faces_between(mesh, in, out) < 2) return false;
    if (faces_between(mesh, mesh.opposite(out), mesh.opposite(in)) < 2) return false;
  }
  return true;
}

CycleCut cut_along_cycle(Mesh& mesh, const std::vector<HalfedgeIndex>& cycle) {
  const std::size_t n = cycle.size();
  CycleCut cut;
  std::vector<std::vector<HalfedgeIndex>> right_side(n);
  for (std::size_t i = 0; i < n; ++i) right_side[i] = incoming_on_the_right(mesh, cycle[(i + n - 1) % n], cycle[i]);
  for (std::size_t i = 0; i < n; ++i) {
    const Point point = mesh.point(mesh.source(cycle[i]));  // not a reference: the array may move
    cut.copies.push_back(mesh.add_vertex(point));
  }
  for (std::size_t i = 0; i < n; ++i)
    for (const auto h : right_side[i]) mesh.set_target(h, cut.copies[i]);

  // Halfedge i of the cycle keeps its opposite, which becomes the left cap's; the right face gets a
  // new halfedge in its place, whose opposite is the right cap's.
  std::vector<HalfedgeIndex> left_cap(n), right_face(n), right_cap(n);
  for (std::size_t i = 0; i < n; ++i) {
    left_cap[i] = mesh.opposite(cycle[i]);
    right_face[i] = mesh.add_edge();
    right_cap[i] = mesh.opposite(right_face[i]);
  }
  for (std::size_t i = 0; i < n; ++i) {
    const auto old = left_cap[i];
    const auto face = mesh.face(old);
    const auto next = mesh.next(old), prev = mesh.prev(old);
    mesh.set_face(right_face[i], face);
    mesh.set_halfedge(face, right_face[i]);
    mesh.set_next(right_face[i], next);
    mesh.set_next(prev, right_face[i]);
    mesh.set_target(right_face[i], cut.copies[i]);
    mesh.set_target(right_cap[i], cut.copies[(i + 1) % n]);
  }
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t j = (i + 1) % n;
    mesh.set_next(left_cap[j], left_cap[i]);
    mesh.set_next(right_cap[i], right_cap[j]);
    mesh.set_target(left_cap[i], mesh.target(cycle[(i + n - 1) % n]));
    mesh.set_halfedge(mesh.target(cycle[i]), cycle[i]);
    mesh.set_halfedge(cut.copies[j], right_cap[i]);
  }
  cut.left_center = cap(mesh, left_cap[0]);
  cut.right_center = cap(mesh, right_cap[0]);
  return cut;
}

}  // namespace meniscus
