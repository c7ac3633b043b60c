// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/topology/self_union.h"

#include "boolean_cut.h"
#include "boolean_parts.h"
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
  return unite_with_itself(mesh, faces_in(mesh, region), keep_cavities);
}

BooleanResult unite_with_itself(const MeshView& mesh, const std::vector<FaceBox>& faces, bool keep_cavities) {
  const auto seam = find_self_seam(mesh, faces);
  if (!seam) return refuse("the surface folds over between neighbouring faces");
  BooleanResult result;
  result.outcome = BooleanOutcome::disjoint;
  if (seam->crossings.empty()) return result;
  auto cut = cut_faces(mesh, mesh, *seam, true, Place::outside);
  if (!cut) return refuse("the surface crosses itself in more than simple curves");
  std::vector<std::uint8_t> is_cut(mesh.triangles.size(), 0);
  for (const auto f : cut->faces) is_cut[f] = 1;
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
