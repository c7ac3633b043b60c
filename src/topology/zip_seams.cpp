// SPDX-License-Identifier: GPL-3.0-or-later
#include "zip_seams.h"

#include "boolean_parts.h"
#include "face_grid.h"
#include "meniscus/geometry/self_intersection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace meniscus {
namespace {

using Eigen::Vector3d;
using Loop = std::vector<std::uint32_t>;
using Faces = std::vector<std::uint32_t>;

constexpr int most_rings = 8;

/// The faces of each row.
class RowFaces {
 public:
  explicit RowFaces(const BooleanResult& result) : first_(result.points.size() + 1, 0) {
    for (const auto& t : result.triangles)
      for (const auto v : t) ++first_[v + 1];
    for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
    faces_.resize(first_.back());
    std::vector<std::uint32_t> at(first_.begin(), first_.end() - 1);
    for (std::uint32_t f = 0; f < result.triangles.size(); ++f)
      for (const auto v : result.triangles[f]) faces_[at[v]++] = f;
  }
  template <class Visit>
  void for_each(std::uint32_t row, Visit visit) const {
    for (std::uint32_t k = first_[row]; k < first_[row + 1]; ++k) visit(faces_[k]);
  }

 private:
  std::vector<std::uint32_t> first_, faces_;
};

/// Faces around a seam, and the two loops that bound them.
struct Annulus {
  Faces faces;
  Loop one, other;  ///< as the faces run
  double gap = 0;   ///< from one to the other, the mean, cm
};

class Zipper {
 public:
  Zipper(BooleanResult& result, const std::vector<std::uint8_t>& is_fixed, double least_gap)
      : result_(result),
        is_fixed_(is_fixed),
        least_gap_(least_gap),
        row_faces_(result),
        is_taken_(result.triangles.size(), 0) {}

  std::vector<std::uint32_t> run();

 private:
  Vector3d point(std::uint32_t v) const { return Vector3d::Map(result_.points[v].data()); }
  Faces faces_around(const std::vector<std::uint32_t>& rows) const;
  std::vector<std::uint32_t> rows_of(const Faces& faces) const;
  bool may_go(const Faces& faces, const std::vector<std::uint32_t>& rows) const;
  std::optional<Annulus> annulus(Faces faces, std::size_t num_rows) const;
  double gap_between(const Loop& one, const Loop& other) const;
  std::vector<Triangle> strip(const Loop& one, const Loop& other) const;
  bool joins_once(const Annulus& annulus, const std::vector<Triangle>& strip) const;
  bool fits(const Annulus& annulus, const std::vector<Triangle>& strip) const;
  void zip(const std::vector<std::uint32_t>& seam);

  BooleanResult& result_;
  std::vector<std::uint8_t> is_fixed_;
  const double least_gap_;
  const RowFaces row_faces_;
  std::vector<std::uint8_t> is_taken_;  // faces that make way
  std::vector<Triangle> strips_;
  std::vector<std::uint32_t> borders_;
};

Faces Zipper::faces_around(const std::vector<std::uint32_t>& rows) const {
  Faces faces;
  for (const auto v : rows) row_faces_.for_each(v, [&](std::uint32_t f) { faces.push_back(f); });
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return faces;
}

std::vector<std::uint32_t> Zipper::rows_of(const Faces& faces) const {
  std::vector<std::uint32_t> rows;
  for (const auto f : faces) rows.insert(rows.end(), result_.triangles[f].begin(), result_.triangles[f].end());
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  return rows;
}

bool Zipper::may_go(const Faces& faces, const std::vector<std::uint32_t>& rows) const {
  return std::none_of(rows.begin(), rows.end(), [&](std::uint32_t v) { return is_fixed_[v] != 0; }) &&
         std::none_of(faces.begin(), faces.end(), [&](std::uint32_t f) { return is_taken_[f] != 0; });
}

/// The border loops of faces that form an annulus; nothing if they do not.
std::optional<Annulus> Zipper::annulus(Faces faces, std::size_t num_rows) const {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto f : faces)
    for (int k = 0; k < 3; ++k) edges.emplace_back(result_.triangles[f][k], result_.triangles[f][(k + 1) % 3]);
  std::sort(edges.begin(), edges.end());
  std::vector<std::pair<std::uint32_t, std::uint32_t>> border;
  for (const auto& [u, v] : edges)
    if (!std::binary_search(edges.begin(), edges.end(), std::pair(v, u))) border.emplace_back(u, v);
  const auto euler = static_cast<std::ptrdiff_t>(num_rows + faces.size()) -
                     static_cast<std::ptrdiff_t>((3 * faces.size() + border.size()) / 2);
  if (euler != 0) return std::nullopt;
  Annulus result;
  std::vector<std::uint8_t> is_done(border.size(), 0);
  for (Loop* loop : {&result.one, &result.other}) {
    std::size_t at = static_cast<std::size_t>(std::find(is_done.begin(), is_done.end(), 0) - is_done.begin());
    while (at < border.size() && is_done[at] == 0) {
      is_done[at] = 1;
      loop->push_back(border[at].first);
      const auto next = std::lower_bound(border.begin(), border.end(), std::pair(border[at].second, 0u));
      if (next == border.end() || next->first != border[at].second) return std::nullopt;
      if (next + 1 != border.end() && (next + 1)->first == next->first) return std::nullopt;  // touches itself
      at = static_cast<std::size_t>(next - border.begin());
    }
    if (loop->size() < 3 || border[at].first != loop->front()) return std::nullopt;
  }
  if (result.one.size() + result.other.size() != border.size()) return std::nullopt;
  result.gap = 0.5 * (gap_between(result.one, result.other) + gap_between(result.other, result.one));
  result.faces = std::move(faces);
  return result;
}

double Zipper::gap_between(const Loop& one, const Loop& other) const {
  double sum = 0;
  for (const auto u : one) {
    double least = std::numeric_limits<double>::infinity();
    for (const auto v : other) least = std::min(least, (point(u) - point(v)).squaredNorm());
    sum += std::sqrt(least);
  }
  return sum / static_cast<double>(one.size());
}

/// Triangles between the loops, which run opposite ways: by the shorter diagonal, as far as both keep pace.
std::vector<Triangle> Zipper::strip(const Loop& one, const Loop& other) const {
  std::size_t start = 0;
  for (std::size_t k = 1; k < other.size(); ++k)
    if ((point(other[k]) - point(one[0])).squaredNorm() < (point(other[start]) - point(one[0])).squaredNorm())
      start = k;
  const std::size_t n = one.size(), m = other.size();
  const auto u = [&](std::size_t i) { return one[i % n]; };
  const auto w = [&](std::size_t j) { return other[(start + m - j % m) % m]; };
  std::vector<Triangle> triangles;
  for (std::size_t i = 0, j = 0; i < n || j < m;) {
    const double along_one = (point(u(i + 1)) - point(w(j))).squaredNorm();
    const double along_other = (point(u(i)) - point(w(j + 1))).squaredNorm();
    if (j == m || (i < n && along_one <= along_other)) {
      triangles.push_back({u(i), u(i + 1), w(j)});
      ++i;
    } else {
      triangles.push_back({u(i), w(j + 1), w(j)});
      ++j;
    }
  }
  return triangles;
}

/// No edge of the strip, but for its borders, is one of the faces that stay.
bool Zipper::joins_once(const Annulus& annulus, const std::vector<Triangle>& strip) const {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  const auto add = [&](const Triangle& t) {
    for (int k = 0; k < 3; ++k) edges.emplace_back(t[k], t[(k + 1) % 3]);
  };
  for (const auto& t : strip) add(t);
  std::vector<std::uint32_t> border = annulus.one;
  border.insert(border.end(), annulus.other.begin(), annulus.other.end());
  for (const auto f : faces_around(border))
    if (is_taken_[f] == 0 && !std::binary_search(annulus.faces.begin(), annulus.faces.end(), f))
      add(result_.triangles[f]);
  std::sort(edges.begin(), edges.end());
  return std::adjacent_find(edges.begin(), edges.end()) == edges.end();
}

/// The strip meets neither itself nor the faces that stay.
bool Zipper::fits(const Annulus& annulus, const std::vector<Triangle>& strip) const {
  Eigen::AlignedBox3d box;
  for (const Loop* loop : {&annulus.one, &annulus.other})
    for (const auto v : *loop) box.extend(point(v));
  MeshData soup;
  soup.points = result_.points;
  for (const auto& t : strip) {
    const Vector3d a = point(t[0]), b = point(t[1]), c = point(t[2]);
    if (!((b - a).cross(c - a).norm() > 0)) return false;
    soup.triangles.push_back(t);
  }
  for (const FaceBox& face : faces_in(boolean_parts::view_of(result_), box))
    if (is_taken_[face.face] == 0 && !std::binary_search(annulus.faces.begin(), annulus.faces.end(), face.face))
      soup.triangles.push_back(result_.triangles[face.face]);
  return self_intersections(soup, 1).empty();
}

void Zipper::zip(const std::vector<std::uint32_t>& seam) {
  std::vector<Annulus> found;
  Faces faces = faces_around(seam);
  for (int ring = 0; ring < most_rings; ++ring) {
    const std::vector<std::uint32_t> rows = rows_of(faces);
    if (!may_go(faces, rows)) break;
    auto next = annulus(faces, rows.size());
    if (next) found.push_back(std::move(*next));
    if (next && found.back().gap >= least_gap_) break;
    faces = faces_around(rows);
  }
  for (auto best = found.rbegin(); best != found.rend(); ++best) {
    const std::vector<Triangle> triangles = strip(best->one, best->other);
    if (!joins_once(*best, triangles) || !fits(*best, triangles)) continue;
    for (const auto f : best->faces) is_taken_[f] = 1;
    strips_.insert(strips_.end(), triangles.begin(), triangles.end());
    for (const Loop* loop : {&best->one, &best->other})
      for (const auto v : *loop) {
        borders_.push_back(v);
        is_fixed_[v] = 1;  // for the other seams
      }
    return;
  }
}

std::vector<std::uint32_t> Zipper::run() {
  const auto first = static_cast<std::uint32_t>(result_.first_seam_row());
  std::vector<std::uint8_t> is_seen(result_.points.size(), 0);
  for (std::uint32_t v = first; v < result_.points.size(); ++v) {
    if (is_seen[v] != 0) continue;
    std::vector<std::uint32_t> seam{v};
    is_seen[v] = 1;
    for (std::size_t k = 0; k < seam.size(); ++k)
      row_faces_.for_each(seam[k], [&](std::uint32_t f) {
        for (const auto w : result_.triangles[f])
          if (w >= first && is_seen[w] == 0) {
            is_seen[w] = 1;
            seam.push_back(w);
          }
      });
    zip(seam);
  }
  if (strips_.empty()) return {};
  std::vector<Triangle> triangles;
  for (std::size_t f = 0; f < result_.triangles.size(); ++f)
    if (is_taken_[f] == 0) triangles.push_back(result_.triangles[f]);
  triangles.insert(triangles.end(), strips_.begin(), strips_.end());
  result_.triangles = std::move(triangles);
  result_.whole_a = result_.whole_b = 0;
  std::vector<bool> is_used(result_.points.size(), false);
  for (const auto& t : result_.triangles)
    for (const auto v : t) is_used[v] = true;
  std::vector<std::uint32_t> row(result_.points.size());
  for (std::uint32_t v = 0, used = 0; v < row.size(); ++v) row[v] = is_used[v] ? used++ : 0;
  boolean_parts::keep_rows(result_, is_used);
  result_.volume = boolean_parts::volume_of(boolean_parts::view_of(result_));
  for (auto& v : borders_) v = row[v];
  std::sort(borders_.begin(), borders_.end());
  return borders_;
}

}  // namespace

std::vector<std::uint32_t> zip_seams(BooleanResult& result, const std::vector<std::uint8_t>& is_fixed,
                                     double least_gap) {
  return Zipper(result, is_fixed, least_gap).run();
}

}  // namespace meniscus
