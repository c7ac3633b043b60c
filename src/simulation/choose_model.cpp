// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/simulation/choose_model.h"

#include "judge_levels.h"
#include "measurements.h"

#include <fmt/format.h>

#include <algorithm>

namespace meniscus {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The cheapest correction that keeps the volume at a level that reads one.
VolumeCorrectionMethod cheapest_correction(Level level, const AccuracyTarget& target) {
  const MeasuredCorrection* best = nullptr;
  for (const MeasuredCorrection& row : measurements().corrections)
    if (row.level == level && row.volume_error <= target.volume_error && (!best || row.cost < best->cost)) best = &row;
  return best && level != Level::pressure ? best->method : VolumeCorrectionMethod::global;
}

bool keeps_volume(Level level, VolumeCorrectionMethod method, const AccuracyTarget& target) {
  const auto& rows = measurements().corrections;
  return std::any_of(rows.begin(), rows.end(), [&](const MeasuredCorrection& row) {
    return row.level == level && (level == Level::pressure || row.method == method) &&
           row.volume_error <= target.volume_error;
  });
}

SolverMethod fastest_solver() {
  const auto& rows = measurements().solvers;
  return std::min_element(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.cost < b.cost; })
      ->method;
}

/// The loosest tolerance that takes little enough from the motion.
double loosest_tolerance(Level level, const AccuracyTarget& target) {
  double loosest = 0, tightest = infinity;
  for (const MeasuredTolerance& row : measurements().tolerances) {
    if (row.level != level) continue;
    tightest = std::min(tightest, row.tolerance);
    if (row.amplitude_off <= target.solver_error) loosest = std::max(loosest, row.tolerance);
  }
  return loosest > 0 ? loosest : tightest;
}

/// The cheapest level that meets the target, or the one that comes nearest.
const LevelVerdict& best_of(const std::vector<LevelVerdict>& verdicts) {
  return *std::min_element(verdicts.begin(), verdicts.end(), [](const LevelVerdict& a, const LevelVerdict& b) {
    if (a.is_met != b.is_met) return a.is_met;
    return a.is_met ? a.cost < b.cost : a.miss < b.miss;
  });
}

std::string sentence_on_others(const LevelVerdict& chosen, const std::vector<LevelVerdict>& verdicts) {
  std::string text;
  for (const LevelVerdict& other : verdicts) {
    if (&other == &chosen) continue;
    text += (text.empty() ? "" : "; ") + std::string(level_name(other.level)) + ": ";
    text +=
        other.is_met ? fmt::format("enough, too, at {:.2g} times the cost", other.cost / chosen.cost) : other.missed;
  }
  return text;
}

std::string ignored_keys(const GivenKeys& given, Level level) {
  if (level != Level::pressure) return {};
  if (given.volume_correction) return "; it reads no volume_correction";
  return given.solver_method ? "; it reads no solver.method" : "";
}

}  // namespace

AccuracyTarget target_of(Accuracy accuracy) {
  AccuracyTarget target;
  target.volume_error = 1e-6;
  target.solver_error = 1e-3;
  if (accuracy == Accuracy::look) return target;
  target.rest_error = 0.01;
  if (accuracy == Accuracy::shape) return target;
  target.frequency_error = 0.02;
  target.amplitude_error = 0.05;
  return target;
}

const char* accuracy_name(Accuracy accuracy) {
  constexpr const char* names[] = {"look", "shape", "motion"};
  return names[static_cast<std::size_t>(accuracy)];
}

const char* level_name(Level level) {
  constexpr const char* names[] = {"paper", "calibrated", "pressure"};
  return names[static_cast<std::size_t>(level)];
}

ModelChoice choose_model(const Scene& scene, const std::vector<Drop>& drops, const std::vector<Solid>& solids) {
  ModelChoice choice;
  choice.level = scene.model;
  choice.volume_correction = scene.volume_correction;
  choice.solver_method = scene.solver.method;
  choice.solver_tolerance = scene.solver.tolerance;
  choice.substeps = scene.substeps;
  if (!scene.accuracy) return choice;

  const AccuracyTarget target = target_of(*scene.accuracy);
  const std::vector<LevelVerdict> verdicts = judge_levels(situation_of(scene, drops, solids), target);
  const LevelVerdict& best = best_of(verdicts);
  choice.level = best.level;
  choice.is_met = best.is_met;
  if (!scene.given.substeps) choice.substeps = best.substeps;
  if (!scene.given.volume_correction) choice.volume_correction = cheapest_correction(best.level, target);
  if (!scene.given.solver_method) choice.solver_method = fastest_solver();
  if (!scene.given.solver_tolerance) choice.solver_tolerance = loosest_tolerance(best.level, target);
  choice.why = best.is_met ? best.reasons : "not known to be reached: " + best.missed + "; nothing comes nearer";
  if (!keeps_volume(choice.level, choice.volume_correction, target)) {
    choice.is_met = false;
    choice.why += "; the volume_correction given does not keep the volume";
  }
  choice.why += ignored_keys(scene.given, choice.level) + ". " + sentence_on_others(best, verdicts);
  return choice;
}

Scene with_choice(Scene scene, const ModelChoice& choice) {
  scene.accuracy.reset();
  scene.model = choice.level;
  scene.volume_correction = choice.volume_correction;
  scene.solver.method = choice.solver_method;
  scene.solver.tolerance = choice.solver_tolerance;
  scene.substeps = choice.substeps;
  return scene;
}

}  // namespace meniscus
