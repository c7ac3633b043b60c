// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/frames/measures.h"

#include "meniscus/state/contact_line.h"
#include "meniscus/state/ledger.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace meniscus {
namespace {

using Eigen::Vector3d;

constexpr double degrees = 180 / 3.14159265358979323846;

/// Calls visit(a, b, c) for each face that is there.
template <class Visit>
void for_each_face(const Drop& drop, Visit visit) {
  for (const auto& [a, b, c] : drop.connectivity().triangles())
    if (a != Connectivity::removed) visit(a, b, c);
}

Vector3d area_vector(const ConstColumns& x, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  return 0.5 * (x.col(b) - x.col(a)).cross(x.col(c) - x.col(a));
}

double angle_between(const Vector3d& u, const Vector3d& v) { return std::atan2(u.cross(v).norm(), u.dot(v)); }

double least_angle_of(const Vector3d& p, const Vector3d& q, const Vector3d& r) {
  return std::min({angle_between(q - p, r - p), angle_between(r - q, p - q), angle_between(p - r, q - r)});
}

void measure_edges_and_angles(const Drop& drop, DropMeasures& measures) {
  const ConstColumns x = drop.positions();
  double sum = 0, least = std::numeric_limits<double>::infinity(), shortest = least, longest = 0;
  std::size_t edges = 0;
  for_each_face(drop, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    least = std::min(least, least_angle_of(x.col(a), x.col(b), x.col(c)));
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
      if (from > to) continue;  // the other face's turn
      const double length = (x.col(to) - x.col(from)).norm();
      shortest = std::min(shortest, length);
      longest = std::max(longest, length);
      sum += length;
      ++edges;
    }
  });
  if (edges == 0) return;
  measures.edge_min = shortest;
  measures.edge_mean = sum / static_cast<double>(edges);
  measures.edge_max = longest;
  measures.least_angle = least;
}

bool is_wetted(const Drop& drop, const Vector3d& area, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const Contact* contact = drop.contact();
  if (!is_colliding(contact[a]) || !is_colliding(contact[b]) || !is_colliding(contact[c])) return false;
  const ConstColumns normal = drop.contact_normals();
  return area.dot(normal.col(a) + normal.col(b) + normal.col(c)) < 0;
}

}  // namespace

DropMeasures measure_drop(const Drop& drop, double density) {
  DropMeasures measures;
  measures.drop = drop.id();
  measures.volume = drop.volume();
  measures.target_volume = drop.target_volume();
  measures.centroid = volume_centroid(drop);
  measures.momentum = surface_momentum(drop, density, measures.centroid);
  measures.mean_contact_angle = mean_contact_angle(drop);
  const ConstColumns x = drop.positions();
  for_each_face(drop, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const Vector3d area = area_vector(x, a, b, c);
    measures.area += area.norm();
    if (is_wetted(drop, area, a, b, c)) measures.wetted_area += area.norm();
    ++measures.triangles;
  });
  measure_edges_and_angles(drop, measures);
  return measures;
}

std::string measures_header() {
  return "time,drop,volume,target_volume,area,wetted_area,centroid_x,centroid_y,centroid_z,momentum_x,momentum_y,"
         "momentum_z,mean_contact_angle_deg,triangles,edge_min,edge_mean,edge_max,least_angle_deg\n";
}

std::string measures_row(double time, const DropMeasures& m) {
  std::string row = fmt::format("{:.17g},{}", time, m.drop);
  const auto add = [&](double value) { fmt::format_to(std::back_inserter(row), ",{:.17g}", value); };
  for (const double value : {m.volume, m.target_volume, m.area, m.wetted_area}) add(value);
  for (int k = 0; k < 3; ++k) add(m.centroid[k]);
  for (int k = 0; k < 3; ++k) add(m.momentum[k]);
  if (m.mean_contact_angle)
    add(*m.mean_contact_angle * degrees);
  else
    row += ',';
  fmt::format_to(std::back_inserter(row), ",{}", m.triangles);
  for (const double value : {m.edge_min, m.edge_mean, m.edge_max, m.least_angle * degrees}) add(value);
  return row + '\n';
}

}  // namespace meniscus
