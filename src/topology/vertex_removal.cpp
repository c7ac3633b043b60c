// SPDX-License-Identifier: GPL-3.0-or-later
#include "remesh_state.h"

#include <CGAL/boost/graph/Euler_operations.h>

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

using Eigen::Vector3d;

constexpr std::size_t most_corners = 12;

/// The triangulation of a vertex' ring, a polygon in space, whose worst triangle is best.
class RingTriangulation {
 public:
  RingTriangulation(const RemeshState& state, VertexIndex v) : state_(state) {
    const Ring ring = state.ring(v);
    corners_.assign(ring.neighbour, ring.neighbour + ring.degree);
    Vector3d sum = Vector3d::Zero();
    const Vector3d origin = state.point(v);
    for (std::size_t i = 0; i < size(); ++i) sum += (point(i) - origin).cross(point((i + 1) % size()) - origin);
    normal_ = sum.stableNormalized();
    best_.assign(size() * size(), 1);
    apex_.assign(size() * size(), 0);
  }
  std::size_t size() const { return corners_.size(); }
  std::uint32_t corner(std::size_t i) const { return corners_[i]; }
  std::size_t apex(std::size_t i, std::size_t j) const { return apex_[i * size() + j]; }

  /// False if every triangulation has a sliver, a face turned over, or an edge that is there already.
  bool find() {
    for (std::size_t length = 2; length < size(); ++length)
      for (std::size_t i = 0; i + length < size(); ++i) {
        const std::size_t j = i + length;
        double& best = best_[i * size() + j];
        best = 0;
        if (length + 1 < size() && is_edge(i, j)) continue;
        for (std::size_t k = i + 1; k < j; ++k) {
          const double worst = std::min({best_[i * size() + k], best_[k * size() + j], quality(i, k, j)});
          if (worst <= best) continue;
          best = worst;
          apex_[i * size() + j] = k;
        }
      }
    return best_[size() - 1] > least_quality;
  }
  /// Calls visit(i, k, j) for each triangle.
  template <class Visit>
  void for_each(std::size_t i, std::size_t j, const Visit& visit) const {
    if (j - i < 2) return;
    const std::size_t k = apex(i, j);
    visit(i, k, j);
    for_each(i, k, visit);
    for_each(k, j, visit);
  }
  template <class Visit>
  void for_each(const Visit& visit) const {
    for_each(0, size() - 1, visit);
  }

 private:
  static constexpr double least_quality = 0.1;  // 1 for an equilateral triangle

  Vector3d point(std::size_t i) const { return state_.point(VertexIndex(corners_[i])); }
  bool is_edge(std::size_t i, std::size_t j) const {
    return state_.mesh.halfedge(VertexIndex(corners_[i]), VertexIndex(corners_[j])).is_valid();
  }
  double quality(std::size_t i, std::size_t k, std::size_t j) const {
    const Vector3d a = point(i), b = point(k), c = point(j), n = (b - a).cross(c - a);
    const double squares = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
    return n.dot(normal_) > 0 && squares > 0 ? 2 * std::sqrt(3.0) * n.norm() / squares : 0;
  }

  const RemeshState& state_;
  std::vector<std::uint32_t> corners_;
  Vector3d normal_;
  std::vector<double> best_;
  std::vector<std::size_t> apex_;
};

/// The ring's vertices keep three neighbours at least.
bool keeps_valences(const RemeshState& state, const RingTriangulation& ring) {
  std::array<int, most_corners> degree{};
  for (std::size_t i = 0; i < ring.size(); ++i) degree[i] = state.connectivity.degree(ring.corner(i)) - 2;
  ring.for_each([&](std::size_t i, std::size_t k, std::size_t j) { ++degree[i], ++degree[k], ++degree[j]; });
  return std::all_of(degree.begin(), degree.begin() + static_cast<std::ptrdiff_t>(ring.size()),
                     [](int d) { return d >= 3; });
}

/// Cuts the face left of `h`, whose corners from target(h) on are i to j, into the triangles found.
void cut_face(Mesh& mesh, HalfedgeIndex h, std::size_t i, std::size_t j, const RingTriangulation& ring) {
  if (j - i < 3) return;
  const std::size_t k = ring.apex(i, j);
  const auto vertex = [&](std::size_t c) { return VertexIndex(ring.corner(c)); };
  const auto into = [&](VertexIndex v) {  // the halfedge of this face
    auto g = h;
    while (mesh.target(g) != v) g = mesh.next(g);
    return g;
  };
  if (k - i >= 2) {
    CGAL::Euler::split_face(h, into(vertex(k)), mesh);
    cut_face(mesh, mesh.halfedge(vertex(k), vertex(i)), i, k, ring);
  }
  if (j - k >= 2) {
    h = mesh.halfedge(vertex(j), vertex(i));
    CGAL::Euler::split_face(into(vertex(k)), into(vertex(j)), mesh);
    cut_face(mesh, mesh.halfedge(vertex(j), vertex(k)), k, j, ring);
  }
}

}  // namespace

bool try_remove_vertex(RemeshState& state, VertexIndex v) {
  Mesh& mesh = state.mesh;
  const auto degree = static_cast<std::size_t>(state.connectivity.degree(v));
  if (!state.scratch.guard || !state.scratch.guard->covers(state.point(v))) return false;
  if (degree < 4 || degree > most_corners || state.colliding(v)) return false;
  RingTriangulation ring(state, v);
  if (!ring.find() || !keeps_valences(state, ring)) return false;
  auto& faces = state.scratch.new_faces;
  faces.clear();
  ring.for_each([&](std::size_t i, std::size_t k, std::size_t j) {
    const std::array<std::uint32_t, 3> corners{ring.corner(i), ring.corner(k), ring.corner(j)};
    const auto point = [&](std::uint32_t c) { return state.point(VertexIndex(c)); };
    faces.push_back({corners, {point(corners[0]), point(corners[1]), point(corners[2])}});
  });
  if (state.would_meet_sheet({v}, {})) return false;

  for (const auto h : CGAL::halfedges_around_target(mesh.halfedge(v), mesh))
    state.connectivity.remove_face(mesh.face(h));
  const VertexIndex first(ring.corner(0)), last(ring.corner(degree - 1));
  CGAL::Euler::remove_center_vertex(mesh.halfedge(v), mesh);
  cut_face(mesh, mesh.halfedge(last, first), 0, degree - 1, ring);
  state.connectivity.grow(mesh);
  state.update(v);
  for (std::size_t i = 0; i < degree; ++i) state.update(VertexIndex(ring.corner(i)));
  for (std::size_t i = 0; i < degree; ++i) state.queue_ring(VertexIndex(ring.corner(i)));
  ++state.report.collapses;
  return true;
}

}  // namespace meniscus
