// SPDX-License-Identifier: GPL-3.0-or-later
#include "evolve_run.h"

#include "meniscus/core/error.h"
#include "meniscus/core/version.h"
#include "meniscus/io/write_file_atomically.h"
#include "meniscus/scene/write_scene.h"
#include "meniscus/simulation/choose_level.h"
#include "meniscus/simulation/safe_time_step.h"
#include "run_statistics.h"

#include <cmath>
#include <csignal>

namespace meniscus::tools {
namespace {

volatile std::sig_atomic_t caught_signal = 0;  // the one thing that a signal handler may write

extern "C" void catch_signal(int number) {
  caught_signal = number;
  std::signal(number, SIG_DFL);  // a second one ends the program
}

Simulation make_simulation(RunPlan& plan) {
  if (plan.drops) return {plan.scene, std::move(*plan.drops)};
  return Simulation(plan.scene);
}

std::size_t num_triangles(const Simulation& simulation) {
  std::size_t triangles = 0;
  for (const Drop& drop : simulation.drops()) triangles += drop.mesh().number_of_faces();
  return triangles;
}

/// What "auto" stands for in this scene, for reports.
Json choice_report(const Scene& scene) {
  const LevelChoice choice = choose_level(scene);
  return {{"model", level_name(choice.level)},
          {"volume_correction", "global"},
          {"solver_tolerance", choice.solver.tolerance},
          {"longest_phase", choice.longest_phase},
          {"meets_accuracy", choice.meets},
          {"why", choice.why}};
}

/// One run, from its first frame to run.json.
class Evolution {
 public:
  Evolution(RunPlan plan, const CommonOptions& common)
      : plan_(std::move(plan)),
        common_(common),
        console_(common.console()),
        progress_(console_),
        simulation_(make_simulation(plan_)),
        statistics_(simulation_) {
    simulation_.set_clock(&seconds_now);
    safe_time_step_ = safe_time_step(make_step_options(plan_.scene), simulation_.drops());
  }

  /// What is to be said before the first step: the level that "auto" took, and a time step outside the safe region.
  void say_plan() const {
    const Scene& scene = plan_.scene;
    if (scene.model == Level::automatic) console_.say(choose_level(scene).why);
    if (scene.time_step > safe_time_step_)
      console_.say(
          fmt::format("warning: a time_step of {:.3g} s is outside the region where this level holds on these "
                      "drops; {:.3g} s is inside (docs/ACCURACY.md)",
                      scene.time_step, safe_time_step_));
  }

  /// What --dry-run says, and -v.
  std::string describe() const {
    return fmt::format(
        "{}: {} drops, {} triangles, {} solids; {} steps of {:.6g} s, {} frames after the first, to {}\n", title(),
        simulation_.drops().size(), num_triangles(simulation_), simulation_.solids().size(), plan_.steps,
        plan_.scene.time_step, num_frames_planned(), plan_.output.string());
  }

  int run() {
    FrameWriter writer(plan_.output, plan_.frame_options);
    writer.write(0, simulation_.time(), simulation_.drops());
    frames_ = 1;
    try {
      step_all(writer);
    } catch (const Error& error) {
      progress_.clear();
      finish("failed", error.what());
      throw;
    }
    progress_.clear();
    const bool whole = caught_signal == 0;
    finish(whole ? "ok" : "interrupted", "");
    console_.say(summary(whole));
    return whole ? done : interrupted;
  }

  Json plan_report() const {
    Json report{
        {"status", "dry_run"}, {"scene", title()}, {"steps", plan_.steps}, {"frames", num_frames_planned() + 1}};
    report["triangles"] = num_triangles(simulation_);
    report["drops"] = simulation_.drops().size();
    report["resolved_scene"] = Json::parse(resolved_scene(plan_.scene));
    return report;
  }

 private:
  std::string title() const {
    return plan_.scene.file.empty() ? fmt::format("{}", fmt::join(plan_.inputs, " ")) : plan_.scene.file.string();
  }

  std::int64_t num_frames_planned() const {
    return (plan_.steps + plan_.scene.steps_per_frame - 1) / plan_.scene.steps_per_frame;
  }

  void step_all(FrameWriter& writer) {
    const std::int64_t each = plan_.scene.steps_per_frame;
    for (std::int64_t k = 1; k <= plan_.steps && caught_signal == 0; ++k) {
      const double start = seconds_now();
      const StepReport report = simulation_.step();
      statistics_.add_step(simulation_, report, seconds_now() - start);
      if (k % each == 0 || k == plan_.steps) {
        writer.write(static_cast<int>((k + each - 1) / each), simulation_.time(), simulation_.drops());
        ++frames_;
      }
      progress_.show(fmt::format("step {}/{}, {:.4f} s, {} drops, {} triangles, {:.3g} million triangle-steps/s", k,
                                 plan_.steps, simulation_.time(), simulation_.drops().size(), report.triangles,
                                 1e-6 * statistics_.triangle_steps_per_second()));
    }
  }

  /// Writes run.json and the report of --json.
  void finish(const char* status, const std::string& message) const {
    Json report{{"status", status}};
    if (!message.empty()) report["message"] = message;
    report["scene"] = title();
    report["frames"] = frames_;
    report.update(statistics_.to_json());
    report["safe_time_step"] = std::isfinite(safe_time_step_) ? Json(safe_time_step_) : Json();
    if (plan_.scene.model == Level::automatic) report["choice"] = choice_report(plan_.scene);
    write_report(report, common_);
    report["version"] = version();
    report["resolved_scene"] = Json::parse(resolved_scene(plan_.scene));
    write_file_atomically(plan_.output / "run.json", report.dump(2, ' ', false, Json::error_handler_t::replace) + '\n');
  }

  std::string summary(bool whole) const {
    return fmt::format("{}{} steps, {} frames in {}; {} drops, {} triangles at {:.4f} s",
                       whole ? "" : "interrupted after ", statistics_.num_steps(), frames_, plan_.output.string(),
                       simulation_.drops().size(), num_triangles(simulation_), simulation_.time());
  }

  RunPlan plan_;
  const CommonOptions& common_;
  Console console_;
  Progress progress_;
  Simulation simulation_;
  RunStatistics statistics_;
  int frames_ = 0;
  double safe_time_step_ = 0;
};

}  // namespace

int run_evolution(RunPlan plan, const CommonOptions& common) {
  const bool dry_run = plan.dry_run;
  Evolution evolution(std::move(plan), common);
  if (dry_run) {
    if (common.json != "-") write_stdout(evolution.describe());
    write_report(evolution.plan_report(), common);
    return done;
  }
  evolution.say_plan();
  std::signal(SIGINT, catch_signal);
  std::signal(SIGTERM, catch_signal);
  common.console().say_verbose(evolution.describe());
  return evolution.run();
}

}  // namespace meniscus::tools
