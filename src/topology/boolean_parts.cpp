// SPDX-License-Identifier: GPL-3.0-or-later
#include "boolean_parts.h"

#include "meniscus/core/index_sets.h"

#include <Eigen/Geometry>

#include <algorithm>

namespace meniscus::boolean_parts {
namespace {

/// On which side of the line a -> b, seen along x, the point lies that is p moved by (epsilon,
/// epsilon^2) in (y, z): 0 only if the line is seen as a point.
int side_of_line(const Point& a, const Point& b, const Point& p) {
  using Point2 = Kernel::Point_2;
  const auto exact = CGAL::orientation(Point2(a.y(), a.z()), Point2(b.y(), b.z()), Point2(p.y(), p.z()));
  if (exact != CGAL::COLLINEAR) return int(exact);
  if (a.z() != b.z()) return a.z() > b.z() ? 1 : -1;
  return a.y() < b.y() ? 1 : a.y() > b.y() ? -1 : 0;
}

/// Whether the ray from p (moved as above) along +x crosses the triangle.
bool ray_crosses(const Point& a, const Point& b, const Point& c, const Point& p) {
  for (int d = 1; d < 3; ++d)
    if (std::max({a[d], b[d], c[d]}) < p[d] || std::min({a[d], b[d], c[d]}) > p[d]) return false;
  const int turn = side_of_line(a, b, p);
  return turn != 0 && side_of_line(b, c, p) == turn && side_of_line(c, a, p) == turn &&
         int(CGAL::orientation(a, b, c, p)) == -turn;
}

Eigen::Vector3d at(const BooleanResult& result, std::uint32_t v) {
  return Eigen::Vector3d::Map(result.points[v].data());
}

/// By row: what the row's component encloses, cm^3; negative for a cavity.
std::vector<double> enclosed_volumes(const BooleanResult& result) {
  IndexSets sets(result.points.size());
  for (const auto& t : result.triangles)
    for (int k = 0; k < 2; ++k) sets.unite(t[k], t[k + 1]);
  std::vector<double> volume(result.points.size(), 0);
  for (const auto& t : result.triangles) {
    const std::uint32_t c = sets.find(t[0]);
    const Eigen::Vector3d origin = at(result, c);
    volume[c] += (at(result, t[0]) - origin).dot((at(result, t[1]) - origin).cross(at(result, t[2]) - origin)) / 6;
  }
  for (std::uint32_t v = 0; v < volume.size(); ++v) volume[v] = volume[sets.find(v)];
  return volume;
}

/// Drops the other rows, and measures what is left.
void keep_only(const std::vector<bool>& is_kept, BooleanResult& result) {
  if (std::find(is_kept.begin(), is_kept.end(), false) == is_kept.end()) return;
  keep_rows(result, is_kept);
  result.volume = volume_of(view_of(result));
}

}  // namespace

bool is_inside(const MeshView& mesh, const Point& p) {
  bool inside = false;
  for (const auto& t : mesh.triangles)
    if (!is_removed(t) && ray_crosses(point_at(mesh, t[0]), point_at(mesh, t[1]), point_at(mesh, t[2]), p))
      inside = !inside;
  return inside;
}

double volume_of(const MeshView& view) {
  double six = 0;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  bool is_first = true;
  for (const auto& t : view.triangles) {
    if (is_removed(t)) continue;
    if (is_first) origin = view.points.col(t[0]), is_first = false;
    const Eigen::Vector3d a = view.points.col(t[0]) - origin, b = view.points.col(t[1]) - origin,
                          c = view.points.col(t[2]) - origin;
    six += a.dot(b.cross(c));
  }
  return six / 6;
}

MeshData soup_of(const MeshView& view) {
  MeshData soup;
  std::vector<std::uint32_t> row(static_cast<std::size_t>(view.points.cols()), Connectivity::removed);
  for (std::uint32_t f = 0; f < view.triangles.size(); ++f) {
    if (is_removed(view.triangles[f])) continue;
    soup.triangles.push_back(view.triangles[f]);
    soup.source_face.push_back(f);
    for (const auto v : view.triangles[f])
      if (v < row.size()) row[v] = 0;
  }
  for (std::uint32_t v = 0; v < row.size(); ++v)
    if (row[v] == 0) {
      row[v] = static_cast<std::uint32_t>(soup.points.size());
      soup.points.push_back({view.points(0, v), view.points(1, v), view.points(2, v)});
    }
  for (auto& t : soup.triangles)
    for (auto& v : t) v = v < row.size() ? row[v] : Connectivity::removed;
  return soup;
}

SurfacePoint surface_point(const MeshView& view, const Triangle& t, const Eigen::Vector3d& p) {
  const Eigen::Vector3d a = view.points.col(t[0]), u = view.points.col(t[1]) - a, w = view.points.col(t[2]) - a;
  const double uu = u.dot(u), uw = u.dot(w), ww = w.dot(w), pu = (p - a).dot(u), pw = (p - a).dot(w);
  const double det = uu * ww - uw * uw;
  double s = 0, r = 0;
  if (det > 0) {
    s = std::clamp((ww * pu - uw * pw) / det, 0.0, 1.0);
    r = std::clamp((uu * pw - uw * pu) / det, 0.0, 1.0 - s);
  }
  return {t, {1 - s - r, s, r}};
}

void keep_rows(BooleanResult& result, const std::vector<bool>& is_kept) {
  std::vector<std::uint32_t> row(result.points.size());
  const BooleanResult old = result;
  result.points.clear();
  result.triangles.clear();
  result.kept_a.clear();
  result.kept_b.clear();
  result.seam.clear();
  result.whole_a = result.whole_b = 0;
  for (std::uint32_t v = 0; v < row.size(); ++v) {
    if (!is_kept[v]) continue;
    row[v] = static_cast<std::uint32_t>(result.points.size());
    result.points.push_back(old.points[v]);
    if (v < old.kept_a.size())
      result.kept_a.push_back(old.kept_a[v]);
    else if (v < old.first_seam_row())
      result.kept_b.push_back(old.kept_b[v - old.kept_a.size()]);
    else
      result.seam.push_back(old.seam[v - old.first_seam_row()]);
  }
  for (std::size_t t = 0; t < old.triangles.size(); ++t) {
    const Triangle& triangle = old.triangles[t];
    if (!is_kept[triangle[0]] || !is_kept[triangle[1]] || !is_kept[triangle[2]]) continue;
    result.triangles.push_back({row[triangle[0]], row[triangle[1]], row[triangle[2]]});
    if (t < old.whole_a)
      ++result.whole_a;
    else if (t < old.whole_a + old.whole_b)
      ++result.whole_b;
  }
}

void drop_cavities(BooleanResult& result) {
  const std::vector<double> volume = enclosed_volumes(result);
  std::vector<bool> is_kept(volume.size());
  std::transform(volume.begin(), volume.end(), is_kept.begin(), [](double v) { return v > 0; });
  keep_only(is_kept, result);
}

void drop_specks(BooleanResult& result, double least_volume) {
  const std::vector<double> volume = enclosed_volumes(result);
  if (volume.empty() || *std::max_element(volume.begin(), volume.end()) < least_volume) return;
  std::vector<bool> is_kept(volume.size());
  std::transform(volume.begin(), volume.end(), is_kept.begin(), [&](double v) { return std::abs(v) >= least_volume; });
  keep_only(is_kept, result);
}

MeshData data_of(const BooleanResult& result) {
  MeshData data;
  data.points = result.points;
  data.triangles = result.triangles;
  return data;
}

}  // namespace meniscus::boolean_parts
