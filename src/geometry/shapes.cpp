// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/geometry/shapes.h"

#include "meniscus/core/error.h"
#include "meniscus/core/mesh_data.h"
#include "shapes_revolution.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

constexpr double pi = 3.14159265358979323846;

/// The regular icosahedron, its vertices of unit length.
struct Icosahedron {
  std::vector<Eigen::Vector3d> corners;
  std::array<std::array<std::uint32_t, 3>, 20> faces{{{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                                      {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                                      {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                                      {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}}};
  Icosahedron() {
    const double t = 0.5 * (1 + std::sqrt(5.0));
    corners = {{-1, t, 0},  {1, t, 0},  {-1, -t, 0}, {1, -t, 0}, {0, -1, t},  {0, 1, t},
               {0, -1, -t}, {0, 1, -t}, {t, 0, -1},  {t, 0, 1},  {-t, 0, -1}, {-t, 0, 1}};
    for (auto& corner : corners) corner.normalize();
  }
};

/// The point of the spherical triangle a, b, c at barycentric coordinates (i, j, k) / n. Sines of
/// the arcs as weights cut the three sides into equal arcs.
Eigen::Vector3d spherical_point(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                                const std::array<int, 3>& ijk) {
  static const double side = std::atan(2.0);  // the arc of an icosahedron's edge
  const double n = ijk[0] + ijk[1] + ijk[2];
  return (std::sin(side * ijk[0] / n) * a + std::sin(side * ijk[1] / n) * b + std::sin(side * ijk[2] / n) * c)
      .normalized();
}

/// The mean edge of the unit icosphere, from one of its twenty equal faces.
double mean_icosphere_edge(int n) {
  const Icosahedron ico;
  const auto& [p, q, r] = ico.faces[0];
  const auto at = [&, a = ico.corners[p], b = ico.corners[q], c = ico.corners[r]](int i, int j) {
    return spherical_point(a, b, c, {i, j, n - i - j});
  };
  double sum = 0;  // the edges of one of the three directions; the other two are alike
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j) sum += (i == 0 ? 0.5 : 1.0) * (at(i, j) - at(i, j + 1)).norm();
  return sum / (0.5 * n * n);
}

MeshData unit_icosphere(int n) {
  check_face_count(20.0 * n * n);
  const Icosahedron ico;
  MeshData data;
  const auto add = [&](const Eigen::Vector3d& x) {
    data.points.push_back({x.x(), x.y(), x.z()});
    return static_cast<std::uint32_t>(data.points.size() - 1);
  };
  data.points.reserve(10 * std::size_t(n) * n + 2);
  data.triangles.reserve(20 * std::size_t(n) * n);
  for (const auto& corner : ico.corners) add(corner);
  std::array<std::array<std::uint32_t, 12>, 12> first_on_edge{};  // of the n - 1 points from lower to higher corner
  for (const auto& face : ico.faces)
    for (int side = 0; side < 3; ++side) {
      const std::uint32_t from = face[side], to = face[(side + 1) % 3];
      if (from > to) continue;  // its other face does it
      first_on_edge[from][to] = static_cast<std::uint32_t>(data.points.size());
      for (int k = 1; k < n; ++k)
        add(spherical_point(ico.corners[from], ico.corners[to], ico.corners[to], {n - k, k, 0}));
    }
  const auto on_edge = [&](std::uint32_t from, std::uint32_t to, int k) {
    return from < to ? first_on_edge[from][to] + k - 1 : first_on_edge[to][from] + n - k - 1;
  };
  for (const auto& [a, b, c] : ico.faces) {
    const auto first = static_cast<std::uint32_t>(data.points.size());
    for (int i = 1; i < n; ++i)  // i steps towards b, j towards c
      for (int j = 1; i + j < n; ++j)
        add(spherical_point(ico.corners[a], ico.corners[b], ico.corners[c], {n - i - j, i, j}));
    const auto at = [&, p = a, q = b, r = c](int i, int j) {
      if (i == 0) return j == 0 ? p : j == n ? r : on_edge(p, r, j);
      if (j == 0) return i == n ? q : on_edge(p, q, i);
      if (i + j == n) return on_edge(q, r, j);
      return first + static_cast<std::uint32_t>((i - 1) * (n - 1) - (i - 1) * i / 2 + j - 1);
    };
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j) {
        data.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
        if (i + j + 1 < n) data.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
      }
  }
  return data;
}

/// Every point x becomes center + linear x.
Mesh placed(MeshData data, const Eigen::Matrix3d& linear, const Eigen::Vector3d& center) {
  for (auto& p : data.points) {
    const Eigen::Vector3d x = linear * Eigen::Vector3d(p[0], p[1], p[2]) + center;
    p = {x.x(), x.y(), x.z()};
  }
  return to_mesh(data);
}

Eigen::Matrix3d scaling(const Eigen::Vector3d& scale) { return scale.asDiagonal(); }

int icosphere_frequency(double radius, double edge_length) {
  const double guess = 1.2 * radius / edge_length;  // the mean edge tends to 1.2 radius / n
  check_face_count(20 * guess * guess);
  const int low = std::max(1, static_cast<int>(guess) - 1);
  int best = low;
  double least = std::abs(radius * mean_icosphere_edge(low) - edge_length);
  for (int n = low + 1; n <= low + 3; ++n) {
    const double error = std::abs(radius * mean_icosphere_edge(n) - edge_length);
    if (error < least) least = error, best = n;
  }
  return best;
}

ProfilePiece line(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  return [from, to](double s) -> Eigen::Vector2d { return s == 1 ? to : Eigen::Vector2d(from + s * (to - from)); };
}

/// The circle's points at angles from `from` to `to`, counterclockwise from the direction of the radius.
ProfilePiece arc(const Eigen::Vector2d& center, double radius, double from, double to) {
  return [=](double s) -> Eigen::Vector2d {
    const double angle = from + s * (to - from);
    return center + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  };
}

/// Rings about the axis `axis` of the ellipsoid.
MeshData ellipsoid_of_rings(const Eigen::Vector3d& semi_axes, int axis, double edge_length) {
  const int x = (axis + 1) % 3, y = (axis + 2) % 3;
  const double radius = std::sqrt(semi_axes[x] * semi_axes[y]), height = semi_axes[axis];
  const ProfilePiece meridian = [=](double s) -> Eigen::Vector2d {
    const double angle = pi * (s - 0.5);
    return {radius * std::cos(angle), height * std::sin(angle)};
  };
  MeshData data = revolve({meridian}, edge_length);
  for (auto& p : data.points) {
    std::array<double, 3> q;
    q[x] = p[0] * semi_axes[x] / radius, q[y] = p[1] * semi_axes[y] / radius, q[axis] = p[2];
    p = q;
  }
  return data;
}

/// The axis that is least like the other two, by ratio.
int odd_axis(const Eigen::Vector3d& a) {
  const auto ratio = [&](int i) {
    const double p = a[(i + 1) % 3], q = a[(i + 2) % 3];
    return std::max(p, q) / std::min(p, q);
  };
  int best = 2;
  for (int i = 0; i < 2; ++i)
    if (ratio(i) < ratio(best)) best = i;
  return best;
}

/// A box's surface lattice, point (i, j, k) known by a key.
class BoxGrid {
 public:
  explicit BoxGrid(const std::array<std::uint64_t, 3>& cells) : cells_(cells) {}

  MeshData build() {
    for_each_square([&](const std::array<std::uint64_t, 4>& corner, bool) {
      keys_.insert(keys_.end(), corner.begin(), corner.end());
    });
    std::sort(keys_.begin(), keys_.end());
    keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
    MeshData data;
    for (const auto key : keys_) data.points.push_back(point(key));
    for_each_square([&](const std::array<std::uint64_t, 4>& corner, bool rising) {
      std::array<std::uint32_t, 4> v;
      for (int c = 0; c < 4; ++c) v[c] = index(corner[c]);
      if (rising) {
        data.triangles.push_back({v[0], v[1], v[2]});
        data.triangles.push_back({v[0], v[2], v[3]});
      } else {
        data.triangles.push_back({v[0], v[1], v[3]});
        data.triangles.push_back({v[1], v[2], v[3]});
      }
    });
    return data;
  }

 private:
  /// use(corner keys counterclockwise seen from outside, whether the diagonal starts at the first).
  template <class Use>
  void for_each_square(Use use) const {
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 2; ++side) {
        const int a = (axis + (side ? 1 : 2)) % 3, b = (axis + (side ? 2 : 1)) % 3;
        std::array<std::uint64_t, 3> at;
        at[axis] = side ? cells_[axis] : 0;
        for (std::uint64_t i = 0; i < cells_[a]; ++i)
          for (std::uint64_t j = 0; j < cells_[b]; ++j) {
            const auto corner = [&](std::uint64_t u, std::uint64_t v) { return at[a] = i + u, at[b] = j + v, key(at); };
            use({corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)}, (i + j) % 2 == 0);
          }
      }
  }
  std::uint64_t key(const std::array<std::uint64_t, 3>& at) const {
    return (at[2] * (cells_[1] + 1) + at[1]) * (cells_[0] + 1) + at[0];
  }
  std::array<double, 3> point(std::uint64_t key) const {
    const std::uint64_t i = key % (cells_[0] + 1), jk = key / (cells_[0] + 1);
    const std::array<std::uint64_t, 3> at{i, jk % (cells_[1] + 1), jk / (cells_[1] + 1)};
    std::array<double, 3> p;  // in [-1/2, 1/2], symmetric to the bit
    for (int d = 0; d < 3; ++d) p[d] = (2.0 * at[d] - cells_[d]) / (2.0 * cells_[d]);
    return p;
  }
  std::uint32_t index(std::uint64_t key) const {
    return static_cast<std::uint32_t>(std::lower_bound(keys_.begin(), keys_.end(), key) - keys_.begin());
  }

  std::array<std::uint64_t, 3> cells_;
  std::vector<std::uint64_t> keys_;
};

void check_center(const Eigen::Vector3d& center) {
  if (!center.allFinite()) throw UsageError("the centre must have finite coordinates");
}

}  // namespace

Mesh make_icosphere(const Eigen::Vector3d& center, double radius, int frequency) {
  check_center(center);
  check_size("radius", radius);
  if (frequency < 1) throw UsageError(fmt::format("frequency is {}; it must be at least 1", frequency));
  return placed(unit_icosphere(frequency), scaling({radius, radius, radius}), center);
}

Mesh make_sphere(const Eigen::Vector3d& center, double radius, double edge_length) {
  check_size("radius", radius);
  check_size("edge_length", edge_length);
  return make_icosphere(center, radius, icosphere_frequency(radius, edge_length));
}

Mesh make_ellipsoid(const Eigen::Vector3d& center, const Eigen::Vector3d& semi_axes, double edge_length) {
  check_center(center);
  for (const double axis : {semi_axes.x(), semi_axes.y(), semi_axes.z()}) check_size("semi-axis", axis);
  check_size("edge_length", edge_length);
  if (semi_axes.maxCoeff() <= 1.5 * semi_axes.minCoeff()) {
    const int frequency = icosphere_frequency(std::cbrt(semi_axes.prod()), edge_length);
    return placed(unit_icosphere(frequency), scaling(semi_axes), center);
  }
  return placed(ellipsoid_of_rings(semi_axes, odd_axis(semi_axes), edge_length), Eigen::Matrix3d::Identity(), center);
}

Mesh make_box(const Eigen::Vector3d& center, const Eigen::Vector3d& size, double edge_length) {
  check_center(center);
  for (const double side : {size.x(), size.y(), size.z()}) check_size("size", side);
  check_size("edge_length", edge_length);
  const Eigen::Array3d cells = (size.array() / edge_length).round().max(1.0);
  check_face_count(4 * (cells[0] * cells[1] + cells[1] * cells[2] + cells[2] * cells[0]));
  BoxGrid grid({std::uint64_t(cells[0]), std::uint64_t(cells[1]), std::uint64_t(cells[2])});
  return placed(grid.build(), scaling(size), center);
}

Mesh make_cap(const Eigen::Vector3d& center, const Eigen::Vector3d& axis, double contact_radius, double contact_angle,
              double edge_length) {
  check_center(center);
  check_size("contact_radius", contact_radius);
  check_size("contact_angle", contact_angle);
  check_size("edge_length", edge_length);
  check_size("the axis' length", axis.norm());
  if (contact_angle >= pi) throw UsageError(fmt::format("contact_angle is {}; it must lie below pi", contact_angle));
  const double radius = contact_radius / std::sin(contact_angle);
  const Eigen::Vector2d rim(contact_radius, 0), ball(0, -radius * std::cos(contact_angle));
  const auto dome = arc(ball, radius, 0.5 * pi - contact_angle, 0.5 * pi);
  const ProfilePiece dome_from_rim = [=](double s) -> Eigen::Vector2d { return s == 0 ? rim : dome(s); };
  const auto turn = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis).toRotationMatrix();
  return placed(revolve({line({0, 0}, rim), dome_from_rim}, edge_length), turn, center);
}

Mesh make_torus(const Eigen::Vector3d& center, double major, double minor, double edge_length) {
  check_center(center);
  check_size("major", major);
  check_size("minor", minor);
  check_size("edge_length", edge_length);
  if (minor >= major)
    throw UsageError(fmt::format("the torus' minor radius {} must be smaller than its major radius {}", minor, major));
  return placed(revolve({arc({major, 0}, minor, 0, 2 * pi)}, edge_length), Eigen::Matrix3d::Identity(), center);
}

Mesh make_dumbbell(double length, double ball_radius, double neck_radius, double edge_length) {
  check_size("length", length);
  check_size("ball_radius", ball_radius);
  check_size("neck_radius", neck_radius);
  check_size("edge_length", edge_length);
  const double c = 0.5 * length - ball_radius;  // the height of the upper ball's centre
  const double apart = c * c + neck_radius * neck_radius - ball_radius * ball_radius;
  if (neck_radius >= ball_radius || c <= 0 || apart <= 0)
    throw UsageError(
        fmt::format("no dumbbell of length {} has balls of radius {} and a neck of radius {}: the neck "
                    "must be thinner than the balls, and the balls further apart",
                    length, ball_radius, neck_radius));
  const double fillet = std::min(ball_radius, apart / (2 * (ball_radius - neck_radius)));
  const double across = neck_radius + fillet;  // of the fillet's centre, from the axis
  const double reach = ball_radius + fillet;
  const double drop = std::sqrt(std::max(0.0, reach * reach - across * across));  // below the ball's centre
  const double z = std::max(0.0, c - drop);                                       // the fillet's centre
  const double tilt = std::atan2(drop, across);  // of the line between the two centres, from the horizontal
  const double top = 0.5 * pi;
  std::vector<ProfilePiece> meridian{arc({0, -c}, ball_radius, -top, tilt), arc({across, -z}, fillet, pi + tilt, pi)};
  if (z > 1e-9 * length) meridian.push_back(line({neck_radius, -z}, {neck_radius, z}));
  meridian.push_back(arc({across, z}, fillet, pi, pi - tilt));
  meridian.push_back(arc({0, c}, ball_radius, -tilt, top));
  return to_mesh(revolve(meridian, edge_length));
}

Mesh make_surface_of_revolution(const std::vector<ProfilePiece>& meridian, double edge_length) {
  check_size("edge_length", edge_length);
  return to_mesh(revolve(meridian, edge_length));
}

}  // namespace meniscus
