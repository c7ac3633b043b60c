// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/simulation/simulation.h"

#include "meniscus/core/error.h"
#include "meniscus/operators/external_forces.h"
#include "meniscus/simulation/approaching.h"
#include "meniscus/simulation/check_frame.h"
#include "sleep.h"
#include "step_parts.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <exception>
#include <iterator>

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
  std::vector<Cluster> clusters;
  if (options_.merge && drops_.size() > 1)
    clusters = clusters_of_approaching_drops(drops_, substep_length(), options_.band.edge_max, paths_);
  else
    for (std::uint32_t d = 0; d < drops_.size(); ++d) clusters.push_back({{d}, 1});
  std::vector<std::vector<Drop>> results(clusters.size());
  std::vector<StepReport> reports(clusters.size());
  std::vector<std::exception_ptr> failures(clusters.size());
  tbb::parallel_for(std::size_t{0}, clusters.size(), [&](std::size_t c) {
    try {
      std::vector<Drop> drops;
      for (const std::uint32_t d : clusters[c].drops) drops.push_back(std::move(drops_[d]));
      results[c] = step_cluster(std::move(drops), clusters[c].substeps, reports[c]);
    } catch (...) {
      failures[c] = std::current_exception();
    }
  });
  for (const std::exception_ptr& failure : failures)  // the first cluster's, whichever thread was first
    if (failure) std::rethrow_exception(failure);
  drops_.clear();
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    report += reports[c];
    std::move(results[c].begin(), results[c].end(), std::back_inserter(drops_));
  }
}

std::vector<Drop> Simulation::step_cluster(std::vector<Drop> drops, int substeps, StepReport& report) {
  BroadPhase broad_phase;
  const double dt = substep_length() / substeps;
  const SleepOptions sleep = sleep_options(options_.band);
  for (int k = substeps - 1; k >= 0; --k) {
    std::vector<Drop> next;
    for (Drop& drop : drops) {
      if (sleep_ && is_asleep(drop, sleep)) {
        report.asleep_triangles += drop.mesh().number_of_faces();
        ++report.asleep;
        next.push_back(std::move(drop));
        continue;
      }
      StepReport of_drop;
      if (drop.num_rows() <= most_rows_to_lend_to && drops_.size() > 1) {
        Workspace& workspace = workspaces_.local();
        workspace.solver.forget();
        drop.lend_workspace(&workspace);
      }
      std::vector<Drop> pieces =
          step_drop(std::move(drop), solids_, time_ - k * dt, dt, options_, remeshers_.local(), of_drop);
      for (Drop& piece : pieces) piece.lend_workspace(nullptr);
      report += of_drop;
      for (std::size_t p = 0; p < pieces.size(); ++p) {
        if (p > 0) pieces[p].set_id(no_id);
        if (sleep_) count_rest(pieces[p], dt, of_drop.edge_operations > 0, sleep);
        next.push_back(std::move(pieces[p]));
      }
    }
    drops = std::move(next);
    if (k > 0) merge(drops, broad_phase, report);
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
