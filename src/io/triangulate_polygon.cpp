// SPDX-License-Identifier: GPL-3.0-or-later
#include "triangulate_polygon.h"

#include "meniscus/core/types.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace meniscus::io {
namespace {

using Point2 = Kernel::Point_2;
using Points = std::vector<std::array<double, 3>>;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

constexpr std::size_t kMaxCorners = 10000;
constexpr int kMaxRescans = 8;

bool is_left_turn(const Point2& a, const Point2& b, const Point2& c) {
  return CGAL::orientation(a, b, c) == CGAL::LEFT_TURN;
}

/// Newell's normal: sum over the edges (p, q) of p x q, with respect to the first corner, in units of
/// the polygon's size so that nothing over- or underflows.
Eigen::Vector3d newell_normal(const Points& points, const std::vector<std::uint32_t>& corners) {
  const Eigen::Vector3d origin(points[corners[0]].data());
  const auto relative = [&](std::size_t i) -> Eigen::Vector3d {
    return Eigen::Vector3d(points[corners[i]].data()) - origin;
  };
  double size = 0;
  for (std::size_t i = 1; i < corners.size(); ++i) size = std::max(size, relative(i).cwiseAbs().maxCoeff());
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (std::size_t i = 2; i < corners.size(); ++i) normal += (relative(i - 1) / size).cross(relative(i) / size);
  return normal;
}

/// The polygon without its coordinate along the dominant axis of its normal, counterclockwise; empty
/// if it is not finite or has no normal.
std::vector<Point2> project(const Points& points, const std::vector<std::uint32_t>& corners) {
  const Eigen::Vector3d normal = newell_normal(points, corners);
  if (!normal.allFinite() || normal.isZero(0)) return {};
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  std::size_t u = static_cast<std::size_t>((axis + 1) % 3), v = static_cast<std::size_t>((axis + 2) % 3);
  if (normal[axis] < 0) std::swap(u, v);
  std::vector<Point2> flat;
  flat.reserve(corners.size());
  for (const auto corner : corners) flat.emplace_back(points[corner][u], points[corner][v]);
  return flat;
}

/// Turns left at every corner and goes around once: it has one lexicographically least corner.
bool is_strictly_convex(const std::vector<Point2>& polygon) {
  const std::size_t n = polygon.size();
  int reversals = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Point2 &a = polygon[i], &b = polygon[(i + 1) % n], &c = polygon[(i + 2) % n];
    if (!is_left_turn(a, b, c)) return false;
    if ((a < b) != (b < c)) ++reversals;
  }
  return reversals == 2;
}

/// The ring of corners that are left, and which of them can be cut off.
class EarClipper {
 public:
  explicit EarClipper(const std::vector<Point2>& polygon)
      : polygon_(polygon), left_(polygon.size()), next_(left_), previous_(left_), is_reflex_(left_), is_ear_(left_) {
    for (std::size_t i = 0; i < left_; ++i) {
      next_[i] = (i + 1) % left_;
      previous_[i] = (i + left_ - 1) % left_;
    }
    for (std::size_t i = 0; i < left_; ++i) is_reflex_[i] = !is_convex(i);
    find_ears(0);
  }

  /// Calls emit(a, b, c) for n - 2 triangles.
  template <class Emit>
  void clip(Emit emit) {
    std::size_t at = 0;
    for (int rescans = 0; left_ > 3;) {
      std::size_t walked = 0;
      for (; !is_ear_[at] && walked < left_; ++walked) at = next_[at];
      if (walked == left_) {
        if (++rescans > kMaxRescans) break;
        if (!find_ears(at)) break;
        continue;
      }
      emit(previous_[at], at, next_[at]);
      at = remove(at);
    }
    for (std::size_t b = next_[at]; next_[b] != at; b = next_[b]) emit(at, b, next_[b]);
  }

 private:
  bool is_convex(std::size_t i) const { return is_left_turn(polygon_[previous_[i]], polygon_[i], polygon_[next_[i]]); }

  /// Whether p lies in the closed triangle abc and is none of its corners.
  static bool covers(const Point2& a, const Point2& b, const Point2& c, const Point2& p) {
    if (p.x() < std::min({a.x(), b.x(), c.x()}) || p.x() > std::max({a.x(), b.x(), c.x()}) ||
        p.y() < std::min({a.y(), b.y(), c.y()}) || p.y() > std::max({a.y(), b.y(), c.y()}))
      return false;
    return p != a && p != b && p != c && CGAL::orientation(a, b, p) != CGAL::RIGHT_TURN &&
           CGAL::orientation(b, c, p) != CGAL::RIGHT_TURN && CGAL::orientation(c, a, p) != CGAL::RIGHT_TURN;
  }

  bool can_clip(std::size_t i) const {
    if (is_reflex_[i]) return false;
    const std::size_t a = previous_[i], c = next_[i];
    for (std::size_t v = next_[c]; v != a; v = next_[v])
      if (is_reflex_[v] && covers(polygon_[a], polygon_[i], polygon_[c], polygon_[v])) return false;
    return true;
  }

  bool find_ears(std::size_t start) {
    bool found = false;
    std::size_t i = start;
    do {
      is_ear_[i] = can_clip(i);
      found = found || is_ear_[i];
      i = next_[i];
    } while (i != start);
    return found;
  }

  /// Cuts off corner i; returns a corner further on, so that the triangles do not all share one.
  std::size_t remove(std::size_t i) {
    const std::size_t a = previous_[i], c = next_[i];
    next_[a] = c;
    previous_[c] = a;
    --left_;
    for (const auto corner : {a, c}) is_reflex_[corner] = !is_convex(corner);
    for (const auto corner : {a, c}) is_ear_[corner] = can_clip(corner);
    return next_[c];
  }

  const std::vector<Point2>& polygon_;
  std::size_t left_;
  std::vector<std::size_t> next_, previous_;
  std::vector<char> is_reflex_, is_ear_;
};

}  // namespace

bool triangulate_polygon(const Points& points, const std::vector<std::uint32_t>& corners, Triangles& triangles) {
  const std::vector<Point2> polygon = project(points, corners);
  if (polygon.empty() || is_strictly_convex(polygon)) {
    for (std::size_t i = 2; i < corners.size(); ++i) triangles.push_back({corners[0], corners[i - 1], corners[i]});
    return true;
  }
  if (corners.size() > kMaxCorners) return false;
  EarClipper(polygon).clip([&](std::size_t a, std::size_t b, std::size_t c) {
    triangles.push_back({corners[a], corners[b], corners[c]});
  });
  return true;
}

}  // namespace meniscus::io
