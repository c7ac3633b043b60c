// SPDX-License-Identifier: GPL-3.0-or-later
#include "run_statistics.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace meniscus::tools {
namespace {

/// The q-quantile of sorted values by the nearest rank; 0 of none.
double quantile(const std::vector<double>& sorted, double q) {
  if (sorted.empty()) return 0;
  const double rank = std::ceil(q * static_cast<double>(sorted.size()));
  return sorted[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

double per(double sum, std::size_t n) { return n == 0 ? 0 : sum / static_cast<double>(n); }

std::size_t num_threads() {
  return std::min(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism),
                  static_cast<std::size_t>(tbb::info::default_concurrency()));
}

}  // namespace

double cpu_seconds() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

RunStatistics::RunStatistics(const Simulation& simulation)
    : initial_volume_(simulation.target_volume()),
      final_volume_(simulation.volume()),
      time_(simulation.time()),
      num_drops_(simulation.drops().size()),
      start_wall_(seconds_now()),
      start_cpu_(cpu_seconds()) {}

void RunStatistics::add_step(const Simulation& simulation, const StepReport& report, double seconds) {
  step_seconds_.push_back(seconds);
  sum_ += report;
  max_triangles_ = std::max(max_triangles_, report.triangles);
  worst_error_ = std::max(worst_error_, report.worst_volume_error);
  final_volume_ = simulation.volume();
  time_ = simulation.time();
  num_drops_ = simulation.drops().size();
  worst_error_ = std::max(worst_error_, std::abs(volume_error()));
}

double RunStatistics::volume_error() const {
  const double expected = initial_volume_ + sum_.volume_added;
  return expected > 0 ? (final_volume_ - expected) / expected : 0;
}

double RunStatistics::wall_seconds() const { return seconds_now() - start_wall_; }

double RunStatistics::used_cpu_seconds() const { return cpu_seconds() - start_cpu_; }

void RunStatistics::set_used_seconds(double wall, double cpu) {
  start_wall_ = seconds_now() - wall;
  start_cpu_ = cpu_seconds() - cpu;
}

double RunStatistics::triangle_steps_per_second() const {
  const double stepping = std::accumulate(step_seconds_.begin(), step_seconds_.end(), 0.0);
  return stepping > 0 ? static_cast<double>(sum_.triangles - sum_.asleep_triangles) / stepping : 0;
}

Json RunStatistics::to_json() const {
  std::vector<double> sorted = step_seconds_;
  std::sort(sorted.begin(), sorted.end());
  const std::size_t steps = sorted.size();
  Json stages = Json::object(), skipped = Json::object();
  for (std::size_t k = 0; k < num_stages; ++k)
    if (sum_.skipped[k] > 0) skipped[stage_name(static_cast<Stage>(k))] = sum_.skipped[k];
  for (std::size_t k = 0; k < num_stages; ++k)
    stages[stage_name(static_cast<Stage>(k))] = 1e3 * per(sum_.stage_seconds[k], steps);
  return {{"steps", steps},
          {"simulated_seconds", time_},
          {"wall_seconds", wall_seconds()},
          {"cpu_seconds", used_cpu_seconds()},
          {"threads", num_threads()},
          {"triangles", {{"mean", per(static_cast<double>(sum_.triangles), steps)}, {"max", max_triangles_}}},
          {"triangle_steps_per_second", triangle_steps_per_second()},
          {"step_ms",
           {{"p50", 1e3 * quantile(sorted, 0.5)},
            {"p99", 1e3 * quantile(sorted, 0.99)},
            {"max", 1e3 * quantile(sorted, 1)}}},
          {"stage_ms", std::move(stages)},
          {"stage_skipped", std::move(skipped)},
          {"counts",
           {{"merges", sum_.merges},
            {"folds_mended", sum_.folds},
            {"vertices_taken_back", sum_.taken_back},
            {"steps_recovered", sum_.recoveries},
            {"specks_rounded_off", sum_.rounded},
            {"splits", sum_.cuts},
            {"deleted", sum_.deleted},
            {"retries", sum_.retries},
            {"refused", sum_.refused},
            {"edge_operations", sum_.edge_operations},
            {"asleep_drop_steps", sum_.asleep},
            {"limited_volume_corrections", sum_.limited_volume}}},
          {"volume",
           {{"initial", initial_volume_},
            {"added", sum_.volume_added},
            {"final", final_volume_},
            {"worst_relative_error", worst_error_},
            {"merge_overlap", sum_.overlap}}},
          {"drops", num_drops_}};
}

}  // namespace meniscus::tools
