// SPDX-License-Identifier: GPL-3.0-or-later
#include "near_triangles.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace meniscus {
namespace {

using Eigen::Vector3d;

constexpr double cell_in_edges = 1, margin_in_cells = 2;
constexpr double most_cells = 1e6;

}  // namespace

NearTriangles::NearTriangles(const Eigen::AlignedBox3d& box, std::vector<Candidate> balls, double edge, Nearest nearest,
                             Find find, Distance distance)
    : balls_(std::move(balls)),
      nearest_(std::move(nearest)),
      find_(std::move(find)),
      distance_(std::move(distance)),
      size_(std::max(cell_in_edges * edge, 1e-6 * box.sizes().maxCoeff())) {
  const auto cells_along = [&] { return (box.sizes().array() / size_ + 2 * margin_in_cells).ceil(); };
  while (cells_along().prod() > most_cells) size_ *= 1.25;
  num_cells_ = cells_along().cast<int>();
  const Vector3d margin = Vector3d::Constant(margin_in_cells * size_);
  box_ = {box.min() - margin, box.max() + margin};
  cells_ = std::vector<std::atomic<const Cell*>>(static_cast<std::size_t>(num_cells_.cast<double>().prod()));
}

NearTriangles::~NearTriangles() {
  for (auto& cell : cells_) delete cell.load();
}

const NearTriangles::Cell* NearTriangles::at(const Vector3d& x) const {
  const Eigen::Array3d along = (x - box_.min()).array() / size_;
  if (!(along >= 0).all() || !(along < num_cells_.cast<double>()).all()) return nullptr;
  const Eigen::Array3i place = along.cast<int>();
  const auto index = static_cast<std::size_t>(place[0]) +
                     static_cast<std::size_t>(num_cells_[0]) *
                         (static_cast<std::size_t>(place[1]) +
                          static_cast<std::size_t>(num_cells_[1]) * static_cast<std::size_t>(place[2]));
  const Cell* cell = cells_[index].load(std::memory_order_acquire);
  if (cell != nullptr) return cell;
  const Cell* made = make(box_.min() + size_ * (place.cast<double>() + 0.5).matrix());
  if (cells_[index].compare_exchange_strong(cell, made, std::memory_order_acq_rel)) return made;
  delete made;  // another thread was first
  return cell;
}

/// A point of the cell is within r of its middle, so the surface is within d + r of it, d the middle's distance, and
/// the nearest triangle within d + 2 r of the middle.
const NearTriangles::Cell* NearTriangles::make(const Vector3d& center) const {
  constexpr double rounding = 1e-9;
  auto cell = std::make_unique<Cell>();
  cell->middle = center;
  const double r = 0.5 * std::sqrt(3.0) * size_, signed_distance = nearest_(center), d = std::abs(signed_distance);
  cell->clearance = std::max(0.0, signed_distance * (1 - rounding) - r);
  if (d > 2 * r) return cell.release();
  const double reach = (d + 2 * r) * (1 + rounding);
  std::vector<std::uint32_t> found;
  find_(center, reach, found);
  std::vector<std::pair<double, std::uint32_t>> order;
  for (const auto t : found) {
    const double distance = distance_(center, t);
    if (distance <= reach) order.emplace_back(distance, t);
  }
  std::sort(order.begin(), order.end());
  for (const auto& [distance, t] : order) {
    cell->candidates.push_back(balls_[t]);
    cell->candidates.back().from_middle = distance * (1 - rounding);
  }
  return cell.release();
}

}  // namespace meniscus
