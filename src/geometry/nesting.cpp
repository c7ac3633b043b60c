// SPDX-License-Identifier: GPL-3.0-or-later
#include "nesting.h"

#include "box_pairs.h"
#include "scaled_triangles.h"

#include <algorithm>

namespace meniscus {
namespace {

int sign(double x) { return (x > 0) - (x < 0); }

/// On which side of the line a -> b, seen along x, the point lies that is p moved by (epsilon,
/// epsilon^2) in (y, z): never 0 unless the line is seen as a point.
int side_of_line(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& p) {
  using Point2 = Kernel::Point_2;
  const auto exact = CGAL::orientation(Point2(a.y(), a.z()), Point2(b.y(), b.z()), Point2(p.y(), p.z()));
  if (exact != CGAL::COLLINEAR) return int(exact);
  if (a.z() != b.z()) return a.z() > b.z() ? 1 : -1;
  return sign(b.y() - a.y());
}

/// Whether the ray from p (moved as above) along +x crosses the triangle.
bool ray_crosses(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                 const Eigen::Vector3d& p) {
  for (int d = 1; d < 3; ++d)
    if (std::max({a[d], b[d], c[d]}) < p[d] || std::min({a[d], b[d], c[d]}) > p[d]) return false;
  const int turn = side_of_line(a, b, p);
  if (turn == 0 || side_of_line(b, c, p) != turn || side_of_line(c, a, p) != turn) return false;
  // Seen along x, a b c turns like `turn`, so its plane's normal has that sign along x: p must lie
  // on the side that the normal does not point to.
  return int(CGAL::orientation(to_point(a), to_point(b), to_point(c), to_point(p))) == -turn;
}

}  // namespace

std::vector<int> nesting_depths(const MeshData& data, const std::vector<std::uint32_t>& component,
                                std::size_t num_components, const std::vector<std::array<std::uint32_t, 2>>& crossing) {
  std::vector<int> depth(num_components, 0);
  std::vector<Eigen::AlignedBox3d> boxes(num_components);
  std::vector<std::vector<std::uint32_t>> faces(num_components);
  for (std::uint32_t t = 0; t < component.size(); ++t) {
    faces[component[t]].push_back(t);
    for (const auto v : data.triangles[t]) boxes[component[t]].extend(point(data, v));
  }
  const auto count_if_inside = [&](std::uint32_t inner, std::uint32_t outer) {
    if (!boxes[outer].contains(boxes[inner])) return;
    const Eigen::Vector3d p = point(data, data.triangles[faces[inner].front()][0]);
    bool inside = false;
    for (const auto t : faces[outer]) {
      const auto& [a, b, c] = data.triangles[t];
      if (ray_crosses(point(data, a), point(data, b), point(data, c), p)) inside = !inside;
    }
    depth[inner] += inside;
  };
  for_each_pair_of_boxes(boxes, [&](std::uint32_t i, std::uint32_t j) {
    const std::array<std::uint32_t, 2> pair{std::min(i, j), std::max(i, j)};
    if (!std::binary_search(crossing.begin(), crossing.end(), pair)) {
      count_if_inside(i, j);
      count_if_inside(j, i);
    }
    return true;
  });
  return depth;
}

}  // namespace meniscus
