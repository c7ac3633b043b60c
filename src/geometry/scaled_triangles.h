// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/mesh_data.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace meniscus {

using Corners = std::array<Eigen::Vector3d, 3>;

/// A power of two u such that coordinates of up to `largest` in size are at most about 1 after division by u.
inline double unit_for(double largest) {
  const int exponent = largest > 0 ? std::ilogb(largest) : 0;
  return std::ldexp(1.0, std::min(1000, std::max(-1000, exponent)));
}

inline bool is_finite(const std::array<double, 3>& p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

/// Whether the three vertices are there and differ.
inline bool has_valid_indices(const MeshData& data, const std::array<std::uint32_t, 3>& t) {
  const std::size_t n = data.points.size();
  return t[0] < n && t[1] < n && t[2] < n && t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
}

/// Whether the three vertices are there, differ and have finite coordinates.
inline bool is_measurable(const MeshData& data, const std::array<std::uint32_t, 3>& t) {
  return has_valid_indices(data, t) && is_finite(data.points[t[0]]) && is_finite(data.points[t[1]]) &&
         is_finite(data.points[t[2]]);
}

inline Eigen::Vector3d point(const MeshData& data, std::uint32_t v) {
  return Eigen::Vector3d::Map(data.points[v].data());
}

/// The largest size of each coordinate.
inline Eigen::Array3d largest_coordinates(const MeshData& data) {
  Eigen::Array3d largest = Eigen::Array3d::Zero();
  for (const auto& p : data.points)
    if (is_finite(p)) largest = largest.max(Eigen::Array3d::Map(p.data()).abs());
  return largest;
}
inline Eigen::Array3d largest_coordinates(const Mesh& mesh) {
  Eigen::Array3d largest = Eigen::Array3d::Zero();
  for (const auto v : mesh.vertices()) largest = largest.max(to_eigen(mesh.point(v)).array().abs());
  return largest;
}

/// Calls visit(corners, each coordinate divided by its unit) for every measurable triangle.
template <class Visit>
void for_each_triangle(const MeshData& data, const Eigen::Vector3d& unit, Visit visit) {
  for (const auto& t : data.triangles)
    if (is_measurable(data, t))
      visit(Corners{Eigen::Vector3d(point(data, t[0]).cwiseQuotient(unit)),
                    Eigen::Vector3d(point(data, t[1]).cwiseQuotient(unit)),
                    Eigen::Vector3d(point(data, t[2]).cwiseQuotient(unit))});
}
template <class Visit>
void for_each_triangle(const Mesh& mesh, const Eigen::Vector3d& unit, Visit visit) {
  const auto at = [&](VertexIndex v) -> Eigen::Vector3d { return to_eigen(mesh.point(v)).cwiseQuotient(unit); };
  for (const auto f : mesh.faces()) {
    const auto h = mesh.halfedge(f);
    visit(Corners{at(mesh.source(h)), at(mesh.target(h)), at(mesh.target(mesh.next(h)))});
  }
}

/// for_each_triangle with one unit for all axes; returns it.
template <class Triangles, class Visit>
double for_each_scaled_triangle(const Triangles& source, Visit visit) {
  const double unit = unit_for(largest_coordinates(source).maxCoeff());
  for_each_triangle(source, Eigen::Vector3d::Constant(unit), visit);
  return unit;
}

/// for_each_triangle with a unit for each axis, so that even the volume of a needle does not underflow.
template <class Triangles, class Visit>
Eigen::Vector3d for_each_triangle_scaled_by_axis(const Triangles& source, Visit visit) {
  const Eigen::Vector3d unit = largest_coordinates(source).unaryExpr(&unit_for);
  for_each_triangle(source, unit, visit);
  return unit;
}

}  // namespace meniscus
