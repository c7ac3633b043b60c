// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/mesh_data.h"
#include "meniscus/geometry/shapes.h"

#include <Eigen/Geometry>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

/// Pairs of meshes that Booleans tend to fail on, and what two of them have in common by another method.
namespace meniscus::boolean_cases {

using Tetrahedron = std::array<Eigen::Vector3d, 4>;

inline double volume(const Tetrahedron& t) { return std::abs((t[1] - t[0]).dot((t[2] - t[0]).cross(t[3] - t[0]))) / 6; }

/// Appends the part of a tetrahedron on the positive side of n.x >= d, as tetrahedra.
inline void clip(const Tetrahedron& t, const Eigen::Vector3d& n, double d, std::vector<Tetrahedron>& out) {
  std::vector<int> in, off;
  double height[4];
  for (int k = 0; k < 4; ++k) {
    height[k] = n.dot(t[k]) - d;
    (height[k] >= 0 ? in : off).push_back(k);
  }
  const auto cut = [&](int i, int j) -> Eigen::Vector3d {
    return t[i] + height[i] / (height[i] - height[j]) * (t[j] - t[i]);
  };
  const auto add_prism = [&](const std::array<Eigen::Vector3d, 3>& a, const std::array<Eigen::Vector3d, 3>& b) {
    out.push_back({a[0], a[1], a[2], b[0]});
    out.push_back({a[1], a[2], b[0], b[1]});
    out.push_back({a[2], b[0], b[1], b[2]});
  };
  if (in.size() == 4) out.push_back(t);
  if (in.size() == 1) out.push_back({t[in[0]], cut(in[0], off[0]), cut(in[0], off[1]), cut(in[0], off[2])});
  if (in.size() == 3)
    add_prism({t[in[0]], t[in[1]], t[in[2]]}, {cut(in[0], off[0]), cut(in[1], off[0]), cut(in[2], off[0])});
  if (in.size() == 2)
    add_prism({t[in[0]], cut(in[0], off[0]), cut(in[0], off[1])}, {t[in[1]], cut(in[1], off[0]), cut(in[1], off[1])});
}

inline double common_volume(const Tetrahedron& s, const Tetrahedron& t) {
  std::vector<Tetrahedron> parts{s}, next;
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector3d &a = t[k], &b = t[(k + 1) % 4], &c = t[(k + 2) % 4], &opposite = t[(k + 3) % 4];
    Eigen::Vector3d n = (b - a).cross(c - a);
    if (n.dot(opposite - a) < 0) n = -n;
    next.clear();
    for (const auto& part : parts) clip(part, n, n.dot(a), next);
    parts.swap(next);
  }
  double sum = 0;
  for (const auto& part : parts) sum += volume(part);
  return sum;
}

/// The volume common to two closed meshes: each is a signed sum of the tetrahedra that its faces span
/// with a point, and those of both are clipped against each other. No topology, no predicates.
inline double common_volume(const MeshData& a, const MeshData& b) {
  struct Cone {
    Tetrahedron corners;
    Eigen::AlignedBox3d box;
    double sign;
  };
  Eigen::Vector3d apex;
  Eigen::AlignedBox3d box;
  for (const auto& p : a.points) box.extend(Eigen::Vector3d::Map(p.data()));
  apex = box.center() + 0.1 * box.sizes().cwiseProduct(Eigen::Vector3d(0.3183, 0.5772, -0.7181));  // on no face's plane
  const auto cones = [&](const MeshData& mesh) {
    std::vector<Cone> all;
    for (const auto& t : mesh.triangles) {
      Cone cone;
      cone.corners[0].setZero();
      for (int k = 0; k < 3; ++k) cone.corners[k + 1] = Eigen::Vector3d::Map(mesh.points[t[k]].data()) - apex;
      for (const auto& p : cone.corners) cone.box.extend(p);
      const double six = cone.corners[1].dot(cone.corners[2].cross(cone.corners[3]));
      cone.sign = (six > 0) - (six < 0);
      const double lengths = cone.corners[1].norm() * cone.corners[2].norm() * cone.corners[3].norm();
      if (std::abs(six) > 1e-13 * lengths) all.push_back(cone);  // flatter ones are all rounding
    }
    return all;
  };
  const std::vector<Cone> of_a = cones(a), of_b = cones(b);
  double sum = 0;
  for (const auto& s : of_a)
    for (const auto& t : of_b)
      if (s.box.intersects(t.box)) sum += s.sign * t.sign * common_volume(s.corners, t.corners);
  return sum;
}

inline double volume(const MeshData& mesh) {
  double six = 0;
  const Eigen::Vector3d origin = Eigen::Vector3d::Map(mesh.points[mesh.triangles[0][0]].data());
  for (const auto& t : mesh.triangles) {
    Eigen::Vector3d p[3];
    for (int k = 0; k < 3; ++k) p[k] = Eigen::Vector3d::Map(mesh.points[t[k]].data()) - origin;
    six += p[0].dot(p[1].cross(p[2]));
  }
  return six / 6;
}

inline MeshData cube(const Eigen::Vector3d& center = {0, 0, 0}, const Eigen::Vector3d& size = {1, 1, 1}) {
  return to_mesh_data(make_box(center, size, 10 * size.maxCoeff()));
}
inline MeshData ball(int frequency = 3, const Eigen::Vector3d& center = {0, 0, 0}, double radius = 1) {
  return to_mesh_data(make_icosphere(center, radius, frequency));
}

template <class Function>
MeshData mapped(MeshData mesh, Function function) {
  for (auto& p : mesh.points)
    Eigen::Vector3d::Map(p.data()) = function(Eigen::Vector3d(Eigen::Vector3d::Map(p.data())));
  return mesh;
}
inline MeshData moved(const MeshData& mesh, const Eigen::Vector3d& by) {
  return mapped(mesh, [&](const Eigen::Vector3d& p) -> Eigen::Vector3d { return p + by; });
}
inline MeshData scaled(const MeshData& mesh, double by) {
  return mapped(mesh, [&](const Eigen::Vector3d& p) -> Eigen::Vector3d { return p * by; });
}
inline MeshData rotated(const MeshData& mesh, double angle, const Eigen::Vector3d& axis = {0.3, 0.5, 0.81}) {
  const Eigen::Matrix3d r = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  return mapped(mesh, [&](const Eigen::Vector3d& p) -> Eigen::Vector3d { return r * p; });
}
inline MeshData flipped(MeshData mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}
/// Through a point, and the right way round again.
inline MeshData mirrored(const MeshData& mesh, const Eigen::Vector3d& through) {
  return flipped(mapped(mesh, [&](const Eigen::Vector3d& p) -> Eigen::Vector3d { return 2 * through - p; }));
}
inline MeshData both(MeshData a, const MeshData& b) {
  const auto first = static_cast<std::uint32_t>(a.points.size());
  a.points.insert(a.points.end(), b.points.begin(), b.points.end());
  for (const auto& [i, j, k] : b.triangles) a.triangles.push_back({first + i, first + j, first + k});
  return a;
}
/// A cube of which one wall is missing, 1 outside and 0.6 inside: open towards +x.
inline MeshData cup() {
  MeshData data;
  const double o = 0.5, i = 0.3;
  data.points = {{-o, -o, -o}, {-o, o, -o}, {-o, o, o}, {-o, -o, o}, {o, -o, -o}, {o, o, -o}, {o, o, o}, {o, -o, o},
                 {-i, -i, -i}, {-i, i, -i}, {-i, i, i}, {-i, -i, i}, {o, -i, -i}, {o, i, -i}, {o, i, i}, {o, -i, i}};
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    data.triangles.push_back({a, b, c});
    data.triangles.push_back({a, c, d});
  };
  quad(0, 3, 2, 1);
  quad(8, 9, 10, 11);
  for (std::uint32_t k = 0; k < 4; ++k) {
    const std::uint32_t l = (k + 1) % 4;
    quad(k, l, 4 + l, 4 + k);            // outer walls
    quad(8 + k, 12 + k, 12 + l, 8 + l);  // inner walls
    quad(4 + k, 4 + l, 12 + l, 12 + k);  // rim
  }
  return data;
}

struct Case {
  std::string name;
  MeshData a, b;
};

inline double power(int k) { return std::pow(10.0, -k); }

inline void add_boxes(std::vector<Case>& cases) {
  const MeshData unit = cube();
  const std::vector<Case> exact = {
      {"four coplanar faces", unit, cube({0.5, 0, 0})},
      {"three coplanar faces", unit, cube({0.5, 0, 0.1}, {1, 1, 0.8})},
      {"two coplanar faces", unit, cube({0.5, 0.3, 0})},
      {"one coplanar face", unit, cube({0.2, 0.3, 0.1}, {1, 1, 0.8})},
      {"inside with a common face", unit, cube({0, 0, 0.25}, {0.5, 0.5, 0.5})},
      {"inside with a common edge", unit, cube({0, 0.25, 0.25}, {0.5, 0.5, 0.5})},
      {"inside with a common corner", unit, cube({0.25, 0.25, 0.25}, {0.5, 0.5, 0.5})},
      {"touching at a face", unit, cube({1, 0, 0})},
      {"touching at part of a face", unit, cube({1, 0.5, 0.25})},
      {"touching at the middle of a face", unit, cube({0.75, 0, 0}, {0.5, 0.5, 0.5})},
      {"touching at an edge", unit, cube({1, 1, 0})},
      {"touching at part of an edge", unit, cube({1, 1, 0.5})},
      {"touching at a vertex", unit, cube({1, 1, 1})},
  };
  for (const auto& c : exact) {
    cases.push_back(c);
    cases.push_back({c.name + ", rotated", rotated(c.a, 0.7), rotated(c.b, 0.7)});
  }
  cases.push_back({"identical cubes", unit, unit});
  cases.push_back({"identical cubes, other diagonals", unit, rotated(unit, std::acos(0.0), {0, 0, 1})});
  cases.push_back({"a cross of bars", cube({0, 0, 0}, {3, 1, 1}), cube({0, 0, 0}, {1, 3, 1})});
  cases.push_back({"an edge against an edge", unit,
                   moved(rotated(rotated(unit, 0.7853981633974483, {1, 0, 0}), 1.5707963267948966, {0, 0, 1}),
                         {1.2071067811865475, 0, 0.5})});
  for (const int k : {3, 6, 9, 12, 15}) {
    cases.push_back({"a slab of 1e-" + std::to_string(k), unit, cube({0.3, 0.2, 0.1}, {1, 1, power(k)})});
    cases.push_back(
        {"a needle of 1e-" + std::to_string(k), unit, rotated(cube({0.3, 0.1, 0}, {2, power(k), power(k)}), 0.4)});
  }
}

inline void add_balls(std::vector<Case>& cases) {
  const MeshData unit = ball();
  cases.push_back({"identical balls", unit, unit});
  cases.push_back({"deep overlap", unit, ball(3, {1.1, 0.1, 0.2})});
  cases.push_back({"small contact", unit, ball(3, {1.2, 0.9, 1.1})});
  cases.push_back({"disjoint", unit, ball(3, {3, 0, 0})});
  cases.push_back({"nested", unit, ball(2, {0.1, 0, 0}, 0.4)});
  cases.push_back({"nested, touching at a vertex", unit, mapped(unit, [&](const Eigen::Vector3d& p) -> Eigen::Vector3d {
                     const Eigen::Vector3d v = Eigen::Vector3d::Map(unit.points[0].data());
                     return v + 0.5 * (p - v);
                   })});
  const Eigen::Vector3d pole = Eigen::Vector3d::Map(unit.points[0].data()),
                        oblique = Eigen::Vector3d(0.31, 0.77, 0.56).normalized();
  for (const int k : {3, 6, 9, 12})
    for (const double side : {-1.0, 1.0}) {
      const std::string name = std::string(side < 0 ? "overlapping" : "apart") + " by 1e-" + std::to_string(k);
      cases.push_back({"vertices " + name, unit, mirrored(unit, (1 + side * power(k)) * pole)});
      cases.push_back(
          {"vertex and face " + name, unit, moved(rotated(unit, 0.4), 2 * (1 + side * power(k)) * oblique)});
    }
  cases.push_back({"vertices touching", unit, mirrored(unit, pole)});
  for (const int k : {3, 6, 9, 12, 15}) {
    const std::string by = " by 1e-" + std::to_string(k);
    cases.push_back({"the same, rotated" + by, unit, rotated(unit, power(k))});
    cases.push_back({"the same, moved" + by, unit, moved(unit, power(k) * oblique)});
    cases.push_back({"the same, scaled" + by, unit, scaled(unit, 1 + power(k))});
  }
  for (const double scale : {1e-6, 1e6, 1e-60, 1e60})
    cases.push_back({"at another scale", scaled(unit, scale), scaled(ball(3, {1.1, 0.1, 0.2}), scale)});
  cases.push_back(
      {"far from the origin", moved(unit, {1e6, -1e6, 1e6}), moved(ball(3, {1.1, 0.1, 0.2}), {1e6, -1e6, 1e6})});
  cases.push_back({"a speck on a ball", unit, ball(2, pole, 1e-6)});
}

inline void add_others(std::vector<Case>& cases) {
  const MeshData torus = to_mesh_data(make_torus({0, 0, 0}, 1, 0.3, 0.4));
  cases.push_back({"identical tori", torus, torus});
  cases.push_back({"linked tori", torus, moved(rotated(torus, 1.5707963267948966, {1, 0, 0}), {1, 0.1, 0})});
  cases.push_back({"crossing tori", torus, moved(rotated(torus, 1.2, {1, 0, 0}), {0.3, 0.1, 0})});
  cases.push_back({"a ball in a torus' hole", torus, ball(3, {0, 0, 0}, 0.85)});
  cases.push_back(
      {"two cups that shut air in", cup(), moved(rotated(cup(), 3.141592653589793, {0, 0, 1}), {0.9, 0.02, 0.03})});
  cases.push_back({"a plug in a cup", cup(), cube({0.45, 0, 0}, {0.2, 0.8, 0.8})});
  cases.push_back(
      {"a ball that bridges two", both(ball(3, {-1.4, 0, 0}), ball(3, {1.4, 0.1, 0})), ball(3, {0, 0, 0.1}, 0.7)});
  cases.push_back({"a ball in a cavity", both(ball(3), flipped(ball(3, {0, 0, 0}, 0.8))), ball(2, {0.1, 0, 0}, 0.3)});
  cases.push_back(
      {"a ball over a cavity", both(ball(3), flipped(ball(3, {0, 0, 0}, 0.6))), ball(3, {0.5, 0.1, 0}, 0.5)});
  cases.push_back({"a bar through one face", cube({0, 0, 0}, {4, 4, 1}), ball(4, {0.7, -0.4, 0.1}, 0.9)});
  cases.push_back(
      {"one bar through many", cube({0, 0, 0}, {4, 4, 1}),
       both(ball(2, {1, 0.3, 0.4}, 0.3), both(ball(2, {-1, 0.2, 0.5}, 0.3), ball(2, {0.1, -0.8, 0.55}, 0.3)))});
}

/// Sound meshes, by families: what a Boolean makes of them is defined.
inline std::vector<Case> valid_cases() {
  std::vector<Case> cases;
  add_boxes(cases);
  add_balls(cases);
  add_others(cases);
  return cases;
}

/// Meshes that are not sound, in the place of A. B is a ball that meets them.
inline std::vector<Case> bad_cases() {
  const MeshData unit = cube(), other = ball(2, {0.5, 0.1, 0.2}, 0.6);
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  std::vector<Case> cases;
  const auto add = [&](const std::string& name, auto change) {
    MeshData mesh = unit;
    change(mesh);
    cases.push_back({name, mesh, other});
  };
  add("open", [](MeshData& m) { m.triangles.pop_back(); });
  add("inside out", [](MeshData& m) { m = flipped(m); });
  add("one face turned", [](MeshData& m) { std::swap(m.triangles[3][0], m.triangles[3][1]); });
  add("a repeated face", [](MeshData& m) { m.triangles.push_back(m.triangles[0]); });
  add("a face with a vertex twice", [](MeshData& m) { m.triangles.push_back({0, 0, 1}); });
  add("a vertex that is not there", [](MeshData& m) { m.triangles.push_back({0, 1, 99}); });
  add("nan", [&](MeshData& m) { m.points[2][1] = nan; });
  add("infinity", [&](MeshData& m) { m.points[2][1] = infinity; });
  add("1e300", [](MeshData& m) { m.points[2][1] = 1e300; });
  add("empty", [](MeshData& m) { m = {}; });
  add("points without faces", [](MeshData& m) { m.triangles.clear(); });
  add("a point without faces", [](MeshData& m) { m.points.push_back({3, 3, 3}); });
  add("unwelded corners", [](MeshData& m) {
    MeshData soup;
    for (const auto& t : m.triangles) {
      const auto first = static_cast<std::uint32_t>(soup.points.size());
      for (const auto v : t) soup.points.push_back(m.points[v]);
      soup.triangles.push_back({first, first + 1, first + 2});
    }
    m = soup;
  });
  add("a face without area", [](MeshData& m) {  // a vertex on an edge
    const auto [a, b, c] = m.triangles[0];
    const auto middle = static_cast<std::uint32_t>(m.points.size());
    std::array<double, 3> p;
    for (int d = 0; d < 3; ++d) p[d] = 0.5 * (m.points[a][d] + m.points[b][d]);
    m.points.push_back(p);
    m.triangles[0] = {middle, b, c};
    m.triangles.push_back({a, middle, c});
    m.triangles.push_back({a, b, middle});
  });
  add("an edge without length", [](MeshData& m) {  // a vertex doubled, and two faces without area between
    const auto [a, b, c] = m.triangles[0];
    const auto copy = static_cast<std::uint32_t>(m.points.size());
    m.points.push_back(m.points[a]);
    m.triangles[0] = {copy, b, c};
    m.triangles.push_back({a, b, copy});
    m.triangles.push_back({a, copy, c});
  });
  add("pinched at a vertex", [](MeshData& m) {
    MeshData second = moved(m, {1, 1, 1});
    std::uint32_t here = 0, there = 0;
    for (std::uint32_t v = 0; v < m.points.size(); ++v) {
      if (m.points[v][0] > 0 && m.points[v][1] > 0 && m.points[v][2] > 0) here = v;
      if (second.points[v][0] < 1 && second.points[v][1] < 1 && second.points[v][2] < 1) there = v;
    }
    const auto first = static_cast<std::uint32_t>(m.points.size());
    m = both(m, second);
    for (auto& t : m.triangles)
      for (auto& v : t)
        if (v == first + there) v = here;
    m.points.pop_back();
    if (there + 1 != second.points.size()) {  // fill the place that fell free
      m.points[first + there] = second.points.back();
      for (auto& t : m.triangles)
        for (auto& v : t)
          if (v == m.points.size()) v = first + there;
    }
  });
  add("a fin", [](MeshData& m) {
    m.points.push_back({0.9, 0.9, 0.9});
    m.triangles.push_back({m.triangles[0][0], m.triangles[0][1], static_cast<std::uint32_t>(m.points.size() - 1)});
  });
  add("meets itself", [](MeshData& m) { m = both(m, cube({0.3, 0.4, 0.2})); });
  add("lies in itself", [](MeshData& m) { m = both(m, cube({0, 0, 0}, {0.5, 0.5, 0.5})); });
  return cases;
}

}  // namespace meniscus::boolean_cases
