// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/state/contact_line.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>

namespace meniscus {
namespace {

using Eigen::Vector3d;

/// A face of three colliding vertices (v is one) lies on the solid if it faces into it: by the mean of its
/// three normals, for on a face that reaches over an edge one alone may be at right angles to it.
bool is_wetted(const Drop& drop, std::uint32_t v, std::uint32_t a, std::uint32_t b, const Vector3d& area_vector) {
  const Contact* contact = drop.contact();
  if (!is_colliding(contact[a]) || !is_colliding(contact[b])) return false;
  const ConstColumns n = drop.contact_normals();
  return area_vector.dot(n.col(v) + n.col(a) + n.col(b)) < 0;
}

/// The half cotangent sum that triangle (v, a, b) adds to L_vv: |b - a|^2 / (4 area).
double stiffness_of(const Vector3d& opposite_edge, double area) {
  return area > 0 ? opposite_edge.squaredNorm() / (4 * area) : 0;
}

}  // namespace

bool contact_normals_differ(const Drop& drop, double distance) {
  const Contact* contact = drop.contact();
  const ConstColumns n = drop.contact_normals();
  const auto rows = static_cast<std::uint32_t>(drop.num_rows());
  std::uint32_t first = 0;
  while (first < rows && !is_colliding(contact[first])) ++first;
  for (std::uint32_t v = first; v < rows; ++v)
    if (is_colliding(contact[v]) && (n.col(v) - n.col(first)).squaredNorm() > distance * distance) return true;
  return false;
}

void mark_contact_line(Drop& drop) {
  Contact* contact = drop.contact();
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i) {
    if (contact[i] == Contact::free) continue;
    const Ring ring = drop.connectivity().ring(i);
    const auto is_free = [&](std::uint32_t neighbour) { return contact[neighbour] == Contact::free; };
    if (std::any_of(ring.neighbour, ring.neighbour + ring.degree, is_free)) contact[i] = Contact::line;
  }
}

std::optional<ContactLineVertex> contact_line_vertex(const Drop& drop, std::uint32_t v) {
  const ConstColumns x = drop.positions();
  const Vector3d normal = drop.contact_normals().col(v), p = x.col(v);
  const Ring ring = drop.connectivity().ring(v);
  Vector3d wet_gradient = Vector3d::Zero(), air_gradient = Vector3d::Zero(), air_normal = Vector3d::Zero();
  ContactLineVertex line{};
  line.neighbours = {v, v};
  int num_ends = 0;
  bool was_wet = false, first_is_wet = false;
  const auto end_at = [&](int k) {
    if (num_ends++ < 2) line.neighbours[static_cast<std::size_t>(num_ends - 1)] = ring.neighbour[k];
  };
  for (int k = 0; k < ring.degree; ++k) {
    const std::uint32_t a = ring.neighbour[k], b = ring.neighbour[k + 1 == ring.degree ? 0 : k + 1];
    const Vector3d opposite = x.col(b) - x.col(a);
    const Vector3d area_vector = 0.5 * (x.col(a) - p).cross(x.col(b) - p);
    const bool wet = is_wetted(drop, v, a, b, area_vector);
    if (k == 0) first_is_wet = wet;
    if (k > 0 && wet != was_wet) end_at(k);
    was_wet = wet;
    const double area = area_vector.norm();
    if (!(area > 0)) continue;
    if (wet) {
      wet_gradient += 0.5 * opposite.cross(normal);  // of its area, at v, as far as it goes along the solid there
    } else {
      air_gradient += 0.5 / area * area_vector.cross(opposite);  // of its area, at v
      air_normal += area_vector;
      line.stiffness += stiffness_of(opposite, area);
    }
  }
  if (first_is_wet != was_wet) end_at(0);
  line.length = wet_gradient.norm();
  if (!(line.length > 0) || !(air_normal.norm() > 0)) return std::nullopt;
  line.outward = wet_gradient / line.length;
  line.angle_cosine = std::clamp(air_normal.normalized().dot(normal), -1.0, 1.0);
  line.volume_gradient = air_normal.dot(line.outward) / 3;
  line.energy_cosine = air_gradient.dot(line.outward) / line.length;
  const Vector3d to = p - x.col(line.neighbours[0]), from = x.col(line.neighbours[1]) - p;
  const double lengths = to.norm() * from.norm();
  line.turn_cosine = num_ends == 2 && lengths > 0 ? to.dot(from) / lengths : 1;
  return line;
}

std::optional<double> mean_contact_angle(const Drop& drop) {
  double sum = 0, length = 0;
  for (std::uint32_t v = 0; v < drop.num_rows(); ++v) {
    if (drop.contact()[v] != Contact::line) continue;
    if (const auto line = contact_line_vertex(drop, v)) {
      sum += line->length * line->angle();
      length += line->length;
    }
  }
  if (!(length > 0)) return std::nullopt;
  return sum / length;
}

double wetted_area(const Drop& drop) {
  const ConstColumns x = drop.positions();
  const Contact* contact = drop.contact();
  if (!touches_solid(drop)) return 0;
  double area = 0;
  for (const auto& [a, b, c] : drop.connectivity().triangles()) {
    if (a == Connectivity::removed || !is_colliding(contact[a])) continue;
    const Vector3d area_vector = 0.5 * (x.col(b) - x.col(a)).cross(x.col(c) - x.col(a));
    if (is_wetted(drop, a, b, c, area_vector)) area += area_vector.norm();
  }
  return area;
}

}  // namespace meniscus
