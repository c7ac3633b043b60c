// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapes_revolution.h"

#include "meniscus/core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double max_faces = 50e6;
constexpr int num_samples = 4096;  // of a piece, to measure its length

/// A piece sampled densely, to walk it at constant speed.
class MeasuredPiece {
 public:
  explicit MeasuredPiece(const ProfilePiece& piece) : piece_(piece), length_{0} {
    Eigen::Vector2d last = piece(0);
    for (int i = 1; i <= num_samples; ++i) {
      const Eigen::Vector2d x = piece(double(i) / num_samples);
      length_.push_back(length_.back() + (x - last).norm());
      last = x;
    }
  }
  double length() const { return length_.back(); }
  /// The point at a share of the length.
  Eigen::Vector2d at(double share) const {
    if (share <= 0) return piece_(0);
    if (share >= 1) return piece_(1);
    const double target = share * length();
    const auto above = std::upper_bound(length_.begin() + 1, length_.end() - 1, target);
    const double low = *(above - 1), step = *above - low;
    const double rest = step > 0 ? (target - low) / step : 0;
    return piece_((double(above - 1 - length_.begin()) + rest) / num_samples);
  }

 private:
  const ProfilePiece& piece_;
  std::vector<double> length_;
};

/// A circle of vertices about the axis; one vertex on the axis if count is 1.
struct RingOfVertices {
  double radius, height;
  std::uint32_t count, first = 0;
  double offset = 0;  ///< in steps: 0 or 1/2
};

/// The meridian's points where rings go, about sqrt(3)/2 of an edge apart.
std::vector<Eigen::Vector2d> stations(const std::vector<ProfilePiece>& meridian, double edge_length) {
  std::vector<MeasuredPiece> pieces(meridian.begin(), meridian.end());
  const double step = 0.5 * std::sqrt(3.0) * edge_length;
  std::vector<double> counts;
  double total = 0;
  for (const auto& piece : pieces) {
    counts.push_back(std::max(1.0, std::round(piece.length() / step)));
    total += counts.back();
  }
  check_face_count(3 * total);
  if (total < 3 && counts.size() == 1) counts[0] = 3;
  const bool closed = (meridian.back()(1) - meridian.front()(0)).norm() <= 1e-9 * pieces.front().length() &&
                      pieces.front().at(0).x() > 1e-9 * pieces.front().length();
  if (closed && static_cast<long>(total) % 2 == 1) counts.back() += 1;  // so that rings alternate all around
  std::vector<Eigen::Vector2d> points;
  for (std::size_t p = 0; p < pieces.size(); ++p)
    for (int i = p == 0 ? 0 : 1; i <= counts[p]; ++i) points.push_back(pieces[p].at(i / counts[p]));
  return points;
}

/// The triangles between two rings, the second further along the meridian: each edge of one ring
/// gets the vertex of the other that is nearest in angle.
void zip(const RingOfVertices& a, const RingOfVertices& b, std::vector<std::array<std::uint32_t, 3>>& triangles) {
  const auto middle = [](const RingOfVertices& ring, std::uint32_t i) { return (i + 0.5 + ring.offset) / ring.count; };
  const auto vertex = [](const RingOfVertices& ring, std::uint32_t i) { return ring.first + i % ring.count; };
  const std::uint32_t edges_a = a.count == 1 ? 0 : a.count, edges_b = b.count == 1 ? 0 : b.count;
  for (std::uint32_t i = 0, j = 0; i < edges_a || j < edges_b;) {
    if (j == edges_b || (i < edges_a && middle(a, i) <= middle(b, j))) {
      triangles.push_back({vertex(a, i), vertex(a, i + 1), vertex(b, j)});
      ++i;
    } else {
      triangles.push_back({vertex(a, i), vertex(b, j + 1), vertex(b, j)});
      ++j;
    }
  }
}

void check_meridian(const std::vector<ProfilePiece>& meridian) {
  if (meridian.empty()) throw UsageError("a surface of revolution needs at least one piece of meridian");
  double size = 0;
  for (const auto& piece : meridian)
    for (int i = 0; i <= 64; ++i) {
      const Eigen::Vector2d x = piece(i / 64.0);
      if (!x.allFinite()) throw UsageError(fmt::format("the meridian is not finite at s = {}", i / 64.0));
      size = std::max(size, x.cwiseAbs().maxCoeff());
    }
  for (std::size_t p = 0; p + 1 < meridian.size(); ++p)
    if ((meridian[p](1) - meridian[p + 1](0)).norm() > 1e-6 * size)
      throw UsageError(fmt::format("pieces {} and {} of the meridian do not join", p, p + 1));
}

}  // namespace

void check_size(const char* name, double value) {
  if (!(value > 0) || !std::isfinite(value))
    throw UsageError(fmt::format("{} is {}; it must be finite and greater than 0", name, value));
}

void check_face_count(double faces) {
  if (!(faces <= max_faces))
    throw UsageError(
        fmt::format("the shape would have {:.3g} faces; the most is {:.0g}: take a longer edge", faces, max_faces));
}

MeshData revolve(const std::vector<ProfilePiece>& meridian, double edge_length) {
  check_meridian(meridian);
  std::vector<Eigen::Vector2d> points = stations(meridian, edge_length);
  double largest = 0, faces = 0;
  for (const auto& x : points) largest = std::max(largest, x.x());
  const double axis = 1e-9 * largest;
  const auto on_axis = [&](const Eigen::Vector2d& x) { return std::abs(x.x()) <= axis; };
  const bool closed = !on_axis(points.front()) && (points.front() - points.back()).norm() <= 1e-9 * largest;
  if (!closed && !(on_axis(points.front()) && on_axis(points.back())))
    throw UsageError("the meridian must start and end on the axis, or be a closed curve");
  if (closed) points.pop_back();
  std::vector<RingOfVertices> rings;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool pole = !closed && (i == 0 || i + 1 == points.size());
    if (!pole && points[i].x() <= axis)
      throw UsageError(fmt::format("the meridian meets the axis at height {}, not only at its ends", points[i].y()));
    const double count = pole ? 1 : std::max(3.0, std::round(2 * pi * points[i].x() / edge_length));
    faces += 2 * count;
    check_face_count(faces);
    rings.push_back({pole ? 0.0 : points[i].x(), points[i].y(), static_cast<std::uint32_t>(count)});
  }
  MeshData data;
  for (std::size_t i = 0; i < rings.size(); ++i) {
    RingOfVertices& ring = rings[i];
    ring.first = static_cast<std::uint32_t>(data.points.size());
    ring.offset = i % 2 == 0 ? 0 : 0.5;
    for (std::uint32_t k = 0; k < ring.count; ++k) {
      const double angle = 2 * pi * (k + ring.offset) / ring.count;
      data.points.push_back({ring.radius * std::cos(angle), ring.radius * std::sin(angle), ring.height});
    }
  }
  for (std::size_t i = 0; i + 1 < rings.size(); ++i) zip(rings[i], rings[i + 1], data.triangles);
  if (closed) zip(rings.back(), rings.front(), data.triangles);
  return data;
}

}  // namespace meniscus
