// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

#include <Eigen/Core>

#include <cstdint>

/// The kernel, the mesh and the flat views of its arrays: the only place that names them.
///
/// Units everywhere: cm, g, s; angles in radians. A closed mesh is oriented outward.
namespace meniscus {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Vector = Kernel::Vector_3;
using Mesh = CGAL::Surface_mesh<Point>;
using VertexIndex = Mesh::Vertex_index;
using FaceIndex = Mesh::Face_index;
using EdgeIndex = Mesh::Edge_index;
using HalfedgeIndex = Mesh::Halfedge_index;

/// A 3 x n view of a property map of points or vectors: column i is vertex i. Nothing is copied;
/// the view is void as soon as the mesh gains an element.
using Columns = Eigen::Map<Eigen::Matrix3Xd>;
class ConstColumns : public Eigen::Map<const Eigen::Matrix3Xd> {
 public:
  using Base = Eigen::Map<const Eigen::Matrix3Xd>;
  ConstColumns(const double* data, Eigen::Index cols) : Base(data, 3, cols) {}
  ConstColumns(const Columns& columns) : Base(columns.data(), 3, columns.cols()) {}  // NOLINT: a view of a view
  ConstColumns(const Eigen::Matrix3Xd& columns) : Base(columns.data(), 3, columns.cols()) {}  // NOLINT: and of these
};

static_assert(sizeof(Point) == 3 * sizeof(double) && sizeof(Vector) == 3 * sizeof(double),
              "points and vectors map as columns of three doubles");

inline Eigen::Vector3d to_eigen(const Point& p) { return {p.x(), p.y(), p.z()}; }
inline Eigen::Vector3d to_eigen(const Vector& v) { return {v.x(), v.y(), v.z()}; }
inline Point to_point(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }
inline Vector to_vector(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/// The storage of a vertex property map of points or vectors, as columns. Rows of removed vertices
/// are part of the view.
template <class Map>
Columns columns(Mesh& mesh, Map& map) {
  return {mesh.num_vertices() == 0 ? nullptr : reinterpret_cast<double*>(&map[VertexIndex(0)]), 3,
          static_cast<Eigen::Index>(mesh.num_vertices())};
}
template <class Map>
ConstColumns columns(const Mesh& mesh, const Map& map) {
  return {mesh.num_vertices() == 0 ? nullptr : reinterpret_cast<const double*>(&map[VertexIndex(0)]),
          static_cast<Eigen::Index>(mesh.num_vertices())};
}

/// The positions of a mesh, 3 x num_vertices (cm).
inline Columns positions(Mesh& mesh) {
  auto& points = mesh.points();
  return columns(mesh, points);
}
inline ConstColumns positions(const Mesh& mesh) { return columns(mesh, mesh.points()); }

}  // namespace meniscus
