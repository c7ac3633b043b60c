// SPDX-License-Identifier: GPL-3.0-or-later
#include "evolve_run.h"

#include "meniscus/core/error.h"
#include "meniscus/core/version.h"
#include "meniscus/frames/checkpoint_archive.h"
#include "meniscus/frames/checkpoint_file.h"
#include "meniscus/io/write_file_atomically.h"
#include "meniscus/io/write_mesh.h"
#include "meniscus/scene/write_scene.h"
#include "meniscus/simulation/check_frame.h"
#include "meniscus/simulation/safe_time_step.h"
#include "run_statistics.h"
#include "writing_thread.h"

#include <cmath>
#include <csignal>
#include <memory>

namespace meniscus::tools {
namespace {

/// Of all drops together: beyond, frames show something else than the scene's liquid.
constexpr double most_volume_error = 0.05;

volatile std::sig_atomic_t caught_signal = 0;  // the one thing that a signal handler may write

extern "C" void catch_signal(int number) {
  caught_signal = number;
  std::signal(number, SIG_DFL);  // a second one ends the program
}

CheckpointReader reader_of(const ResumePoint& point) { return {*point.state, point.file.string()}; }

Simulation make_simulation(RunPlan& plan) {
  if (plan.resume) {
    Simulation simulation(plan.scene, {});
    reader_of (*plan.resume)("simulation", simulation);
    return simulation;
  }
  if (plan.drops) return {plan.scene, std::move(*plan.drops)};
  return Simulation(plan.scene);
}

std::size_t num_triangles(const Simulation& simulation) {
  std::size_t triangles = 0;
  for (const Drop& drop : simulation.drops()) triangles += drop.mesh().number_of_faces();
  return triangles;
}

/// No frame outside of the safe region is written unless the judge finds it sound.
void check_doubtful_frame(std::int64_t frame, const std::vector<Drop>& drops, bool volume_is_kept) {
  try {
    check_frame(drops, volume_is_kept);
  } catch (const SoundnessError& error) {
    throw SoundnessError(
        fmt::format("frame {}: {}; the frames before it are sound. The time step is outside of the "
                    "region where this level held: see the warning at the start",
                    frame, error.what()));
  }
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
    if (plan_.steps < num_steps())
      throw UsageError(
          fmt::format("--resume: the checkpoint in {} is at step {} already, and {} are asked for; ask for as "
                      "many at least",
                      plan_.output.string(), num_steps(), plan_.steps));
    simulation_.set_clock(&seconds_now);
    if (plan_.verify) simulation_.set_verify(Verify::everything);
    safe_time_step_ = simulation_.choice().substeps *
                      safe_time_step(simulation_.options(), simulation_.drops(), simulation_.solids());
  }

  /// Says what the level "auto" took, and why.
  void say_choice() const {
    if (!plan_.scene.accuracy) return;
    const ModelChoice& choice = simulation_.choice();
    const Json chosen = chosen_keys();
    console_.say(fmt::format("auto, {}: {} in {} substep{}, volume_correction {}, solver {} to {:.0e}\n  {}",
                             accuracy_name(*plan_.scene.accuracy), level_name(choice.level), choice.substeps,
                             choice.substeps == 1 ? "" : "s", chosen["volume_correction"].get<std::string>(),
                             chosen["solver"]["method"].get<std::string>(), choice.solver_tolerance, choice.why));
  }

  /// Says before the first step if the time step is outside of the region that was mapped as safe.
  void say_whether_safe() const {
    if (is_safe()) return;
    console_.say(
        safe_time_step_ > 0
            ? fmt::format("warning: a time_step of {:.3g} s is outside of the region where this level held; "
                          "{:.3g} s is inside (docs/ACCURACY.md)",
                          plan_.scene.time_step, safe_time_step_)
            : "warning: at the level \"paper\" drops that fall on solids fold at any time_step; \"calibrated\" "
              "and \"pressure\" hold (docs/ACCURACY.md)");
  }

  /// What --dry-run says, and -v.
  std::string describe() const {
    return fmt::format(
        "{}: {} drops, {} triangles, {} solids; {} steps of {:.6g} s, {} frames after the first, to {}\n", title(),
        simulation_.drops().size(), num_triangles(simulation_), simulation_.solids().size(), plan_.steps,
        plan_.scene.time_step, num_frames_planned(), plan_.output.string());
  }

  int run() {
    FrameWriter writer = first_frames();
    WritingThread behind;  // from here on the only one to touch the writer
    try {
      step_all(writer, behind);
      if (caught_signal != 0) save(writer, behind);
      behind.finish();
    } catch (const Error& error) {
      progress_.clear();
      behind.stop();  // frames from before a failure of the simulation are still written
      frames_ = writer.num_frames();
      finish_failed(error);
      throw;
    }
    progress_.clear();
    frames_ = writer.num_frames();
    writer.finish();
    const bool whole = caught_signal == 0;
    finish(whole ? "ok" : "interrupted", "");
    if (whole) remove_checkpoints(plan_.output);
    console_.say(summary(whole));
    return whole ? done : interrupted;
  }

  Json plan_report() const {
    Json report{
        {"status", "dry_run"}, {"scene", title()}, {"steps", plan_.steps}, {"frames", num_frames_planned() + 1}};
    report["triangles"] = num_triangles(simulation_);
    report["drops"] = simulation_.drops().size();
    report["safe_time_step"] = std::isfinite(safe_time_step_) ? Json(safe_time_step_) : Json();
    add_choice(report);
    report["resolved_scene"] = Json::parse(resolved_scene(plan_.scene));
    return report;
  }

 private:
  bool is_safe() const { return plan_.scene.time_step <= safe_time_step_; }

  /// The keys that "auto" stands for, as a scene would give them.
  Json chosen_keys() const {
    const Json scene = Json::parse(resolved_scene(with_choice(plan_.scene, simulation_.choice())));
    Json chosen = Json::object();
    for (const char* key : {"model", "substeps", "volume_correction", "solver"}) chosen[key] = scene[key];
    return chosen;
  }

  void add_choice(Json& report) const {
    if (!plan_.scene.accuracy) return;
    Json choice{{"accuracy", accuracy_name(*plan_.scene.accuracy)}};
    choice.update(chosen_keys());
    choice["is_met"] = simulation_.choice().is_met;
    choice["why"] = simulation_.choice().why;
    report["auto"] = std::move(choice);
  }

  std::string title() const {
    return plan_.scene.file.empty() ? fmt::format("{}", fmt::join(plan_.inputs, " ")) : plan_.scene.file.string();
  }

  std::int64_t num_frames_planned() const {
    return (plan_.steps + plan_.scene.steps_per_frame - 1) / plan_.scene.steps_per_frame;
  }

  /// The frames that are there when stepping begins: the first, or those up to the checkpoint.
  FrameWriter first_frames() {
    if (!plan_.lock) plan_.lock.emplace(plan_.output);
    if (!plan_.resume && !plan_.overwrite && !find_checkpoints(plan_.output).empty())
      throw UsageError(
          fmt::format("{}: holds a run that was interrupted; go on with --resume, or start over with "
                      "--overwrite",
                      plan_.output.string()));
    remove_temporary_files(plan_.output);
    if (plan_.resume) {
      CheckpointReader reader = reader_of(*plan_.resume);
      reader("statistics", statistics_);
      FrameWriter writer(plan_.output, plan_.frame_options, reader);
      plan_.resume.reset();  // the state is large
      return writer;
    }
    remove_checkpoints(plan_.output);
    std::error_code ignored;
    std::filesystem::remove(plan_.output / "run.json", ignored);  // an older run's
    FrameWriter writer(plan_.output, plan_.frame_options);
    writer.write(0, simulation_.time(), simulation_.drops());
    if (plan_.checkpoint_every > 0 && plan_.steps > 0) write_state(writer, num_steps(), state());
    return writer;
  }

  std::int64_t num_steps() const { return static_cast<std::int64_t>(simulation_.num_steps()); }

  /// What a checkpoint holds, but for the frames.
  nlohmann::json state() const {
    CheckpointWriter archive;
    archive("simulation", simulation_);
    archive("statistics", statistics_);
    nlohmann::json state = archive.state();
    state["run"] = describe_run(plan_.scene, plan_.inputs, plan_.solids);
    return state;
  }

  void write_state(const FrameWriter& writer, std::int64_t step, nlohmann::json state) const {
    CheckpointWriter frames;
    frames("frames", writer);
    state["frames"] = frames.state()["frames"];
    write_checkpoint(plan_.output, step, state);
  }

  /// A checkpoint of now, written after the frames before it and telling of them alone.
  void save(const FrameWriter& writer, WritingThread& behind) const {
    behind.run([this, &writer, step = num_steps(), now = std::make_shared<nlohmann::json>(state())] {
      write_state(writer, step, std::move(*now));
    });
  }

  void write_frame(FrameWriter& writer, WritingThread& behind, std::int64_t frame) const {
    const bool is_doubtful = !is_safe() && !plan_.verify;
    const bool volume_is_kept = simulation_.options().volume_correction != VolumeCorrectionMethod::none;
    behind.run([&writer, frame, is_doubtful, volume_is_kept, time = simulation_.time(), drops = simulation_.drops()] {
      if (is_doubtful) check_doubtful_frame(frame, drops, volume_is_kept);
      writer.write(static_cast<int>(frame), time, drops);
    });
  }

  /// One step. With --verify, the state before a step that failed is kept: DIR/violation goes on from there.
  StepReport step() {
    if (!plan_.verify) return simulation_.step();
    const nlohmann::json before = state();
    try {
      return simulation_.step();
    } catch (const NumericsError& error) {
      write_violation(before);
      throw SoundnessError(fmt::format("{}\n  to see it again: meniscus evolve --resume --verify -o {}", error.what(),
                                       violation().string()));
    }
  }

  std::filesystem::path violation() const { return plan_.output / "violation"; }

  /// A directory to resume from, and the drops as they were.
  void write_violation(nlohmann::json before) const {
    const FrameWriter none(violation(), {false, {}, plan_.frame_options.density});
    remove_checkpoints(violation());
    CheckpointWriter frames;
    frames("frames", none);
    before["frames"] = frames.state()["frames"];
    Simulation simulation(plan_.scene, {});
    CheckpointReader(before, "the state before the step")("simulation", simulation);
    write_checkpoint(violation(), static_cast<std::int64_t>(simulation.num_steps()), before);
    write_mesh(violation() / "before.ply", to_mesh_data(simulation.drops()));
    write_file_atomically(violation() / "scene.json", resolved_scene(plan_.scene) + '\n');
  }

  void step_all(FrameWriter& writer, WritingThread& behind) {
    const std::int64_t each = plan_.scene.steps_per_frame;
    for (std::int64_t k = num_steps() + 1; k <= plan_.steps && caught_signal == 0; ++k) {
      const double start = seconds_now();
      const StepReport report = step();
      statistics_.add_step(simulation_, report, seconds_now() - start);
      say_if_volume_is_off();
      if (k % each == 0 || k == plan_.steps) {
        const std::int64_t frame = (k + each - 1) / each;
        write_frame(writer, behind, frame);
        if (plan_.checkpoint_every > 0 && frame % plan_.checkpoint_every == 0 && k < plan_.steps) save(writer, behind);
      }
      progress_.show(fmt::format("step {}/{}, {:.4f} s, {} drops, {} triangles, {:.3g} million triangle-steps/s", k,
                                 plan_.steps, simulation_.time(), simulation_.drops().size(), report.triangles,
                                 1e-6 * statistics_.triangle_steps_per_second()));
    }
  }

  /// Says once that frames have begun to be wrong, where nothing in the numerics fails.
  void say_if_volume_is_off() {
    const double off = statistics_.volume_error();
    if (has_said_volume_ || std::abs(off) < most_volume_error) return;
    has_said_volume_ = true;
    progress_.clear();
    console_.say(
        fmt::format("warning: at {:.4g} s the drops hold {:.1f} % {} than they ought to; run.json has the worst "
                    "of the run (volume.worst_relative_error)",
                    simulation_.time(), 100 * std::abs(off), off < 0 ? "less" : "more"));
  }

  /// Tells of a failure where it can: on a full disk the error itself is worth more than that run.json failed too.
  void finish_failed(const Error& error) const {
    try {
      finish("failed", error.what());
    } catch (const FileError&) {
    }
  }

  /// Writes run.json and the report of --json.
  void finish(const char* status, const std::string& message) const {
    Json report{{"status", status}};
    if (!message.empty()) report["message"] = message;
    report["scene"] = title();
    report["frames"] = frames_;
    add_choice(report);
    report.update(statistics_.to_json());
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
  bool has_said_volume_ = false;
};

}  // namespace

int run_evolution(RunPlan plan, const CommonOptions& common) {
  const bool dry_run = plan.dry_run;
  Evolution evolution(std::move(plan), common);
  if (dry_run) {
    evolution.say_choice();
    if (common.json != "-") write_stdout(evolution.describe());
    write_report(evolution.plan_report(), common);
    return done;
  }
  evolution.say_choice();
  evolution.say_whether_safe();
  std::signal(SIGINT, catch_signal);
  std::signal(SIGTERM, catch_signal);
  common.console().say_verbose(evolution.describe());
  return evolution.run();
}

}  // namespace meniscus::tools
