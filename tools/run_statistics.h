// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/simulation/simulation.h"
#include "report.h"

#include <string>
#include <type_traits>
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

  /// For checkpoints: see frames/checkpoint_archive.h. Seconds go on from those of the earlier run.
  template <class Self, class Archive>
  static void visit(Self& self, Archive& archive) {
    double wall = self.wall_seconds(), cpu = self.used_cpu_seconds();
    archive("wall_seconds", wall);
    archive("cpu_seconds", cpu);
    archive("step_seconds", self.step_seconds_);
    archive("sum", self.sum_);
    archive("max_triangles", self.max_triangles_);
    archive("initial_volume", self.initial_volume_);
    archive("final_volume", self.final_volume_);
    archive("time", self.time_);
    archive("worst_error", self.worst_error_);
    archive("num_drops", self.num_drops_);
    if constexpr (!std::is_const_v<Self>) self.set_used_seconds(wall, cpu);
  }

  /// Of all drops together after the last step, relative to what there ought to be.
  double volume_error() const;
  std::size_t num_steps() const { return step_seconds_.size(); }
  double triangle_steps_per_second() const;

 private:
  double wall_seconds() const;
  double used_cpu_seconds() const;
  void set_used_seconds(double wall, double cpu);

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
