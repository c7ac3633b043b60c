// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/simulation/simulation.h"

#include "meniscus/core/error.h"
#include "meniscus/operators/external_forces.h"
#include "meniscus/state/judge.h"

#include <fmt/format.h>
#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <exception>

namespace meniscus {

Simulation::Simulation(const Scene& scene) : solids_(make_solids(scene)), drops_(make_drops(scene, solids_)) {
  options_ = make_step_options(scene);
  time_step_ = scene.time_step;
  for (const Drop& drop : drops_) next_id_ = std::max(next_id_, drop.id() + 1);
}

Simulation::Simulation(const Scene& scene, std::vector<Drop> drops)
    : solids_(make_solids(scene)),
      drops_(std::move(drops)),
      options_(make_step_options(scene)),
      time_step_(scene.time_step) {
  for (Drop& drop : drops_) {
    find_contact(drop, solids_, time_, contact_tolerance);
    next_id_ = std::max(next_id_, drop.id() + 1);
  }
}

StepReport Simulation::step() {
  const double target_volume_before = target_volume();
  ++num_steps_;
  time_ = static_cast<double>(num_steps_) * time_step_;
  std::vector<std::vector<Drop>> pieces(drops_.size());
  std::vector<StepReport> reports(drops_.size());
  std::vector<std::exception_ptr> failures(drops_.size());
  tbb::enumerable_thread_specific<Remesher> remeshers;
  tbb::parallel_for(std::size_t{0}, drops_.size(), [&](std::size_t d) {
    try {
      pieces[d] = step_drop(std::move(drops_[d]), solids_, time_, time_step_, options_, remeshers.local(), reports[d]);
    } catch (...) {
      failures[d] = std::current_exception();
    }
  });
  for (const std::exception_ptr& failure : failures)  // the first drop's, whichever thread was first
    if (failure) std::rethrow_exception(failure);

  StepReport report;
  drops_.clear();
  for (std::size_t d = 0; d < pieces.size(); ++d) {
    report += reports[d];
    for (std::size_t k = 0; k < pieces[d].size(); ++k) {
      if (k > 0) pieces[d][k].set_id(next_id_++);
      drops_.push_back(std::move(pieces[d][k]));
    }
  }
  if (options_.verify == Verify::everything) verify(report, target_volume_before);
  return report;
}

void Simulation::check_restored() const {
  for (const Drop& drop : drops_)
    for (std::size_t v = 0; v < drop.num_rows(); ++v) {
      const auto solid = static_cast<std::int64_t>(drop.contact_solid()[v]);
      if (is_colliding(drop.contact()[v]) && (solid < 0 || solid >= static_cast<std::int64_t>(solids_.size())))
        throw FileError(fmt::format("drop {}: vertex {} touches solid {}, but there are {}; the checkpoint is damaged",
                                    drop.id(), v, solid, solids_.size()));
    }
}

void Simulation::verify(const StepReport& report, double target_volume_before) const {
  for (const Drop& drop : drops_) {
    std::string defect = judge::defect(drop);
    if (defect.empty() && !drop.velocities().allFinite()) defect = "a velocity is not finite";
    if (!defect.empty())
      throw SoundnessError(fmt::format("drop {} is unsound after step {}: {}", drop.id(), num_steps_, defect));
  }
  const double lost = target_volume_before - target_volume();
  if (report.deleted == 0 && std::abs(lost) > 1e-9 * target_volume_before)
    throw SoundnessError(fmt::format("step {} lost {} of {} cm^3", num_steps_, lost, target_volume_before));
}

double Simulation::volume() const {
  double volume = 0;
  for (const Drop& drop : drops_) volume += drop.volume();
  return volume;
}

double Simulation::target_volume() const {
  double volume = 0;
  for (const Drop& drop : drops_) volume += drop.target_volume();
  return volume;
}

}  // namespace meniscus
