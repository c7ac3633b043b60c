// SPDX-License-Identifier: GPL-3.0-or-later
#include "fold_finder.h"
#include "meniscus/state/offset_to_volume.h"
#include "merge_parts.h"

#include <cmath>

namespace meniscus {
namespace {

/// How much of an offset each vertex takes: none on solids and of those that are `held`, all from three edges away from
/// them.
std::vector<double> shares_of_offset(const Drop& drop, const std::vector<std::uint32_t>& held) {
  constexpr int edges = 3;
  std::vector<double> share(drop.num_rows(), 1);
  std::vector<std::uint32_t> front = held, next;
  for (const auto v : front) share[v] = 0;
  for (int k = 1; k < edges; ++k, front.swap(next)) {
    next.clear();
    for (const auto v : front) {
      const Ring ring = drop.connectivity().ring(v);
      for (int i = 0; i < ring.degree; ++i) {
        double& near = share[ring.neighbour[i]];
        if (near < 1) continue;
        near = static_cast<double>(k) / edges;
        next.push_back(ring.neighbour[i]);
      }
    }
  }
  for (std::uint32_t v = 0; v < drop.num_rows(); ++v)
    if (!is_off_solids(drop, v)) share[v] = 0;
  return share;
}

/// Moves each vertex by its share of d along its normal, from `before`.
void offset(Drop& drop, const SurfaceGeometry& geometry, const std::vector<double>& share,
            const Eigen::Matrix3Xd& before, double d) {
  for (std::uint32_t v = 0; v < drop.num_rows(); ++v)
    if (share[v] > 0) drop.positions().col(v) = before.col(v) + d * share[v] * geometry.normal(v);
}

/// Moves the vertices by the d at which the drop encloses `volume`, found by secants. False if it is more than `most`:
/// a surface that went so far would come out of another side.
bool find_offset(Drop& drop, const SurfaceGeometry& geometry, const std::vector<double>& share,
                 const Eigen::Matrix3Xd& before, double volume, double most) {
  constexpr int rounds = 4;
  constexpr double enough = 1e-9;
  double area = 0, d = 0, missing = volume - geometry.volume();
  for (std::uint32_t v = 0; v < drop.num_rows(); ++v)
    if (share[v] > 0) area += share[v] * geometry.area_vector(v).dot(geometry.normal(v)) / 3;
  for (int k = 0; k < rounds && std::abs(missing) > enough * volume && area > 0; ++k) {
    const double more = missing / area, missing_old = missing;
    d += more;
    if (!(std::abs(d) <= most)) return false;
    offset(drop, geometry, share, before, d);
    missing = volume - drop.volume();
    area = (missing_old - missing) / more;
  }
  return true;
}

/// Takes vertices of faces that meet back to where they were `before`, until none meet; adds them to `held`. False if
/// that does not end.
bool take_back_meeting(Drop& drop, const Eigen::Matrix3Xd& before, const WatchedRegion& region,
                       std::vector<std::uint32_t>& held) {
  FoldFinder finder(drop, region.faces_of(drop));
  while (!finder.meeting().empty()) {
    const std::size_t count = held.size();
    for (const auto& pair : finder.meeting())
      for (const auto face : pair)
        for (const auto v : drop.connectivity().triangles()[face]) {
          if (drop.positions().col(v) == before.col(v)) continue;
          drop.positions().col(v) = before.col(v);
          held.push_back(v);
        }
    if (held.size() == count) return false;  // they met before
    for (std::size_t k = count; k < held.size(); ++k) finder.move(held[k]);
  }
  return true;
}

}  // namespace

void offset_around(Drop& drop, std::vector<std::uint32_t> held, double volume, const WatchedRegion& region) {
  constexpr int most_rounds = 4;
  // Where some vertices had to be taken back, so much may be left of the error, and of the volume.
  constexpr double enough = 0.25, most_left = 0.005;
  const double most = 0.5 * std::cbrt(0.75 * volume / M_PI);
  SurfaceGeometry geometry;
  geometry.compute(std::as_const(drop).positions(), drop.connectivity());
  const Eigen::Matrix3Xd before = drop.positions();
  const double error_before = std::abs(geometry.volume() - volume);
  for (int round = 1; round <= most_rounds; ++round) {
    const std::size_t count = held.size();
    const bool is_sound = find_offset(drop, geometry, shares_of_offset(drop, held), before, volume, most) &&
                          take_back_meeting(drop, before, region, held);
    const double error = std::abs(drop.volume() - volume);
    if (is_sound && (held.size() == count || error <= std::min(enough * error_before, most_left * volume))) return;
    if (is_sound && round == most_rounds && error < error_before) return;
    drop.positions() = before;
    if (!is_sound) return;
  }
}

void restore_volume(Drop& drop, double volume, double edge_max) {
  offset_around(drop, {}, volume, guarded_region(drop, edge_max));
}

}  // namespace meniscus
