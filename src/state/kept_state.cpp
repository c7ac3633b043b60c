// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/state/drop.h"

#include <algorithm>

namespace meniscus {

void KeptState::keep(Drop& drop) {
  const std::size_t n = drop.num_rows();
  positions_ = drop.positions();
  velocities_ = drop.velocities();
  target_volume_ = drop.target_volume();
  touched_ = touches_solid(drop);
  if (!touched_) return;
  contact_normals_ = drop.contact_normals();
  contact_.assign(drop.contact(), drop.contact() + n);
  contact_solid_.assign(drop.contact_solid(), drop.contact_solid() + n);
  line_status_.assign(drop.line_statuses(), drop.line_statuses() + n);
}

void KeptState::restore(Drop& drop) const {
  drop.positions() = positions_;
  drop.velocities() = velocities_;
  drop.displacements().setZero();  // a solve starts there, no more
  drop.set_target_volume(target_volume_);
  if (!touched_) {
    std::fill_n(drop.contact(), drop.num_rows(), Contact::free);
    std::fill_n(drop.contact_solid(), drop.num_rows(), -1);
    std::fill_n(drop.line_statuses(), drop.num_rows(), std::uint8_t{0});
    return;
  }
  drop.contact_normals() = contact_normals_;
  std::copy(contact_.begin(), contact_.end(), drop.contact());
  std::copy(contact_solid_.begin(), contact_solid_.end(), drop.contact_solid());
  std::copy(line_status_.begin(), line_status_.end(), drop.line_statuses());
}

}  // namespace meniscus
