// SPDX-License-Identifier: GPL-3.0-or-later
#include "boolean_cut.h"
#include "meniscus/core/index_sets.h"
#include "meniscus/geometry/self_intersection.h"

#include <algorithm>

namespace meniscus::boolean_parts {
namespace {

/// One of the two meshes, and what becomes of it.
struct Side {
  const MeshView& own;
  const MeshView& other;
  bool is_a;
  Place keep;  ///< the part that is kept lies there, with respect to the other mesh
  bool turn;   ///< and faces the other way
  Eigen::AlignedBox3d box;
  std::vector<FaceBox> common;  ///< the faces in the common box
  CutFaces cut;
};

/// Calls visit(face) for the faces of `common` that were not cut. Both lists ascend.
template <class Visit>
void for_each_uncut(const Side& side, Visit visit) {
  auto cut = side.cut.faces.begin();
  for (const auto& face : side.common) {
    while (cut != side.cut.faces.end() && *cut < face.face) ++cut;
    if (cut == side.cut.faces.end() || *cut != face.face) visit(face.face);
  }
}

/// Places all vertices in the common box: cut faces tell it, uncut ones carry it on, what lies beyond
/// the other's box is outside, and of a set that nothing tells about one vertex is tested. False on
/// a contradiction.
bool place_vertices(Side& side, const Eigen::AlignedBox3d& other_box) {
  // sets of vertices joined by uncut faces lie on one side of the other surface
  IndexSets sets(static_cast<std::size_t>(side.own.points.cols()));
  auto& place = side.cut.place;
  for_each_uncut(side, [&](std::uint32_t f) {
    const Triangle& t = side.own.triangles[f];
    sets.unite(t[0], t[1]);
    sets.unite(t[1], t[2]);
    for (const auto v : t)
      if (place[v] == Place::unknown && !other_box.contains(side.own.points.col(v))) place[v] = Place::outside;
  });
  bool agree = true;
  const auto for_each_vertex = [&](auto visit) {
    for_each_uncut(side, [&](std::uint32_t f) {
      for (const auto v : side.own.triangles[f]) visit(v, sets.find(v));
    });
  };
  for_each_vertex([&](std::uint32_t v, std::uint32_t root) {
    if (place[v] == Place::unknown) return;
    if (place[root] == Place::unknown) place[root] = place[v];
    agree = agree && place[root] == place[v];
  });
  for_each_vertex([&](std::uint32_t v, std::uint32_t root) {
    if (place[root] == Place::unknown)
      place[root] = is_inside(side.other, point_at(side.own, root)) ? Place::inside : Place::outside;
    if (place[v] == Place::unknown) place[v] = place[root];
    agree = agree && place[root] == place[v];
  });
  return agree;
}

Place place_of(const Side& side, std::uint32_t v) {
  return side.cut.place[v] == Place::inside ? Place::inside : Place::outside;
}

/// Appends the kept vertices of a side to the result and the whole faces that are kept; `row` maps old to new.
void append_whole(const Side& side, std::vector<std::uint32_t>& kept, std::size_t& whole,
                  std::vector<std::uint32_t>& row, BooleanResult& result, std::vector<std::uint32_t>& near) {
  const auto& triangles = side.own.triangles;
  row.assign(static_cast<std::size_t>(side.own.points.cols()), Connectivity::removed);
  auto cut = side.cut.faces.begin();
  const std::size_t first = result.triangles.size();
  std::size_t at_common = 0;
  for (std::uint32_t f = 0; f < triangles.size(); ++f) {
    const bool is_common = at_common < side.common.size() && side.common[at_common].face == f;
    at_common += is_common;
    if (cut != side.cut.faces.end() && *cut == f) {
      ++cut;
      continue;
    }
    if (is_removed(triangles[f]) || place_of(side, triangles[f][0]) != side.keep) continue;
    if (is_common) near.push_back(static_cast<std::uint32_t>(result.triangles.size()));
    result.triangles.push_back(side.turn ? turned(triangles[f]) : triangles[f]);
    for (const auto v : triangles[f]) row[v] = 0;
  }
  for (const auto& t : side.cut.triangles)
    for (const auto v : t)
      if (v < side.cut.first_crossing) row[v] = 0;
  for (std::uint32_t v = 0; v < row.size(); ++v)
    if (row[v] == 0) {
      row[v] = static_cast<std::uint32_t>(result.points.size());
      result.points.push_back({side.own.points(0, v), side.own.points(1, v), side.own.points(2, v)});
      kept.push_back(v);
    }
  for (std::size_t t = first; t < result.triangles.size(); ++t)
    for (auto& v : result.triangles[t]) v = row[v];
  whole = result.triangles.size() - first;
}

void append_cut(const Side& side, const std::vector<std::uint32_t>& row, BooleanResult& result) {
  const auto seam_row = static_cast<std::uint32_t>(result.first_seam_row());
  for (const auto& t : side.cut.triangles) {
    Triangle mapped;
    for (int k = 0; k < 3; ++k)
      mapped[k] = t[k] < side.cut.first_crossing ? row[t[k]] : seam_row + (t[k] - side.cut.first_crossing);
    result.triangles.push_back(side.turn ? turned(mapped) : mapped);
  }
}

void append_seam(const MeshView& a, const MeshView& b, const Seam& seam, BooleanResult& result) {
  for (const auto& c : seam.crossings) {
    const SurfacePoint on_edge{{c.low, c.high, c.high}, {1 - c.t, c.t, 0}};
    const MeshView& other = c.edge_of_a ? b : a;
    const SurfacePoint on_face = surface_point(other, other.triangles[c.face], c.point);
    result.points.push_back({c.point.x(), c.point.y(), c.point.z()});
    result.seam.push_back(c.edge_of_a ? SeamVertex{on_edge, on_face} : SeamVertex{on_face, on_edge});
  }
}

/// Which of the components lie inside the other mesh, if the surfaces do not cross.
struct Insides {
  bool some = false, all = true;
};

Insides insides(const Side& side) {
  Insides insides;
  for (const auto& t : side.own.triangles)
    if (!is_removed(t)) {
      const bool inside = place_of(side, t[0]) == Place::inside;
      insides.some = insides.some || inside;
      insides.all = insides.all && inside;
    }
  return insides;
}

BooleanOutcome outcome_of(const Seam& seam, const Side& a, const Side& b) {
  if (!seam.crossings.empty()) return BooleanOutcome::crossing;
  const Insides in_b = insides(a), in_a = insides(b);
  if (!in_b.some && !in_a.some) return BooleanOutcome::disjoint;
  if (in_b.all && !in_a.some) return BooleanOutcome::a_inside_b;
  if (in_a.all && !in_b.some) return BooleanOutcome::b_inside_a;
  return BooleanOutcome::crossing;
}

}  // namespace

std::optional<BooleanResult> cut_locally(const MeshView& a, const MeshView& b, BooleanOperation operation,
                                         std::vector<std::uint32_t>& near) {
  const bool unite = operation == BooleanOperation::unite, intersect = operation == BooleanOperation::intersect;
  Side side_a{a, b, true, intersect ? Place::inside : Place::outside, false, box_of(a), {}, {}};
  Side side_b{b,         a,  false, unite ? Place::outside : Place::inside, operation == BooleanOperation::subtract,
              box_of(b), {}, {}};
  const Eigen::AlignedBox3d common = side_a.box.intersection(side_b.box);
  if (!common.isEmpty()) side_a.common = faces_in(a, common), side_b.common = faces_in(b, common);
  const auto seam = find_seam(a, side_a.common, b, side_b.common);
  if (!seam) return std::nullopt;
  for (Side* side : {&side_a, &side_b}) {
    auto cut = cut_faces(a, b, *seam, side->is_a, side->keep);
    if (!cut) return std::nullopt;
    side->cut = std::move(*cut);
    if (!place_vertices(*side, side->is_a ? side_b.box : side_a.box)) return std::nullopt;
  }
  BooleanResult result;
  result.step = seam->crossings.empty() ? BooleanStep::apart : BooleanStep::local;
  result.outcome = outcome_of(*seam, side_a, side_b);
  near.clear();
  std::vector<std::uint32_t> row_a, row_b;
  result.triangles.reserve(a.triangles.size() + b.triangles.size() + 4 * seam->crossings.size());
  result.points.reserve(static_cast<std::size_t>(a.points.cols() + b.points.cols()) + seam->crossings.size());
  append_whole(side_a, result.kept_a, result.whole_a, row_a, result, near);
  append_whole(side_b, result.kept_b, result.whole_b, row_b, result, near);
  append_seam(a, b, *seam, result);
  append_cut(side_a, row_a, result);
  append_cut(side_b, row_b, result);
  return result;
}

bool is_sound_at_seam(const BooleanResult& result, const std::vector<std::uint32_t>& near) {
  const auto box_of_face = [&](std::uint32_t f) {
    FaceBox face{{}, f};
    for (const auto v : result.triangles[f]) face.box.extend(Eigen::Vector3d::Map(result.points[v].data()));
    return face;
  };
  const auto point = [&](std::uint32_t v) {
    return Point(result.points[v][0], result.points[v][1], result.points[v][2]);
  };
  std::vector<FaceBox> made;
  for (auto f = static_cast<std::uint32_t>(result.whole_a + result.whole_b); f < result.triangles.size(); ++f) {
    const Triangle& t = result.triangles[f];
    if (CGAL::collinear(point(t[0]), point(t[1]), point(t[2]))) return false;
    made.push_back(box_of_face(f));
  }
  const FaceGrid grid(made);
  const auto is_apart = [&](const FaceBox& face, bool is_new) {
    return grid.for_each_meeting(face.box, [&](const FaceBox& other) {
      return (is_new && other.face >= face.face) ||
             !meet_elsewhere(point, result.triangles[face.face], result.triangles[other.face]);
    });
  };
  for (const auto& face : made)
    if (!is_apart(face, true)) return false;
  for (const auto f : near)
    if (!is_apart(box_of_face(f), false)) return false;
  return true;
}

}  // namespace meniscus::boolean_parts
