// SPDX-License-Identifier: GPL-3.0-or-later
#include "watched_region.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace meniscus {
namespace {

using Eigen::Vector3d;

/// So that a drop that blew up does not ask for a cell for each point of space.
constexpr double most_cells_along = 1e6, most_cells = 4e6;

/// What a cell holds.
constexpr std::uint8_t outside = 0, beside_watched = 1, watched = 2;

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
  Eigen::AlignedBox3d box;
  const auto for_each_watched = [&](auto visit) {
    for (std::uint32_t v = 0; v < drop.num_rows(); ++v)
      if (watch[v] != 0 && drop.connectivity().degree(v) > 0) visit(Vector3d(x.col(v)));
  };
  for_each_watched([&](const Vector3d& point) { box.extend(point); });
  if (box.isEmpty()) return;
  const double size = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
  per_length_ = 1 / std::max(reach, size / most_cells_along);
  const auto fit = [&] {
    low_ = (box.min().array() * per_length_).floor() - 1;
    size_ = (box.max().array() * per_length_).floor() + 2 - low_;
    return size_.prod();
  };
  while (fit() > most_cells) per_length_ /= 2;
  cells_.assign(static_cast<std::size_t>(size_.prod()), outside);
  for_each_watched([&](const Vector3d& point) {
    const Eigen::Array3d home = cell(point);
    if (std::exchange(cells_[index(home)], watched) == watched) return;
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j)
        for (int k = -1; k <= 1; ++k) {
          std::uint8_t& near = cells_[index(home + Eigen::Array3d(i, j, k))];
          near = std::max(near, beside_watched);
        }
  });
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
