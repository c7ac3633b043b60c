// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/topology/self_union.h"

#include "boolean_cut.h"
#include "boolean_parts.h"
#include "fold_finder.h"
#include "meniscus/core/index_sets.h"
#include "merge_parts.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace meniscus {
namespace {

using namespace boolean_parts;

/// A fold claims at most this share of the volume twice, or has it inside out; beyond, what is outside is not told
/// by where the surface crosses itself.
constexpr double most_change = 0.1;

BooleanResult refuse(const char* message) {
  BooleanResult result;
  result.refusal = BooleanRefusal::rounding;
  result.message = message;
  return result;
}

/// The crossing that is the same point seen from the face that is pierced: find_self_seam lists each twice.
std::vector<std::uint32_t> first_of_twins(const Seam& seam) {
  const auto key = [&](std::uint32_t c) {
    const Crossing& crossing = seam.crossings[c];
    return std::tuple(crossing.low, crossing.high, crossing.face, !crossing.edge_of_a);
  };
  std::vector<std::uint32_t> order(seam.crossings.size()), twin(seam.crossings.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) { return key(i) < key(j); });
  for (std::size_t i = 0; i + 1 < order.size(); i += 2) twin[order[i]] = twin[order[i + 1]] = order[i];
  return twin;
}

/// Which parts of a surface that crosses itself are kept, and which dropped: on any way along the surface they take
/// turns at each crossing. Numbers stand for vertices and curves of the seam.
class Turns {
 public:
  explicit Turns(std::size_t size) : sets_(2 * size) {}

  void relate(std::uint32_t i, std::uint32_t j, bool differ) {
    sets_.unite(2 * i, 2 * j + differ);
    sets_.unite(2 * i + 1, 2 * j + !differ);
  }
  /// All that hangs together with i as it is, and as it is not; the same if i contradicts itself.
  std::uint32_t set_of(std::uint32_t i) { return sets_.find(2 * i); }
  std::uint32_t opposite_of(std::uint32_t i) { return sets_.find(2 * i + 1); }

 private:
  IndexSets sets_;
};

std::vector<double> areas_at_vertices(const MeshView& mesh) {
  std::vector<double> area(static_cast<std::size_t>(mesh.points.cols()), 0);
  for (const Triangle& t : mesh.triangles) {
    if (is_removed(t)) continue;
    const Eigen::Vector3d a = mesh.points.col(t[0]);
    const double twice =
        (Eigen::Vector3d(mesh.points.col(t[1])) - a).cross(Eigen::Vector3d(mesh.points.col(t[2])) - a).norm();
    for (const auto v : t) area[v] += twice;
  }
  return area;
}

/// Whether what a face's segments enclose, none of which reaches its border, lies inside the other surface.
bool encloses_inside(const MeshView& mesh, const Seam& seam, const SeamSegment* first, const SeamSegment* last) {
  const Triangle& t = mesh.triangles[first->face_a];
  const Eigen::Vector3d a = mesh.points.col(t[0]);
  const Eigen::Vector3d normal =
      (Eigen::Vector3d(mesh.points.col(t[1])) - a).cross(Eigen::Vector3d(mesh.points.col(t[2])) - a);
  Eigen::Vector3d area = Eigen::Vector3d::Zero();
  for (const SeamSegment* s = first; s != last; ++s)
    area += (seam.crossings[s->from].point - a).cross(seam.crossings[s->to].point - a);
  return area.dot(normal) > 0;
}

/// Where the two sides of a film have gone through each other, it is the air outside that overlaps: there what lies
/// inside the other sheet is the liquid's surface. This turns the curves of the seam around such places, so that what
/// lies outside is kept everywhere. Of all that hangs together by crossings the larger part is kept.
void turn_inverted_curves(const MeshView& mesh, const std::vector<std::uint8_t>& is_cut, Seam& seam) {
  auto& crossings = seam.crossings;
  const auto num_vertices = static_cast<std::uint32_t>(mesh.points.cols());
  IndexSets curves(crossings.size());
  for (const SeamSegment& s : seam.segments) curves.unite(s.from, s.to);
  const std::vector<std::uint32_t> twin = first_of_twins(seam);
  for (std::uint32_t c = 0; c < twin.size(); ++c) curves.unite(c, twin[c]);
  const auto curve = [&](std::uint32_t c) { return num_vertices + curves.find(c); };

  Turns turns(num_vertices + crossings.size());
  const auto key = [](const Crossing& c) { return std::tie(c.edge_of_a, c.low, c.high); };
  const auto is_crossed = [&](std::uint32_t low, std::uint32_t high) {
    const auto at = std::partition_point(crossings.begin(), crossings.end(),
                                         [&](const Crossing& c) { return key(c) < std::tuple(true, low, high); });
    return at != crossings.end() && key(*at) == std::tuple(true, low, high);
  };
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    const Triangle& t = mesh.triangles[f];
    if (is_removed(t)) continue;
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
      if (is_cut[f] == 0 || !is_crossed(low, high)) turns.relate(low, high, false);
    }
  }
  for (std::uint32_t c = 0; c < crossings.size(); ++c) {
    const Crossing& crossing = crossings[c];
    if (!crossing.edge_of_a) continue;
    if (c == 0 || key(crossings[c - 1]) != key(crossing)) turns.relate(crossing.low, curve(c), crossing.low_is_inside);
    const bool is_last = c + 1 == crossings.size() || key(crossings[c + 1]) != key(crossing);
    if (is_last)
      turns.relate(crossing.high, curve(c), !crossing.low_is_inside);
    else
      turns.relate(curve(c), curve(c + 1), crossing.low_is_inside == crossings[c + 1].low_is_inside);
  }
  const SeamSegment* const end = seam.segments.data() + seam.segments.size();
  for (const SeamSegment *first = seam.segments.data(), *last = first; first != end; first = last) {
    bool reaches_border = false;
    for (; last != end && last->face_a == first->face_a; ++last)
      reaches_border = reaches_border || crossings[last->from].edge_of_a || crossings[last->to].edge_of_a;
    if (!reaches_border)
      turns.relate(mesh.triangles[first->face_a][0], curve(first->from), !encloses_inside(mesh, seam, first, last));
  }

  const std::vector<double> area = areas_at_vertices(mesh);
  std::vector<double> weight(2 * (num_vertices + crossings.size()), 0);
  for (std::uint32_t v = 0; v < num_vertices; ++v) weight[turns.set_of(v)] += area[v];
  const auto is_inverted = [&](std::uint32_t c) {
    const std::uint32_t set = turns.set_of(curve(c)), opposite = turns.opposite_of(curve(c));
    return weight[set] != weight[opposite] ? weight[set] < weight[opposite] : set > opposite;
  };
  for (SeamSegment& s : seam.segments)
    if (is_inverted(s.from)) std::swap(s.from, s.to);
  for (std::uint32_t c = 0; c < crossings.size(); ++c)
    if (is_inverted(c)) crossings[c].low_is_inside = !crossings[c].low_is_inside;
}

/// Carries the places of cut faces' vertices over the uncut faces; what nothing tells about stays. False on
/// a contradiction.
bool spread_places(const MeshView& mesh, const std::vector<std::uint8_t>& is_cut, std::vector<Place>& place) {
  const auto n = static_cast<std::size_t>(mesh.points.cols());
  IndexSets sets(n);
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    const Triangle& t = mesh.triangles[f];
    if (is_removed(t) || is_cut[f] != 0) continue;
    for (int k = 1; k < 3; ++k) sets.unite(t[0], t[k]);
  }
  std::vector<Place> of_set(n, Place::unknown);
  for (std::uint32_t v = 0; v < n; ++v) {
    if (place[v] == Place::unknown) continue;
    Place& known = of_set[sets.find(v)];
    if (known != Place::unknown && known != place[v]) return false;
    known = place[v];
  }
  for (std::uint32_t v = 0; v < n; ++v)
    if (place[v] == Place::unknown) place[v] = of_set[sets.find(v)];
  return true;
}

/// The kept vertices, seam vertices and triangles.
BooleanResult assemble(const MeshView& mesh, const Seam& seam, const CutFaces& cut,
                       const std::vector<std::uint8_t>& is_cut, const std::vector<FaceBox>& region,
                       std::vector<std::uint32_t>& near) {
  constexpr std::uint32_t none = Connectivity::removed, wanted = none - 1;
  BooleanResult result;
  result.outcome = BooleanOutcome::crossing;
  result.step = BooleanStep::local;
  std::vector<std::uint32_t> row(static_cast<std::size_t>(mesh.points.cols()), none);
  std::size_t at_region = 0;
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    const Triangle& t = mesh.triangles[f];
    const bool in_region = at_region < region.size() && region[at_region].face == f;
    at_region += in_region;
    if (is_removed(t) || is_cut[f] != 0 || cut.place[t[0]] == Place::inside) continue;
    if (in_region) near.push_back(static_cast<std::uint32_t>(result.triangles.size()));
    result.triangles.push_back(t);
    for (const auto v : t) row[v] = wanted;
  }
  result.whole_a = result.triangles.size();
  const std::vector<std::uint32_t> twin = first_of_twins(seam);
  std::vector<std::uint32_t> seam_row(seam.crossings.size(), none);
  for (const auto& t : cut.triangles)
    for (const auto v : t) (v < cut.first_crossing ? row[v] : seam_row[twin[v - cut.first_crossing]]) = wanted;
  const auto add = [&](std::uint32_t& to, const Eigen::Vector3d& p) {
    to = static_cast<std::uint32_t>(result.points.size());
    result.points.push_back({p.x(), p.y(), p.z()});
  };
  for (std::uint32_t v = 0; v < row.size(); ++v)
    if (row[v] == wanted) {
      add(row[v], mesh.points.col(v));
      result.kept_a.push_back(v);
    }
  for (std::uint32_t c = 0; c < seam_row.size(); ++c)
    if (seam_row[c] == wanted) {
      const Crossing& crossing = seam.crossings[c];
      add(seam_row[c], crossing.point);
      result.seam.push_back({{{crossing.low, crossing.high, crossing.high}, {1 - crossing.t, crossing.t, 0}},
                             surface_point(mesh, mesh.triangles[crossing.face], crossing.point)});
    }
  for (auto& t : result.triangles)
    for (auto& v : t) v = row[v];
  for (const auto& t : cut.triangles) {
    Triangle mapped;
    for (int k = 0; k < 3; ++k)
      mapped[k] = t[k] < cut.first_crossing ? row[t[k]] : seam_row[twin[t[k] - cut.first_crossing]];
    result.triangles.push_back(mapped);
  }
  return result;
}

}  // namespace

BooleanResult unite_with_itself(const MeshView& mesh, const Eigen::AlignedBox3d& region, bool keep_cavities) {
  const std::vector<FaceBox> faces = faces_in(mesh, region);
  return unite_with_itself(mesh, faces, faces_that_meet(mesh, faces), keep_cavities);
}

BooleanResult unite_with_itself(const MeshView& mesh, const std::vector<FaceBox>& faces,
                                const std::vector<FacePair>& meeting, bool keep_cavities) {
  auto seam = find_self_seam(mesh, meeting);
  if (!seam) return refuse("the surface folds over between neighbouring faces");
  BooleanResult result;
  result.outcome = BooleanOutcome::disjoint;
  if (seam->crossings.empty()) return result;
  std::vector<std::uint8_t> is_cut(mesh.triangles.size(), 0);
  for (const SeamSegment& segment : seam->segments) is_cut[segment.face_a] = 1;
  turn_inverted_curves(mesh, is_cut, *seam);
  auto cut = cut_faces(mesh, mesh, *seam, true, Place::outside);
  if (!cut) return refuse("the surface crosses itself in more than simple curves");
  if (!spread_places(mesh, is_cut, cut->place)) return refuse("a part of the surface is both inside and outside");
  std::vector<std::uint32_t> near;
  result = assemble(mesh, *seam, *cut, is_cut, faces, near);
  if (result.triangles.empty() || !is_sound_at_seam(result, near)) return refuse("the seam is not sound once rounded");
  result.volume_a = volume_of(mesh);
  result.volume =
      volume_of({{result.points.front().data(), static_cast<Eigen::Index>(result.points.size())}, result.triangles});
  if (!(std::abs(result.volume - result.volume_a) <= most_change * result.volume_a))
    return refuse("a part of the surface is inside out");
  if (!keep_cavities) drop_cavities(result);
  return result;
}

}  // namespace meniscus
