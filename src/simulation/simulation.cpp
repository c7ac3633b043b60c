// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/simulation/simulation.h"

#include "meniscus/core/error.h"
#include "meniscus/operators/external_forces.h"
#include "meniscus/simulation/check_frame.h"
#include "sleep.h"
#include "step_parts.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <iterator>
#include <optional>

namespace meniscus {

Simulation::Simulation(const Scene& scene) : solids_(make_solids(scene)), drops_(make_drops(scene, solids_)) {
  options_ = make_step_options(scene);
  is_chosen_ = scene.accuracy.has_value();
  time_step_ = scene.time_step;
  sleep_ = scene.sleep;
  for (const Drop& drop : drops_) next_id_ = std::max(next_id_, drop.id() + 1);
  take_choice(choose_model(scene, drops_, solids_));
}

Simulation::Simulation(const Scene& scene, std::vector<Drop> drops)
    : solids_(make_solids(scene)),
      drops_(std::move(drops)),
      options_(make_step_options(scene)),
      is_chosen_(scene.accuracy.has_value()),
      sleep_(scene.sleep),
      time_step_(scene.time_step) {
  for (Drop& drop : drops_) {
    find_contact(drop, solids_, time_, contact_tolerance);
    next_id_ = std::max(next_id_, drop.id() + 1);
  }
  take_choice(choose_model(scene, drops_, solids_));
}

void Simulation::take_choice(ModelChoice choice) {
  choice_ = std::move(choice);
  options_.level = choice_.level;
  options_.volume_correction = choice_.volume_correction;
  options_.solver.method = choice_.solver_method;
  options_.solver.tolerance = choice_.solver_tolerance;
}

namespace {

/// Up to this many rows a drop borrows its working arrays: those of all drops together would fill the cache.
constexpr std::size_t most_rows_to_lend_to = 16384;

/// Drops that approach each other take a step in at most so many parts.
constexpr double most_parts = 64;

/// Working arrays that a drop has for as long as this lives.
class Loan {
 public:
  Loan(Drop& drop, Workspace& workspace) : drop_(drop) {
    workspace.solver.forget();
    drop.lend_workspace(&workspace);
  }
  Loan(const Loan&) = delete;
  Loan& operator=(const Loan&) = delete;
  ~Loan() { drop_.lend_workspace(nullptr); }

 private:
  Drop& drop_;
};

}  // namespace

StepReport Simulation::step() {
  const auto substeps = static_cast<std::size_t>(choice_.substeps), first = num_steps_ * substeps;
  ++num_steps_;
  StepReport report;
  for (std::size_t k = 1; k <= substeps; ++k) {
    const double start = time_;
    // The end of a step does not depend on how it was cut.
    time_ = k == substeps ? static_cast<double>(num_steps_) * time_step_
                          : static_cast<double>(first + k) * substep_length();
    const StepReport of_substep = take_substep(start);
    report += of_substep;
    report.triangles = of_substep.triangles;
    report.asleep_triangles = of_substep.asleep_triangles;
  }
  return report;
}

StepReport Simulation::take_substep(double start) {
  const double target_volume_before = target_volume();
  StepReport report;
  report.volume_added = feed_.feed(drops_, solids_, start, time_, options_.band, next_id_).volume_added;
  if (sleep_) wake_drops(drops_, solids_, time_, substep_length(), sleep_options(options_.band));
  step_all(report);
  if (options_.merge) merge(drops_, places_, report);
  report.triangles = 0;
  for (Drop& drop : drops_) {
    if (drop.id() == no_id) drop.set_id(next_id_++);
    report.triangles += drop.mesh().number_of_faces();
  }
  if (report.deleted > 0) share_volume(target_volume_before + report.volume_added - target_volume());
  if (options_.verify == Verify::everything) verify(report, target_volume_before);
  return report;
}

void Simulation::step_all(StepReport& report) {
  tasks_.resize(drops_.size());
  for (Task& task : tasks_) {
    task.cluster = nullptr;
    task.goes_on = true;
    task.others.clear();
    task.report = StepReport();
    task.failure = nullptr;
  }
  if (options_.merge && drops_.size() > 1)
    for (const auto& cluster : approach_.find_clusters(drops_, substep_length(), options_.band.edge_max))
      for (const std::uint32_t d : cluster) tasks_[d].cluster = &cluster;
  tbb::parallel_for(std::size_t{0}, drops_.size(), [&](std::size_t d) {
    Task& task = tasks_[d];
    if (task.cluster != nullptr && task.cluster->front() != d) return;
    try {
      if (task.cluster != nullptr)
        task.others = step_cluster(*task.cluster, task.report);
      else
        task.goes_on = step_one(drops_[d], task.others, time_, substep_length(), task.report);
    } catch (...) {
      task.failure = std::current_exception();
    }
  });
  bool are_same = true;
  for (const Task& task : tasks_) {
    if (task.failure) std::rethrow_exception(task.failure);  // the first drop's, whichever thread was first
    report += task.report;
    are_same = are_same && task.cluster == nullptr && task.goes_on && task.others.empty();
  }
  if (are_same) return;
  std::vector<Drop> next;
  for (std::size_t d = 0; d < drops_.size(); ++d) {
    if (tasks_[d].cluster == nullptr && tasks_[d].goes_on) next.push_back(std::move(drops_[d]));
    std::move(tasks_[d].others.begin(), tasks_[d].others.end(), std::back_inserter(next));
  }
  drops_ = std::move(next);
}

bool Simulation::step_one(Drop& drop, std::vector<Drop>& cut_off, double time, double dt, StepReport& report) {
  const SleepOptions sleep = sleep_options(options_.band);
  if (sleep_ && is_asleep(drop, sleep)) {
    report.asleep_triangles += drop.mesh().number_of_faces();
    ++report.asleep;
    return true;
  }
  std::optional<Loan> loan;
  if (drop.num_rows() <= most_rows_to_lend_to && drops_.size() > 1) loan.emplace(drop, workspaces_.local());
  StepReport of_drop;
  const std::size_t first = cut_off.size();
  const bool goes_on = step_in_place(drop, cut_off, solids_, time, dt, options_, remeshers_.local(), of_drop);
  report += of_drop;
  const auto count = [&](Drop& piece) {
    if (sleep_) count_rest(piece, dt, of_drop.edge_operations > 0, sleep);
  };
  if (goes_on) count(drop);
  for (std::size_t p = first; p < cut_off.size(); ++p) {
    count(cut_off[p]);
    cut_off[p].set_id(no_id);
  }
  return goes_on;
}

std::vector<Drop> Simulation::step_cluster(const std::vector<std::uint32_t>& cluster, StepReport& report) {
  std::vector<Drop> drops;
  drops.reserve(cluster.size());
  for (const std::uint32_t d : cluster) drops.push_back(std::move(drops_[d]));
  BroadPhase broad_phase;
  const double shortest = substep_length() / most_parts;
  double left = substep_length();
  while (left > 0) {
    double dt = std::max(longest_step(drops, left, options_.band.edge_max), shortest);
    if (left - dt < 0.5 * shortest) dt = left;
    left -= dt;
    std::vector<Drop> next;
    for (Drop& drop : drops) {
      std::vector<Drop> cut_off;
      if (step_one(drop, cut_off, time_ - left, dt, report)) next.push_back(std::move(drop));
      std::move(cut_off.begin(), cut_off.end(), std::back_inserter(next));
    }
    drops = std::move(next);
    if (left > 0) merge(drops, broad_phase, report);
  }
  return drops;
}

void Simulation::merge(std::vector<Drop>& drops, BroadPhase& broad_phase, StepReport& report) {
  const double start = options_.clock ? options_.clock() : 0;
  report += merge_touching_drops(drops, broad_phase, merge_options(options_), remeshers_);
  if (options_.clock) report.stage_seconds[static_cast<std::size_t>(Stage::merge)] += options_.clock() - start;
}

void Simulation::share_volume(double lost) {
  const double volume = target_volume();
  if (!(volume > 0)) return;
  for (Drop& drop : drops_) drop.set_target_volume(drop.target_volume() * (1 + lost / volume));
}

void Simulation::finish_restored() {
  check_contacts();
  const ModelChoice& c = choice_;
  if (c.level > Level::pressure || c.volume_correction > VolumeCorrectionMethod::local_then_global ||
      c.solver_method > SolverMethod::cholesky || c.substeps < 1 || c.substeps > 1000 || !(c.solver_tolerance > 0) ||
      !(c.solver_tolerance < 1))
    throw FileError("the choice of a model is none; the checkpoint is damaged");
  take_choice(choice_);
}

void Simulation::check_contacts() const {
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
    if (const std::string defect = unsoundness(drop); !defect.empty())
      throw SoundnessError(fmt::format("drop {} is unsound after step {}: {}", drop.id(), num_steps_, defect));
  }
  const double lost = target_volume_before + report.volume_added - target_volume();
  if (!drops_.empty() && std::abs(lost) > 1e-9 * (target_volume_before + report.volume_added))
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
