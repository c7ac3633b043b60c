// SPDX-License-Identifier: GPL-3.0-or-later
#include "boolean_seam.h"

#include "meniscus/geometry/self_intersection.h"

#include <CGAL/Exact_rational.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace meniscus::boolean_parts {
namespace {

using Signs = std::array<int, 3>;

const Point& corner(const MeshView& view, const Triangle& t, int k) { return point_at(view, t[k]); }

int side(const MeshView& view, const Triangle& plane, const Point& p) {
  return int(CGAL::orientation(corner(view, plane, 0), corner(view, plane, 1), corner(view, plane, 2), p));
}

Signs sides(const MeshView& view, const Triangle& plane, const MeshView& other, const Triangle& t) {
  return {side(view, plane, corner(other, t, 0)), side(view, plane, corner(other, t, 1)),
          side(view, plane, corner(other, t, 2))};
}

bool all_on_one_side(const Signs& s) { return s[0] != 0 && s[0] == s[1] && s[1] == s[2]; }
bool has_zero(const Signs& s) { return s[0] == 0 || s[1] == 0 || s[2] == 0; }

/// Whether the line p q passes the triangle: 1 inside, 0 outside, -1 through its border.
int passes(const Point& p, const Point& q, const MeshView& view, const Triangle& t) {
  Signs s;
  for (int k = 0; k < 3; ++k) s[k] = int(CGAL::orientation(p, q, corner(view, t, k), corner(view, t, (k + 1) % 3)));
  const bool has_positive = s[0] > 0 || s[1] > 0 || s[2] > 0, has_negative = s[0] < 0 || s[1] < 0 || s[2] < 0;
  return has_positive && has_negative ? 0 : has_zero(s) ? -1 : 1;
}

/// Looks at pairs of faces and collects what they have in common.
class Collector {
 public:
  Collector(const MeshView& a, const MeshView& b) : a_(a), b_(b) {}

  /// Returns false if the two are not in general position.
  bool look_at(std::uint32_t f, std::uint32_t g) {
    const Triangle &s = a_.triangles[f], &t = b_.triangles[g];
    const Signs side_s = sides(b_, t, a_, s);
    if (all_on_one_side(side_s)) return true;
    const Signs side_t = sides(a_, s, b_, t);
    if (all_on_one_side(side_t)) return true;
    if (has_zero(side_s) || has_zero(side_t)) return !CGAL::do_intersect(triangle_of(a_, f), triangle_of(b_, g));
    from_ = to_ = none;
    return pierce(s, side_s, true, g, b_) && pierce(t, side_t, false, f, a_) && add_segment(f, g);
  }

  std::optional<Seam> finish();

 private:
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  /// Tests the three edges of a triangle against a face of the other mesh.
  bool pierce(const Triangle& t, const Signs& side, bool edge_of_a, std::uint32_t face, const MeshView& other) {
    const MeshView& own = edge_of_a ? a_ : b_;
    for (int k = 0; k < 3; ++k) {
      const int l = (k + 1) % 3;
      if (side[k] == side[l]) continue;
      const int hit = passes(corner(own, t, k), corner(own, t, l), other, other.triangles[face]);
      if (hit < 0) return false;
      if (hit == 0) continue;
      const bool enters = side[k] > 0;  // from outside the other mesh to inside
      const auto record = static_cast<std::uint32_t>(records_.size());
      const bool low_first = t[k] < t[l];
      records_.push_back({std::min(t[k], t[l]), std::max(t[k], t[l]), face, edge_of_a, enters != low_first});
      std::uint32_t& end = enters == edge_of_a ? to_ : from_;
      if (end != none) return false;
      end = record;
    }
    return true;
  }

  bool add_segment(std::uint32_t f, std::uint32_t g) {
    if (from_ == none && to_ == none) return true;
    if (from_ == none || to_ == none) return false;
    segments_.push_back({f, g, from_, to_});
    return true;
  }

  const MeshView &a_, &b_;
  std::vector<Crossing> records_;  // each crossing twice: once from each face at the edge
  std::vector<SeamSegment> segments_;
  std::uint32_t from_ = none, to_ = none;
};

auto key(const Crossing& c) { return std::tie(c.edge_of_a, c.low, c.high, c.face); }

std::optional<Seam> Collector::finish() {
  std::vector<std::uint32_t> order(records_.size()), number(records_.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    return key(records_[i]) != key(records_[j]) ? key(records_[i]) < key(records_[j]) : i < j;
  });
  Seam seam;
  if (order.size() % 2 != 0) return std::nullopt;
  for (std::size_t i = 0; i < order.size(); i += 2) {
    const Crossing &first = records_[order[i]], &second = records_[order[i + 1]];
    if (key(first) != key(second) || first.low_is_inside != second.low_is_inside) return std::nullopt;
    number[order[i]] = number[order[i + 1]] = static_cast<std::uint32_t>(seam.crossings.size());
    seam.crossings.push_back(first);
  }
  seam.segments = std::move(segments_);
  for (auto& segment : seam.segments) segment.from = number[segment.from], segment.to = number[segment.to];
  std::sort(seam.segments.begin(), seam.segments.end(), [](const SeamSegment& s, const SeamSegment& t) {
    return std::tie(s.face_a, s.face_b) < std::tie(t.face_a, t.face_b);
  });
  return seam;
}

using Exact = CGAL::Exact_rational;
using ExactVector = std::array<Exact, 3>;

ExactVector exact_difference(const Point& p, const Point& q) {
  return {Exact(p.x()) - Exact(q.x()), Exact(p.y()) - Exact(q.y()), Exact(p.z()) - Exact(q.z())};
}

Exact exact_dot(const ExactVector& u, const ExactVector& v) { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; }

/// Where the edge of a crossing meets the plane of its face, exactly.
Exact exact_t(const Point& low, const Point& high, const std::array<Point, 3>& face) {
  const ExactVector u = exact_difference(face[1], face[0]), v = exact_difference(face[2], face[0]);
  const ExactVector n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  return exact_dot(n, exact_difference(face[0], low)) / exact_dot(n, exact_difference(high, low));
}

std::array<Point, 3> face_of(const MeshView& a, const MeshView& b, const Crossing& c) {
  const MeshView& view = c.edge_of_a ? b : a;
  const Triangle& t = view.triangles[c.face];
  return {point_at(view, t[0]), point_at(view, t[1]), point_at(view, t[2])};
}

Exact exact_t(const MeshView& a, const MeshView& b, const Crossing& c) {
  const MeshView& own = c.edge_of_a ? a : b;
  return exact_t(point_at(own, c.low), point_at(own, c.high), face_of(a, b, c));
}

void place_exactly(const MeshView& a, const MeshView& b, Crossing& c) {
  const MeshView& own = c.edge_of_a ? a : b;
  const Point &low = point_at(own, c.low), &high = point_at(own, c.high);
  const Exact t = exact_t(a, b, c);
  c.t = CGAL::to_double(t);
  for (int d = 0; d < 3; ++d) {
    const Exact x = Exact(low[d]) + t * (Exact(high[d]) - Exact(low[d]));
    c.point[d] = CGAL::to_double(x);
  }
}

/// Below this sine between edge and face, the crossing is computed exactly.
constexpr double least_sine = 1e-2;

void place(const MeshView& a, const MeshView& b, Crossing& c) {
  const MeshView& own = c.edge_of_a ? a : b;
  const MeshView& other = c.edge_of_a ? b : a;
  const Triangle& t = other.triangles[c.face];
  const Eigen::Vector3d low = own.points.col(c.low), high = own.points.col(c.high), origin = other.points.col(t[0]);
  const Eigen::Vector3d u = other.points.col(t[1]) - origin, v = other.points.col(t[2]) - origin, n = u.cross(v);
  const Eigen::Vector3d along = high - low;
  const double depth = n.dot(along), size = n.norm() * along.norm();
  const double flatness = n.squaredNorm() / (u.squaredNorm() * v.squaredNorm());
  if (!(std::abs(depth) > least_sine * size) || !(flatness > least_sine * least_sine)) return place_exactly(a, b, c);
  c.t = n.dot(origin - low) / depth;
  if (!(c.t > 0 && c.t < 1)) return place_exactly(a, b, c);
  c.point = c.t < 0.5 ? Eigen::Vector3d(low + c.t * along) : Eigen::Vector3d(high - (1 - c.t) * along);
}

bool same_edge(const Crossing& s, const Crossing& t) {
  return s.edge_of_a == t.edge_of_a && s.low == t.low && s.high == t.high;
}

/// Below this distance, as a share of the edge, the order of two crossings is decided exactly.
constexpr double least_gap = 1e-9;

/// Sorts the crossings of each edge along it; false if two coincide.
bool sort_along_edges(const MeshView& a, const MeshView& b, Seam& seam) {
  auto& crossings = seam.crossings;
  std::vector<std::uint32_t> order(crossings.size()), number(crossings.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  bool all_differ = true;
  const auto is_before = [&](std::uint32_t i, std::uint32_t j) {
    const Crossing &s = crossings[i], &t = crossings[j];
    if (std::abs(s.t - t.t) > least_gap) return s.t < t.t;
    return exact_t(a, b, s) < exact_t(a, b, t);
  };
  for (std::size_t i = 0, j; i < order.size(); i = j) {
    for (j = i + 1; j < order.size() && same_edge(crossings[i], crossings[j]);) ++j;
    std::sort(order.begin() + static_cast<std::ptrdiff_t>(i), order.begin() + static_cast<std::ptrdiff_t>(j),
              is_before);
    for (std::size_t k = i + 1; k < j; ++k)
      if (!is_before(order[k - 1], order[k]))
        all_differ = false;
      else if (crossings[order[k]].t - crossings[order[k - 1]].t <= least_gap)
        place_exactly(a, b, crossings[order[k - 1]]), place_exactly(a, b, crossings[order[k]]);
  }
  std::vector<Crossing> sorted;
  sorted.reserve(crossings.size());
  for (const auto i : order) {
    number[i] = static_cast<std::uint32_t>(sorted.size());
    sorted.push_back(crossings[i]);
  }
  crossings = std::move(sorted);
  for (auto& segment : seam.segments) segment.from = number[segment.from], segment.to = number[segment.to];
  return all_differ;
}

std::optional<Seam> finish(Collector& collector, const MeshView& a, const MeshView& b) {
  std::optional<Seam> seam = collector.finish();
  if (!seam) return std::nullopt;
  for (auto& crossing : seam->crossings) place(a, b, crossing);
  if (!sort_along_edges(a, b, *seam)) return std::nullopt;
  return seam;
}

}  // namespace

std::optional<Seam> find_seam(const MeshView& a, const std::vector<FaceBox>& faces_a, const MeshView& b,
                              const std::vector<FaceBox>& faces_b) {
  Collector collector(a, b);
  const FaceGrid grid(faces_b);
  for (const auto& f : faces_a)
    if (!grid.for_each_meeting(f.box, [&](const FaceBox& g) { return collector.look_at(f.face, g.face); }))
      return std::nullopt;
  return finish(collector, a, b);
}

std::optional<Seam> find_self_seam(const MeshView& mesh, const std::vector<FacePair>& meeting) {
  Collector collector(mesh, mesh);
  for (const auto& [f, g] : meeting)
    if (share_a_vertex(mesh.triangles[f], mesh.triangles[g]) || !collector.look_at(f, g) || !collector.look_at(g, f))
      return std::nullopt;
  return finish(collector, mesh, mesh);
}

}  // namespace meniscus::boolean_parts
