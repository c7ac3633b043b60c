// SPDX-License-Identifier: GPL-3.0-or-later
#include "boolean_cut.h"

#include "triangulate_loops.h"

#include <algorithm>
#include <tuple>

namespace meniscus::boolean_parts {
namespace {

/// Cuts one face after another, with working arrays of its own.
class FaceCutter {
 public:
  FaceCutter(const MeshView& a, const MeshView& b, const Seam& seam, bool of_a, Place keep)
      : own_(of_a ? a : b), other_(of_a ? b : a), seam_(seam), of_a_(of_a), keep_(keep) {
    cut_.first_crossing = static_cast<std::uint32_t>(own_.points.cols());
    cut_.place.assign(cut_.first_crossing, Place::unknown);
    local_.assign(seam.crossings.size(), none);
  }

  /// `first` to `last` are the segments of the face.
  bool cut(std::uint32_t face, const SeamSegment* const* first, const SeamSegment* const* last);
  CutFaces take() { return std::move(cut_); }

 private:
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  void clear();
  std::uint32_t add_node(std::uint32_t corner, const Eigen::Vector3d& point, bool is_on_border);
  void add_edge(std::uint32_t u, std::uint32_t v, Place place);
  bool add_segments(const SeamSegment* const* first, const SeamSegment* const* last);
  std::uint32_t node_of(std::uint32_t crossing);
  bool add_border();
  bool place_border();
  bool trace_loops();
  bool is_hole(const std::vector<std::uint32_t>& loop) const;
  bool triangulate();

  const MeshView &own_, &other_;
  const Seam& seam_;
  const bool of_a_;
  const Place keep_;
  CutFaces cut_;

  Triangle face_{};                           // the face at work
  int drop_ = 0;                              // the axis along which it is seen
  bool mirrored_ = false;                     // seen from its back
  std::vector<std::uint32_t> corner_, next_;  // of each node: its corner in the result; the next on the kept side
  std::vector<bool> on_border_;
  std::vector<Kernel::Point_2> flat_;
  std::vector<std::uint32_t> border_;           // nodes, counterclockwise
  std::vector<Place> after_;                    // of each border node: where the border goes on from it
  std::vector<std::uint32_t> local_, touched_;  // crossing to node
  Loops loops_;
  bool has_hole_ = false;
};

void FaceCutter::clear() {
  for (const auto c : touched_) local_[c] = none;
  touched_.clear();
  corner_.clear();
  next_.clear();
  on_border_.clear();
  flat_.clear();
  border_.clear();
  after_.clear();
  loops_.clear();
  has_hole_ = false;
}

std::uint32_t FaceCutter::add_node(std::uint32_t corner, const Eigen::Vector3d& p, bool is_on_border) {
  corner_.push_back(corner);
  next_.push_back(none);
  on_border_.push_back(is_on_border);
  const double x = p[(drop_ + 1) % 3], y = p[(drop_ + 2) % 3];
  flat_.push_back(mirrored_ ? Kernel::Point_2(y, x) : Kernel::Point_2(x, y));
  return static_cast<std::uint32_t>(corner_.size() - 1);
}

std::uint32_t FaceCutter::node_of(std::uint32_t crossing) {
  if (local_[crossing] == none) {
    const Crossing& c = seam_.crossings[crossing];
    local_[crossing] = add_node(cut_.first_crossing + crossing, c.point, c.edge_of_a == of_a_);
    touched_.push_back(crossing);
  }
  return local_[crossing];
}

/// The face's border: its corners, and the crossings of its edges in order.
bool FaceCutter::add_border() {
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t p = face_[k], q = face_[(k + 1) % 3], low = std::min(p, q), high = std::max(p, q);
    border_.push_back(add_node(p, own_.points.col(p), true));
    after_.push_back(Place::unknown);
    const auto key = [](const Crossing& c) { return std::tie(c.edge_of_a, c.low, c.high); };
    const auto begin = std::partition_point(seam_.crossings.begin(), seam_.crossings.end(),
                                            [&](const Crossing& c) { return key(c) < std::tie(of_a_, low, high); });
    auto end = begin;
    while (end != seam_.crossings.end() && key(*end) == std::tie(of_a_, low, high)) ++end;
    for (std::ptrdiff_t i = 0; i < end - begin; ++i) {
      const auto at = p == low ? begin + i : end - 1 - i;
      border_.push_back(node_of(static_cast<std::uint32_t>(at - seam_.crossings.begin())));
      const bool source_is_inside = at->low_is_inside == (p == low);
      after_.push_back(source_is_inside ? Place::outside : Place::inside);
    }
  }
  return place_border();
}

/// Carries what crossings tell on to the corners; false if they disagree.
bool FaceCutter::place_border() {
  const std::size_t n = border_.size();
  Place now = Place::unknown;
  for (const Place place : after_)
    if (place != Place::unknown) now = place;  // of the last one: the first corner's
  if (now == Place::unknown) {                 // no crossing: only closed curves inside
    Place& known = cut_.place[face_[0]];
    const bool is_self = &own_.triangles == &other_.triangles;  // its own vertices are not inside it
    if (known == Place::unknown)
      known = !is_self && is_inside(other_, point_at(own_, face_[0])) ? Place::inside : Place::outside;
    now = known;
  }
  for (std::size_t k = 0; k < n; ++k) {
    const bool is_corner = corner_[border_[k]] < cut_.first_crossing;
    if (!is_corner) {
      if (after_[k] == now) return false;
      now = after_[k];
      continue;
    }
    after_[k] = now;
    Place& known = cut_.place[corner_[border_[k]]];
    if (known != Place::unknown && known != now) return false;
    known = now;
  }
  for (std::size_t k = 0; k < n; ++k)
    if (after_[k] == keep_) next_[border_[k]] = border_[(k + 1) % n];
  return true;
}

/// The segments, with the kept side on their left; false if a node has two ways on.
bool FaceCutter::add_segments(const SeamSegment* const* first, const SeamSegment* const* last) {
  const bool forward = of_a_ == (keep_ == Place::inside);
  for (auto segment = first; segment != last; ++segment) {
    const std::uint32_t from = node_of(forward ? (*segment)->from : (*segment)->to);
    const std::uint32_t to = node_of(forward ? (*segment)->to : (*segment)->from);
    if (next_[from] != none) return false;
    next_[from] = to;
  }
  return true;
}

bool FaceCutter::trace_loops() {
  std::vector<bool> seen(next_.size(), false);
  for (std::uint32_t start = 0; start < next_.size(); ++start) {
    if (next_[start] == none || seen[start]) continue;
    std::vector<std::uint32_t> loop;
    bool touches_border = false;
    std::uint32_t at = start;
    do {
      if (at >= next_.size() || seen[at]) return false;
      seen[at] = true;
      loop.push_back(at);
      touches_border = touches_border || on_border_[at];
      at = next_[at];
    } while (at != start);
    if (!touches_border && is_hole(loop)) has_hole_ = true;
    loops_.push_back(std::move(loop));
  }
  return true;
}

/// Whether a loop runs clockwise, by the turn at its least corner.
bool FaceCutter::is_hole(const std::vector<std::uint32_t>& loop) const {
  const auto least =
      std::min_element(loop.begin(), loop.end(), [&](std::uint32_t i, std::uint32_t j) { return flat_[i] < flat_[j]; });
  const std::size_t n = loop.size(), k = static_cast<std::size_t>(least - loop.begin());
  return CGAL::right_turn(flat_[loop[(k + n - 1) % n]], flat_[loop[k]], flat_[loop[(k + 1) % n]]);
}

bool FaceCutter::triangulate() {
  std::vector<Triangle> flat;
  if (has_hole_) {
    if (!triangulate_loops(flat_, loops_, flat)) return false;
  } else {
    for (auto& loop : loops_)
      if (!triangulate_loops(flat_, {loop}, flat)) return false;
  }
  for (const auto& t : flat) cut_.triangles.push_back({corner_[t[0]], corner_[t[1]], corner_[t[2]]});
  return true;
}

bool FaceCutter::cut(std::uint32_t face, const SeamSegment* const* first, const SeamSegment* const* last) {
  clear();
  face_ = own_.triangles[face];
  cut_.faces.push_back(face);
  const Eigen::Vector3d a = own_.points.col(face_[0]);
  const Eigen::Vector3d n = (own_.points.col(face_[1]) - a).cross(own_.points.col(face_[2]) - a);
  n.cwiseAbs().maxCoeff(&drop_);
  mirrored_ = n[drop_] < 0;
  return add_border() && add_segments(first, last) && trace_loops() && triangulate();
}

}  // namespace

std::optional<CutFaces> cut_faces(const MeshView& a, const MeshView& b, const Seam& seam, bool of_a, Place keep) {
  std::vector<const SeamSegment*> segments;
  segments.reserve(seam.segments.size());
  for (const auto& segment : seam.segments) segments.push_back(&segment);
  const auto face = [&](const SeamSegment* s) { return of_a ? s->face_a : s->face_b; };
  std::stable_sort(segments.begin(), segments.end(),
                   [&](const SeamSegment* s, const SeamSegment* t) { return face(s) < face(t); });
  FaceCutter cutter(a, b, seam, of_a, keep);
  const SeamSegment* const* const end = segments.data() + segments.size();
  for (const SeamSegment* const* first = segments.data(); first != end;) {
    const SeamSegment* const* last = first;
    while (last != end && face(*last) == face(*first)) ++last;
    if (!cutter.cut(face(*first), first, last)) return std::nullopt;
    first = last;
  }
  return cutter.take();
}

}  // namespace meniscus::boolean_parts
