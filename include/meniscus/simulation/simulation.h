// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/scene/scene.h"
#include "meniscus/simulation/approaching.h"
#include "meniscus/simulation/choose_model.h"
#include "meniscus/simulation/merge_touching.h"
#include "meniscus/simulation/source.h"
#include "meniscus/simulation/step.h"

#include <exception>
#include <type_traits>
#include <vector>

namespace meniscus {

/// Drops that start within this distance of a solid start on it (cm).
inline constexpr double contact_tolerance = 1e-9;

/// The solids that a scene describes, and behind them the discs of its sources. Throws FileError, UsageError or
/// GeometryError, naming the solid.
std::vector<Solid> make_solids(const Scene& scene);

/// The drops that a scene describes, numbered from 0 in its order; a mesh file of several drops
/// gives them all. Throws FileError, UsageError or GeometryError, naming the drop.
std::vector<Drop> make_drops(const Scene& scene, const std::vector<Solid>& solids);

/// The options of a step that a scene asks for. An accuracy is not looked at: see with_choice.
StepOptions make_step_options(const Scene& scene);

/// Drops and solids that go through time together. Drops are stepped in parallel (TBB); the result
/// does not depend on the number of threads. Drops that meet merge; those too fast for the step to see
/// them meet take it in substeps together.
class Simulation {
 public:
  /// Builds everything that the scene describes.
  explicit Simulation(const Scene& scene);
  /// The scene's solids and parameters, with these drops instead of its own.
  Simulation(const Scene& scene, std::vector<Drop> drops);

  /// Takes one step of scene.time_step, in as many steps of the model as the choice says. Throws NumericsError
  /// (SoundnessError included); the state is then that before the step for some drops and after it for others, and fit
  /// for inspection only.
  StepReport step();

  const std::vector<Drop>& drops() const { return drops_; }
  const std::vector<Solid>& solids() const { return solids_; }
  double time() const { return time_; }                  ///< s
  std::size_t num_steps() const { return num_steps_; }   ///< taken so far
  const ModelChoice& choice() const { return choice_; }  ///< what steps are taken with
  const StepOptions& options() const { return options_; }
  double volume() const;         ///< of all drops, cm^3
  double target_volume() const;  ///< of all drops, cm^3
  /// For stage times: see StepOptions::clock.
  void set_clock(double (*clock)()) { options_.clock = clock; }
  /// Whether an independent judge looks at the drops; a step then takes many times longer.
  void set_verify(Verify verify) { options_.verify = verify; }

  /// Everything that a step changes, for checkpoints (frames/checkpoint_archive.h): read into a simulation
  /// of the same scene without drops, it goes on to the same bits. What is added to the class is added here.
  template <class Self, class Archive>
  static void visit(Self& self, Archive& archive) {
    archive("time", self.time_);
    archive("num_steps", self.num_steps_);
    archive("next_id", self.next_id_);
    archive("drops", self.drops_);
    archive("feed", self.feed_);
    if (self.is_chosen_) archive("choice", self.choice_);  // made for the drops at the start
    if constexpr (!std::is_const_v<Self>) self.finish_restored();
  }

 private:
  /// One step of the model, from `start` (s) to time_.
  StepReport take_substep(double start);
  double substep_length() const { return time_step_ / choice_.substeps; }  ///< s
  void take_choice(ModelChoice choice);
  void step_all(StepReport& report);
  /// One drop by dt, to `time` (s), unless it sleeps. As step_in_place.
  bool step_one(Drop& drop, std::vector<Drop>& cut_off, double time, double dt, StepReport& report);
  /// Drops that step together, out of drops_, by their places. Returns what became of them.
  std::vector<Drop> step_cluster(const std::vector<std::uint32_t>& cluster, StepReport& report);
  void merge(std::vector<Drop>& drops, BroadPhase& broad_phase, StepReport& report);
  /// Takes the choice that was read. Throws FileError if that is none, or if a drop touches a solid that is not there.
  void finish_restored();
  void check_contacts() const;
  /// Gives all drops, in proportion, the volume (cm^3) of those that were too small to go on.
  void share_volume(double lost);
  void verify(const StepReport& report, double target_volume_before) const;

  std::vector<Solid> solids_;
  std::vector<Drop> drops_;
  StepOptions options_;
  Remeshers remeshers_;
  tbb::enumerable_thread_specific<Workspace> workspaces_;  ///< lent to small drops in turn
  Approach approach_;
  BroadPhase places_;  ///< of boxes after a step
  /// What step_all does with a drop, by place.
  struct Task {
    const std::vector<std::uint32_t>* cluster =
        nullptr;               ///< that the drop goes with, stepped by its first; nullptr: alone
    bool goes_on = true;       ///< the drop itself is still there
    std::vector<Drop> others;  ///< what was cut off it, or became of its cluster
    StepReport report;
    std::exception_ptr failure;
  };
  std::vector<Task> tasks_;  ///< kept, so that a step allocates nothing
  SourceFeed feed_;
  ModelChoice choice_;
  bool is_chosen_ = false;  ///< the scene left the choice to the level "auto"
  bool sleep_ = false;
  double time_step_ = 0, time_ = 0;
  std::size_t num_steps_ = 0;
  int next_id_ = 0;
};

}  // namespace meniscus
