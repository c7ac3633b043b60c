// SPDX-License-Identifier: GPL-3.0-or-later
#include "watched_region.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace meniscus {
namespace {

using Eigen::Vector3d;

/// So that a drop that blew up does not ask for a cell for each point of space.
constexpr double most_cells_along = 1e6;

}  // namespace

bool ContactSlab::reaches_into(const Vector3d& a, const Vector3d& b, const Vector3d& c) const {
  return (up.dot(a) <= top || up.dot(b) <= top || up.dot(c) <= top) &&
         box.intersects(Eigen::AlignedBox3d(a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)));
}

ContactSlab contact_slab(const Drop& drop) {
  constexpr double rounding = 1e-9;
  const ConstColumns x = drop.positions(), n = drop.contact_normals();
  ContactSlab slab;
  const auto for_each_colliding = [&](auto visit) {
    for (std::uint32_t v = 0; v < drop.num_rows(); ++v)
      if (is_colliding(drop.contact()[v]) && drop.connectivity().degree(v) > 0) visit(v);
  };
  for_each_colliding([&](std::uint32_t v) {
    slab.box.extend(Vector3d(x.col(v)));
    slab.up += n.col(v);
  });
  if (slab.box.isEmpty()) return slab;
  slab.up.stableNormalize();
  slab.top = -std::numeric_limits<double>::infinity();
  for_each_colliding([&](std::uint32_t v) { slab.top = std::max(slab.top, slab.up.dot(x.col(v))); });
  slab.top += rounding * slab.box.diagonal().norm();
  return slab;
}

WatchedRegion::WatchedRegion(const Drop& drop, double reach) {
  const ConstColumns x = drop.positions();
  const std::uint8_t* watch = drop.seam_watch();
  const auto is_watched = [&](std::uint32_t v) { return watch[v] != 0 && drop.connectivity().degree(v) > 0; };
  double size = 0;
  for (std::uint32_t v = 0; v < drop.num_rows(); ++v)
    if (is_watched(v)) size = std::max(size, x.col(v).cwiseAbs().maxCoeff());
  per_length_ = 1 / std::max(reach, size / most_cells_along);
  std::unordered_set<Cell, Hash> watched;
  for (std::uint32_t v = 0; v < drop.num_rows(); ++v)
    if (is_watched(v)) watched.insert(cell(x.col(v)));
  for (const Cell& c : watched)
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j)
        for (int k = -1; k <= 1; ++k) cells_.insert({c[0] + i, c[1] + j, c[2] + k});
}

WatchedRegion::Cell WatchedRegion::cell(const Vector3d& x) const {
  return {static_cast<std::int64_t>(std::floor(x[0] * per_length_)),
          static_cast<std::int64_t>(std::floor(x[1] * per_length_)),
          static_cast<std::int64_t>(std::floor(x[2] * per_length_))};
}

std::vector<FaceBox> WatchedRegion::faces_of(const Drop& drop) const {
  const ConstColumns x = drop.positions();
  std::vector<std::uint8_t> is_covered(drop.num_rows(), static_cast<std::uint8_t>(is_everywhere_));
  for (std::uint32_t v = 0; v < drop.num_rows() && !cells_.empty(); ++v) is_covered[v] = covers(Vector3d(x.col(v)));
  std::vector<FaceBox> faces;
  const auto& triangles = drop.connectivity().triangles();
  for (std::uint32_t f = 0; f < triangles.size(); ++f) {
    const auto& [a, b, c] = triangles[f];
    if (a == Connectivity::removed) continue;
    const Vector3d p = x.col(a), q = x.col(b), r = x.col(c);
    if ((is_covered[a] | is_covered[b] | is_covered[c]) == 0 && !slab_.reaches_into(p, q, r)) continue;
    faces.push_back({{p.cwiseMin(q).cwiseMin(r), p.cwiseMax(q).cwiseMax(r)}, f});
  }
  return faces;
}

WatchedRegion watched_region(const Drop& drop, double edge_max) {
  constexpr double reach_in_edges = 2;
  return {drop, reach_in_edges * edge_max};
}

WatchedRegion guarded_region(const Drop& drop, double edge_max) {
  WatchedRegion region = watched_region(drop, edge_max);
  region.add(contact_slab(drop));
  return region;
}

}  // namespace meniscus
