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
Eigen::Vector3d eigen_point(const Points& points, std::uint32_t v) { return Eigen::Vector3d::Map(points[v].data()); }

Kernel::Triangle_3 triangle(const Points& points, const Triple& t) {
  return {cgal_point(points, t[0]), cgal_point(points, t[1]), cgal_point(points, t[2])};
}

/// Turned so that the vertices shared with `other` come first; returns how many there are.
int shared_first(Triple& t, const Triple& other) {
  const auto is_shared = [&](std::uint32_t v) { return v == other[0] || v == other[1] || v == other[2]; };
  return int(std::partition(t.begin(), t.end(), is_shared) - t.begin());
}

/// Whether a plane through the first vertex of both triangles, which they share, clearly parts the
/// rest of them: the quick answer to most pairs. Says no if rounding could matter.
bool is_clearly_apart(const Points& points, const Triple& s, const Triple& t) {
  const Eigen::Vector3d v = eigen_point(points, s[0]);
  const Eigen::Vector3d a = eigen_point(points, s[1]) - v, b = eigen_point(points, s[2]) - v;
  const Eigen::Vector3d c = eigen_point(points, t[1]) - v, d = eigen_point(points, t[2]) - v;
  const Eigen::Vector3d m =
      (a.normalized() + b.normalized()).normalized() - (c.normalized() + d.normalized()).normalized();
  const auto clearly_ahead = [](const Eigen::Vector3d& x, const Eigen::Vector3d& direction) {
    return x.dot(direction) > 1e-14 * x.norm() * direction.norm();  // false for NaN, too
  };
  return clearly_ahead(a, m) && clearly_ahead(b, m) && clearly_ahead(c, -m) && clearly_ahead(d, -m);
}

/// The triangles that can be judged, each set of three vertices once.
std::vector<std::uint32_t> candidates(const MeshData& data) {
  std::vector<std::pair<Triple, std::uint32_t>> keys;
  for (std::uint32_t t = 0; t < data.triangles.size(); ++t) {
    Triple key = data.triangles[t];
    if (!is_measurable(data, key)) continue;
    if (CGAL::collinear(cgal_point(data.points, key[0]), cgal_point(data.points, key[1]), cgal_point(data.points, key[2]))) continue;
    std::sort(key.begin(), key.end());
    keys.emplace_back(key, t);
  }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end(), [](const auto& a, const auto& b) { return a.first == b.first; }),
             keys.end());
  std::vector<std::uint32_t> result;
  for (const auto& [key, t] : keys) result.push_back(t);
  std::sort(result.begin(), result.end());
  return result;
}

struct Stop {};

}  // namespace

bool meet_elsewhere(const std::vector<std::array<double, 3>>& points, std::array<std::uint32_t, 3> s,
                    std::array<std::uint32_t, 3> t) {
  const Triple s_given = s;
  const int num_shared = shared_first(s, t);
  shared_first(t, s_given);
  if (num_shared == 0) return CGAL::do_intersect(triangle(points, s), triangle(points, t));
  if (num_shared == 1)  // they share more than the vertex if the side opposite in one meets the other
    return !is_clearly_apart(points, s, t) &&
           (CGAL::do_intersect(triangle(points, s),
                               Kernel::Segment_3(cgal_point(points, t[1]), cgal_point(points, t[2]))) ||
            CGAL::do_intersect(triangle(points, t),
                               Kernel::Segment_3(cgal_point(points, s[1]), cgal_point(points, s[2]))));
  const Point a = cgal_point(points, s[0]), b = cgal_point(points, s[1]);
  const Point c = cgal_point(points, s[2]), d = cgal_point(points, t[2]);
  return CGAL::orientation(a, b, c, d) == CGAL::COPLANAR && CGAL::coplanar_orientation(a, b, c, d) == CGAL::POSITIVE;
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
  for_each_pair_of_boxes(boxes, [&](std::uint32_t i, std::uint32_t j) {
    const std::uint32_t low = faces[std::min(i, j)], high = faces[std::max(i, j)];
    if (meet_elsewhere(data.points, data.triangles[low], data.triangles[high])) pairs.push_back({low, high});
    return pairs.size() < limit;
  });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace meniscus
