// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/mesh_data.h"

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

/// Calls visit(corners / u) for every measurable triangle and returns u, a power of two.
template <class Visit>
double for_each_scaled_triangle(const MeshData& data, Visit visit) {
  double largest = 0;
  for (const auto& p : data.points)
    if (is_finite(p))
      for (const double x : p) largest = std::max(largest, std::abs(x));
  const double unit = unit_for(largest);
  for (const auto& t : data.triangles)
    if (is_measurable(data, t))
      visit(Corners{Eigen::Vector3d(point(data, t[0]) / unit), Eigen::Vector3d(point(data, t[1]) / unit),
                    Eigen::Vector3d(point(data, t[2]) / unit)});
  return unit;
}

template <class Visit>
double for_each_scaled_triangle(const Mesh& mesh, Visit visit) {
  double largest = 0;
  for (const auto v : mesh.vertices()) largest = std::max(largest, to_eigen(mesh.point(v)).cwiseAbs().maxCoeff());
  const double unit = unit_for(largest);
  for (const auto f : mesh.faces()) {
    const auto h = mesh.halfedge(f);
    visit(Corners{Eigen::Vector3d(to_eigen(mesh.point(mesh.source(h))) / unit),
                  Eigen::Vector3d(to_eigen(mesh.point(mesh.target(h))) / unit),
                  Eigen::Vector3d(to_eigen(mesh.point(mesh.target(mesh.next(h)))) / unit)});
  }
  return unit;
}

}  // namespace meniscus
