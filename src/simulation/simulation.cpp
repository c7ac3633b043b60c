// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/simulation/simulation.h"

#include "meniscus/operators/external_forces.h"
#include "sleep.h"

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <exception>

namespace meniscus {

Simulation::Simulation(const Scene& scene) : solids_(make_solids(scene)), drops_(make_drops(scene, solids_)) {
  options_ = make_step_options(scene);
  time_step_ = scene.time_step;
  sleep_ = scene.sleep;
  for (const Drop& drop : drops_) next_id_ = std::max(next_id_, drop.id() + 1);
}

Simulation::Simulation(const Scene& scene, std::vector<Drop> drops)
    : solids_(make_solids(scene)),
      drops_(std::move(drops)),
      options_(make_step_options(scene)),
      sleep_(scene.sleep),
      time_step_(scene.time_step) {
  for (Drop& drop : drops_) {
    find_contact(drop, solids_, time_, contact_tolerance);
    next_id_ = std::max(next_id_, drop.id() + 1);
  }
}

namespace {

void leave_asleep(Drop& drop, std::vector<Drop>& pieces, StepReport& report) {
  report.triangles = report.asleep_triangles = drop.mesh().number_of_faces();
  report.asleep = 1;
  pieces.push_back(std::move(drop));
}

}  // namespace

StepReport Simulation::step() {
  StepReport report;
  const double start = time_;
  ++num_steps_;
  time_ = static_cast<double>(num_steps_) * time_step_;
  report.volume_added = feed_.feed(drops_, solids_, start, time_, options_.band, next_id_).volume_added;
  const SleepOptions sleep = sleep_options(options_.band.edge_min, options_.band.edge_max);
  if (sleep_) wake_drops(drops_, solids_, time_, time_step_, sleep);
  std::vector<std::vector<Drop>> pieces(drops_.size());
  std::vector<StepReport> reports(drops_.size());
  std::vector<std::exception_ptr> failures(drops_.size());
  tbb::enumerable_thread_specific<Remesher> remeshers;
  tbb::parallel_for(std::size_t{0}, drops_.size(), [&](std::size_t d) {
    try {
      if (sleep_ && is_asleep(drops_[d], sleep)) {
        leave_asleep(drops_[d], pieces[d], reports[d]);
        return;
      }
      pieces[d] = step_drop(std::move(drops_[d]), solids_, time_, time_step_, options_, remeshers.local(), reports[d]);
    } catch (...) {
      failures[d] = std::current_exception();
      return;
    }
    if (sleep_)
      for (Drop& piece : pieces[d]) count_rest(piece, time_step_, reports[d].edge_operations > 0, sleep);
  });
  for (const std::exception_ptr& failure : failures)  // the first drop's, whichever thread was first
    if (failure) std::rethrow_exception(failure);

  drops_.clear();
  for (std::size_t d = 0; d < pieces.size(); ++d) {
    report += reports[d];
    for (std::size_t k = 0; k < pieces[d].size(); ++k) {
      if (k > 0) pieces[d][k].set_id(next_id_++);
      drops_.push_back(std::move(pieces[d][k]));
    }
  }
  return report;
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
