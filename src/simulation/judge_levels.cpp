// SPDX-License-Identifier: GPL-3.0-or-later
#include "judge_levels.h"

#include "measurements.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace meniscus {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Level candidates[] = {Level::calibrated, Level::pressure};
/// A ball's mesh is a little smaller than the ball: lengths so near to measured ones count as equal.
constexpr double slack = 1.05;
/// Harder impacts than this are not in the region that was mapped as safe.
constexpr double most_weber = 5.5;
constexpr int most_substeps = 1000;  // as in a scene

/// What one table says of a level.
struct Finding {
  double longest_phase = infinity;  ///< of a step of the model up to which it is enough; 0: never
  double miss = 0;                  ///< if never: the figure in parts of what is asked for
  std::string text;                 ///< the figures
};

/// Up to which phase nothing failed in the map.
Finding find_hold(Level level, const Situation& s) {
  std::map<std::pair<bool, double>, double> mapped;  // the longest phase, by place and impact
  std::set<double> phases;
  double first_failed = infinity;
  int runs = 0, failures = 0;
  for (const MeasuredHold& row : measurements().holds) {
    if (row.level != level || row.weber > most_weber || (row.on_solid && !s.may_touch)) continue;
    double& longest = mapped[{row.on_solid, row.weber}];
    longest = std::max(longest, row.phase);
    phases.insert(row.phase);
    runs += row.runs;
    failures += row.failures;
    if (row.failures > 0) first_failed = std::min(first_failed, row.phase);
  }
  double longest = infinity;
  for (const auto& place : mapped) longest = std::min(longest, place.second);
  if (failures == 0)
    return {longest, 0, fmt::format("none of {} mapped runs failed, up to omega dt = {:.2g}", runs, longest)};
  const auto failed = phases.find(first_failed);
  const double below = failed == phases.begin() ? 0 : *std::prev(failed);
  return {below, 2,
          fmt::format("{} of {} mapped runs failed, from omega dt = {:.2g} on", failures, runs, first_failed)};
}

/// Up to which phase mode 2 swings as asked for.
Finding find_swing(Level level, const AccuracyTarget& target) {
  if (std::isinf(target.frequency_error)) return {};
  struct Worst {
    double frequency = 0, amplitude = 0;
  };
  std::map<double, Worst> by_phase;  // over meshes
  for (const MeasuredSwing& row : measurements().swings) {
    if (row.level != level) continue;
    const auto error = [](double x) { return std::isnan(x) ? infinity : std::abs(x); };
    Worst& worst = by_phase[row.phase];
    worst.frequency = std::max(worst.frequency, error(row.frequency_error));
    worst.amplitude = std::max(worst.amplitude, error(row.kept_per_period - 1));
  }
  const auto text = [](double phase, const Worst& worst) {
    return fmt::format("at omega dt = {:.2g} mode 2 is {:.2g} % off and changes its amplitude by {:.2g} % a period",
                       phase, 100 * worst.frequency, 100 * worst.amplitude);
  };
  Finding finding{0, infinity, ""};
  for (const auto& [phase, worst] : by_phase) {
    const double miss = std::max(worst.frequency / target.frequency_error, worst.amplitude / target.amplitude_error);
    if (miss > 1) {
      if (finding.longest_phase == 0) finding = {0, miss, text(phase, worst)};
      break;
    }
    finding = {phase, 0, text(phase, worst)};
  }
  return finding;
}

/// The measured values from the last at or below `least` to the first at or above `most`. Measured values are further
/// apart than least may be beyond most.
std::set<double> bracket(const std::set<double>& measured, double least, double most) {
  auto first = measured.upper_bound(least), last = measured.lower_bound(most);
  if (first != measured.begin()) --first;
  if (last != measured.end()) ++last;
  return {first, last};
}

/// Rows of drops like those of the scene; `edge_over_radius` of the rows, or 0: the nearest that is no finer.
struct RestRows {
  std::vector<const MeasuredRest*> rows;
  bool is_covered = true;  ///< sizes, angles and edges like the scene's were measured; else rows are what is nearest
};

RestRows rest_rows(Level level, const Situation& s, double edge_over_radius = 0) {
  std::set<double> bonds, angles;
  for (const MeasuredRest& row : measurements().rests)
    if (row.level == level) {
      bonds.insert(row.bond);
      angles.insert(row.angle_deg);
    }
  RestRows found;
  found.is_covered = s.most_bond <= *bonds.rbegin() * slack * slack && s.least_angle_deg >= *angles.begin() - 0.5 &&
                     s.most_angle_deg <= *angles.rbegin() + 0.5;
  for (const double bond : bracket(bonds, s.least_bond * slack * slack, s.most_bond / slack / slack))
    for (const double angle : bracket(angles, s.least_angle_deg + 0.5, s.most_angle_deg - 0.5)) {
      const MeasuredRest *best = nullptr, *coarsest = nullptr;
      for (const MeasuredRest& row : measurements().rests) {
        if (row.level != level || row.bond != bond || row.angle_deg != angle) continue;
        const double share = row.edge_over_radius;
        if (!coarsest || share > coarsest->edge_over_radius) coarsest = &row;
        if (edge_over_radius > 0 ? share != edge_over_radius : share * slack < s.edge_over_radius) continue;
        if (!best || share < best->edge_over_radius) best = &row;
      }
      if (!best) found.is_covered = false;
      if (best || coarsest) found.rows.push_back(best ? best : coarsest);
    }
  return found;
}

struct RestErrors {
  double height = 0, contact_radius = 0;
  double worst() const { return std::max(height, contact_radius); }
};

RestErrors worst_errors(const RestRows& found) {
  RestErrors errors;
  for (const MeasuredRest* row : found.rows) {
    const bool rested = std::isfinite(row->ns_per_triangle);
    errors.height = std::max(errors.height, rested ? std::abs(row->height_error) : infinity);
    errors.contact_radius = std::max(errors.contact_radius, rested ? std::abs(row->contact_radius_error) : infinity);
  }
  return errors;
}

/// The coarsest mesh finer than the scene's that would do, as edge_min over the radius; 0 if none was measured.
double edge_that_does(Level level, const Situation& s, const AccuracyTarget& target) {
  std::set<double> shares;
  for (const MeasuredRest& row : measurements().rests)
    if (row.level == level && row.edge_over_radius < s.edge_over_radius) shares.insert(row.edge_over_radius);
  for (auto share = shares.rbegin(); share != shares.rend(); ++share) {
    const RestRows found = rest_rows(level, s, *share);
    if (found.is_covered && worst_errors(found).worst() <= target.rest_error) return *share;
  }
  return 0;
}

/// Whether drops rest in the right shape.
Finding find_rest(Level level, const Situation& s, const AccuracyTarget& target) {
  if (std::isinf(target.rest_error) || !s.may_touch) return {};
  const RestRows found = rest_rows(level, s);
  const RestErrors errors = worst_errors(found);
  if (found.is_covered && errors.worst() <= target.rest_error) {
    double phase = 0;
    for (const MeasuredRest* row : found.rows) phase = std::max(phase, row->phase);
    return {
        phase, 0,
        fmt::format("with edge_min = {:.2g} R heights at rest are within {:.2g} % and contact radii within {:.2g} %",
                    s.edge_over_radius, 100 * errors.height, 100 * errors.contact_radius)};
  }
  std::string text =
      fmt::format("drops of these sizes and angles with edge_min = {:.2g} R are outside of what was measured at rest",
                  s.edge_over_radius);
  if (found.is_covered)
    text = fmt::format("with edge_min = {:.2g} R heights at rest are off by up to {:.2g} %, contact radii by {:.2g} %",
                       s.edge_over_radius, 100 * errors.height, 100 * errors.contact_radius);
  const double edge = edge_that_does(level, s, target);
  if (edge > 0) text += fmt::format(" ({:.2g} R would do)", edge);
  return {0, std::max(1.0, errors.worst() / target.rest_error), text};
}

/// The value at the row whose key is nearest in ratio, averaged over equals.
template <class Row, class Key, class Value>
double nearest_value(const std::vector<Row>& rows, Level level, double at, Key key, Value value) {
  double least = infinity, sum = 0;
  int count = 0;
  for (const Row& row : rows) {
    if (row.level != level || !(key(row) > 0)) continue;
    const double distance = std::abs(std::log(std::max(at, 1e-12) / key(row)));
    if (distance < least - 1e-9) {
      least = distance;
      sum = 0;
      count = 0;
    }
    if (distance > least + 1e-9) continue;
    sum += value(row);
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

/// The cost of a step of the model, ns a triangle.
double cost_of_step(Level level, const Situation& s, double phase) {
  if (s.may_touch) {
    double sum = 0;
    int count = 0;
    for (const MeasuredRest* row : rest_rows(level, s).rows) {
      if (!std::isfinite(row->ns_per_triangle)) continue;
      sum += row->ns_per_triangle;
      ++count;
    }
    if (count > 0) return sum / count;
    return nearest_value(
        measurements().rests, level, s.edge_over_radius, [](const auto& row) { return row.edge_over_radius; },
        [](const auto& row) { return row.ns_per_triangle; });
  }
  const auto at_phase = [&](double at) {
    return nearest_value(
        measurements().swings, level, at, [](const auto& row) { return row.phase; },
        [](const auto& row) { return row.ns_per_triangle; });
  };
  const double at_size = nearest_value(
      measurements().sizes, level, s.triangles, [](const auto& row) { return row.triangles; },
      [](const auto& row) { return row.ns_per_triangle; });
  return at_size * at_phase(phase) / at_phase(0.1);
}

LevelVerdict judge_level(Level level, const Situation& s, const AccuracyTarget& target) {
  const Finding findings[] = {find_hold(level, s), find_rest(level, s, target), find_swing(level, target)};
  LevelVerdict verdict;
  verdict.level = level;
  double longest = infinity;
  for (const Finding& finding : findings)
    if (finding.longest_phase > 0) longest = std::min(longest, finding.longest_phase * slack);
  const double needed = std::isinf(longest) ? 1 : std::ceil(s.step_phase / longest);
  verdict.substeps = s.substeps.value_or(static_cast<int>(std::clamp(needed, 1.0, double(most_substeps))));
  const double phase = s.step_phase / verdict.substeps;
  verdict.cost = cost_of_step(level, s, phase) * verdict.substeps;
  for (const Finding& finding : findings) {
    if (finding.text.empty()) continue;
    const bool is_enough = finding.longest_phase > 0 && phase <= finding.longest_phase * slack;
    if (is_enough) {
      verdict.reasons += (verdict.reasons.empty() ? "" : "; ") + finding.text;
      continue;
    }
    const std::string text = finding.longest_phase > 0
                                 ? fmt::format("{:.0f} substeps are needed, so that {}", needed, finding.text)
                                 : finding.text;
    if (verdict.is_met) verdict.missed = text;
    verdict.is_met = false;
    verdict.miss = std::max(verdict.miss, finding.longest_phase > 0 ? phase / finding.longest_phase : finding.miss);
  }
  return verdict;
}

}  // namespace

std::vector<LevelVerdict> judge_levels(const Situation& situation, const AccuracyTarget& target) {
  std::vector<LevelVerdict> verdicts;
  for (const Level level : candidates) verdicts.push_back(judge_level(level, situation, target));
  return verdicts;
}

}  // namespace meniscus
