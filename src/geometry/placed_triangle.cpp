// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/geometry/placed_triangle.h"

#include "meniscus/geometry/self_intersection.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace meniscus {
namespace {

using Eigen::Vector3d;

/// Rounding adds some 10 eps = 1e-15 |u| |v| to each component of u x v, and as much times |x| to its product with x.
constexpr double rounding_of_product = 1e-13;
/// With a smaller sine between its sides a triangle has no plane to speak of.
constexpr double least_sine = 1e-5;

/// Which corner of s each corner of t is; 3: none.
using Shared = std::array<int, 3>;

Shared shared_corners(const PlacedTriangle& s, const PlacedTriangle& t) {
  Shared shared{3, 3, 3};
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 3; ++i)
      if (s.vertices[i] == t.vertices[k]) shared[k] = i;
  return shared;
}

/// The corners of t that s lacks lie on one side of its plane.
bool is_beside_plane(const PlacedTriangle& s, const PlacedTriangle& t, const Shared& in_s) {
  double side = 0;
  for (int k = 0; k < 3; ++k) {
    if (in_s[k] < 3) continue;
    const Vector3d way = t.points[k] - s.points[0];
    const double height = s.normal.dot(way);
    if (!(std::abs(height) > s.rounding * (way.lpNorm<1>() + s.reach)) || height * side < 0) return false;
    side = height;
  }
  return side != 0;
}

/// The corners of t that a side of s lacks lie beyond that side, seen from above.
bool is_beyond_side(const PlacedTriangle& s, const PlacedTriangle& t, const Shared& in_s) {
  for (int i = 0; i < 3; ++i) {
    const int next = (i + 1) % 3;
    const Vector3d along = s.points[next] - s.points[i], inward = s.normal.cross(along);
    const double rounding = s.rounding * along.lpNorm<1>();
    bool is_beyond = true;
    for (int k = 0; k < 3 && is_beyond; ++k) {
      if (in_s[k] == i || in_s[k] == next) continue;
      const Vector3d way = t.points[k] - s.points[i];
      is_beyond = inward.dot(way) < -rounding * (way.lpNorm<1>() + s.reach);
    }
    if (is_beyond) return true;
  }
  return false;
}

}  // namespace

PlacedTriangle::PlacedTriangle(const std::array<std::uint32_t, 3>& its_vertices,
                               const std::array<Vector3d, 3>& its_points)
    : vertices(its_vertices), points(its_points) {
  const Vector3d u = points[1] - points[0], v = points[2] - points[0];
  normal = u.cross(v);
  const double length_u = u.lpNorm<1>(), length_v = v.lpNorm<1>(), size = length_u * length_v;
  reach = length_u + length_v;
  const bool is_wide = normal.squaredNorm() > least_sine * least_sine * size * size;
  rounding = is_wide ? rounding_of_product * size : std::numeric_limits<double>::infinity();
}

bool meet(const PlacedTriangle& s, const PlacedTriangle& t) {
  const Shared in_s = shared_corners(s, t), in_t = shared_corners(t, s);
  if (is_beside_plane(s, t, in_s) || is_beside_plane(t, s, in_t)) return false;
  if (is_beyond_side(s, t, in_s) || is_beyond_side(t, s, in_t)) return false;
  if (in_s[0] < 3 && in_s[1] < 3 && in_s[2] < 3) return true;
  const auto at = [&](std::uint32_t v) {
    const auto* const in = std::find(s.vertices.begin(), s.vertices.end(), v);
    return to_point(in != s.vertices.end()
                        ? s.points[static_cast<std::size_t>(in - s.vertices.begin())]
                        : t.points[static_cast<std::size_t>(std::find(t.vertices.begin(), t.vertices.end(), v) -
                                                            t.vertices.begin())]);
  };
  return meet_elsewhere(at, s.vertices, t.vertices);
}

}  // namespace meniscus
