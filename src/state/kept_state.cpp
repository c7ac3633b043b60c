// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/state/drop.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace meniscus {
namespace {

void copy(const ConstColumns& from, std::vector<double>& to) { to.assign(from.data(), from.data() + from.size()); }

void copy(const std::vector<double>& from, Columns to) { std::copy(from.begin(), from.end(), to.data()); }

}  // namespace

void KeptState::keep(Drop& drop) {
  const std::size_t n = drop.num_rows();
  rows_ = static_cast<Eigen::Index>(n);
  copy(std::as_const(drop).positions(), positions_);
  copy(std::as_const(drop).velocities(), velocities_);
  target_volume_ = drop.target_volume();
  touched_ = touches_solid(drop);
  if (!touched_) return;
  copy(std::as_const(drop).contact_normals(), contact_normals_);
  contact_.assign(drop.contact(), drop.contact() + n);
  contact_solid_.assign(drop.contact_solid(), drop.contact_solid() + n);
  line_status_.assign(drop.line_statuses(), drop.line_statuses() + n);
}

void KeptState::restore(Drop& drop) const {
  copy(positions_, drop.positions());
  copy(velocities_, drop.velocities());
  drop.displacements().setZero();  // a solve starts there, no more
  drop.set_target_volume(target_volume_);
  drop.set_slack(0);
  if (!touched_) {
    std::fill_n(drop.contact(), drop.num_rows(), Contact::free);
    std::fill_n(drop.contact_solid(), drop.num_rows(), -1);
    std::fill_n(drop.line_statuses(), drop.num_rows(), std::uint8_t{0});
    return;
  }
  copy(contact_normals_, drop.contact_normals());
  std::copy(contact_.begin(), contact_.end(), drop.contact());
  std::copy(contact_solid_.begin(), contact_solid_.end(), drop.contact_solid());
  std::copy(line_status_.begin(), line_status_.end(), drop.line_statuses());
}

bool KeptState::has_contact_of(const Drop& drop) const {
  if (!touched_) return !touches_solid(drop);
  return std::equal(contact_.begin(), contact_.end(), drop.contact());
}

double KeptState::moved(const Drop& drop, double limit) const {
  const ConstColumns now = drop.positions(), before = positions();
  double most2 = 0;
  for (Eigen::Index i = 0; i < rows_; ++i) {
    const double moved2 = (now.col(i) - before.col(i)).squaredNorm();
    if (!(moved2 <= limit * limit)) return std::numeric_limits<double>::infinity();  // a NaN, too
    most2 = std::max(most2, moved2);
  }
  return std::sqrt(most2);
}

}  // namespace meniscus
