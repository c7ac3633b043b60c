// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/simulation/simulation.h"
#include "report.h"

#include <string>
#include <vector>

namespace meniscus::tools {

/// What is counted while a run goes on, and the report made of it.
class RunStatistics {
 public:
  explicit RunStatistics(const Simulation& simulation);

  /// One step's report and the seconds that it took.
  void add_step(const Simulation& simulation, const StepReport& report, double seconds);

  /// The report of `evolve` up to the last step that was added, without scene and frames.
  Json to_json() const;

  std::size_t num_steps() const { return step_seconds_.size(); }
  double triangle_steps_per_second() const;

 private:
  std::vector<double> step_seconds_;
  StepReport sum_;
  std::size_t max_triangles_ = 0;
  double initial_volume_, final_volume_, time_, worst_error_ = 0;
  std::size_t num_drops_;
  double start_wall_, start_cpu_;
};

/// Seconds of processor time that this program has used so far, on all threads.
double cpu_seconds();

}  // namespace meniscus::tools
