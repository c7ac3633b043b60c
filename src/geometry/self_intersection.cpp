// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/geometry/self_intersection.h"

#include "box_pairs.h"
#include "scaled_triangles.h"

#include <CGAL/box_intersection_d.h>

#include <algorithm>

namespace meniscus {
namespace {

using Triple = std::array<std::uint32_t, 3>;
using Points = std::vector<std::array<double, 3>>;

Point cgal_point(const Points& points, std::uint32_t v) { return {points[v][0], points[v][1], points[v][2]}; }

Kernel::Triangle_3 triangle(const std::array<Point, 3>& t) { return {t[0], t[1], t[2]}; }

/// Whether one of two planes through the first corner of both triangles, which they share, clearly parts the
/// rest of them: the quick answer to most pairs. Says no if rounding could matter.
bool is_clearly_apart(const std::array<Point, 3>& s, const std::array<Point, 3>& t) {
  const auto from_first = [&](const Point& p) -> Eigen::Vector3d { return to_eigen(p) - to_eigen(s[0]); };
  const Eigen::Vector3d a = from_first(s[1]), b = from_first(s[2]), c = from_first(t[1]), d = from_first(t[2]);
  const auto part = [&](const Eigen::Vector3d& m) {
    const double least = 1e-28 * m.squaredNorm();
    const auto clearly_ahead = [&](const Eigen::Vector3d& x, double sign) {
      const double way = sign * x.dot(m);
      return way > 0 && way * way > least * x.squaredNorm();  // false for NaN, too
    };
    return clearly_ahead(a, 1) && clearly_ahead(b, 1) && clearly_ahead(c, -1) && clearly_ahead(d, -1);
  };
  return part(a + b - c - d) ||
         part((a.normalized() + b.normalized()).normalized() - (c.normalized() + d.normalized()).normalized());
}

/// The same for triangles whose first two corners are the same edge: they form more than a right angle there.
bool is_clearly_unfolded(const std::array<Point, 3>& s, const std::array<Point, 3>& t) {
  const auto from_first = [&](const Point& p) -> Eigen::Vector3d { return to_eigen(p) - to_eigen(s[0]); };
  const Eigen::Vector3d edge = from_first(s[1]), m = edge.cross(from_first(s[2])), n = edge.cross(from_first(t[2]));
  const double cosine = m.dot(n);
  return cosine < 0 && cosine * cosine > 1e-20 * m.squaredNorm() * n.squaredNorm();
}

/// The triangles that can be judged, each set of three vertices once.
std::vector<std::uint32_t> candidates(const MeshData& data) {
  std::vector<std::pair<Triple, std::uint32_t>> keys;
  for (std::uint32_t t = 0; t < data.triangles.size(); ++t) {
    Triple key = data.triangles[t];
    if (!is_measurable(data, key)) continue;
    if (CGAL::collinear(cgal_point(data.points, key[0]), cgal_point(data.points, key[1]),
                        cgal_point(data.points, key[2])))
      continue;
    std::sort(key.begin(), key.end());
    keys.emplace_back(key, t);
  }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end(), [](const auto& a, const auto& b) { return a.first == b.first; }),
             keys.end());
  std::vector<std::uint32_t> result;
  result.reserve(keys.size());
  for (const auto& [key, t] : keys) result.push_back(t);
  std::sort(result.begin(), result.end());
  return result;
}

struct Stop {};

}  // namespace

bool meet_elsewhere(const std::array<Point, 3>& s, const std::array<Point, 3>& t, int num_shared) {
  if (num_shared == 0) return CGAL::do_intersect(triangle(s), triangle(t));
  if (num_shared == 1)  // they share more than the vertex if the side opposite in one meets the other
    return !is_clearly_apart(s, t) && (CGAL::do_intersect(triangle(s), Kernel::Segment_3(t[1], t[2])) ||
                                       CGAL::do_intersect(triangle(t), Kernel::Segment_3(s[1], s[2])));
  return !is_clearly_unfolded(s, t) && CGAL::orientation(s[0], s[1], s[2], t[2]) == CGAL::COPLANAR &&
         CGAL::coplanar_orientation(s[0], s[1], s[2], t[2]) == CGAL::POSITIVE;
}

void for_each_pair_of_boxes(const std::vector<Eigen::AlignedBox3d>& boxes,
                            const std::function<bool(std::uint32_t, std::uint32_t)>& visit) {
  using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t,
                                                        CGAL::Box_intersection_d::ID_FROM_BOX_ADDRESS>;
  std::vector<Box> infos;  // their addresses grow with their index: ties are broken the same way in every run
  infos.reserve(boxes.size());
  for (const auto& box : boxes) {
    const auto &low = box.min(), &high = box.max();
    infos.emplace_back(CGAL::Bbox_3(low.x(), low.y(), low.z(), high.x(), high.y(), high.z()),
                       static_cast<std::uint32_t>(infos.size()));
  }
  std::vector<const Box*> pointers;
  pointers.reserve(infos.size());
  for (const auto& box : infos) pointers.push_back(&box);
  try {
    CGAL::box_self_intersection_d(
        pointers.begin(), pointers.end(),
        [&](const Box* a, const Box* b) {
          if (!visit(a->info(), b->info())) throw Stop();
        },
        std::ptrdiff_t(50));
  } catch (const Stop&) {
  }
}

std::vector<std::array<std::uint32_t, 2>> self_intersections(const MeshData& data, std::size_t limit) {
  std::vector<std::array<std::uint32_t, 2>> pairs;
  if (limit == 0) return pairs;
  const std::vector<std::uint32_t> faces = candidates(data);
  std::vector<Eigen::AlignedBox3d> boxes;
  boxes.reserve(faces.size());
  for (const auto f : faces) {
    Eigen::AlignedBox3d box;
    for (const auto v : data.triangles[f]) box.extend(point(data, v));
    boxes.push_back(box);
  }
  const auto at = [&](std::uint32_t v) { return cgal_point(data.points, v); };
  for_each_pair_of_boxes(boxes, [&](std::uint32_t i, std::uint32_t j) {
    const std::uint32_t low = faces[std::min(i, j)], high = faces[std::max(i, j)];
    if (meet_elsewhere(at, data.triangles[low], data.triangles[high])) pairs.push_back({low, high});
    return pairs.size() < limit;
  });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace meniscus
