// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/drop.h"
#include "meniscus/state/parameters.h"
#include "meniscus/state/solid.h"
#include "meniscus/topology/remesh.h"

#include <array>
#include <vector>

namespace meniscus {

struct MergeReport;

/// The stages of a step, in the order of the paper's Figure 1.
enum class Stage {
  external_forces,
  geometry,
  damping,
  curvature_flow,
  contact_angle,
  volume_correction,
  remesh,
  split,
  merge
};
inline constexpr std::size_t num_stages = 9;
const char* stage_name(Stage stage);  ///< "external_forces", ...

/// What the independent judge (state/judge.h) looks at while a simulation runs.
enum class Verify {
  nothing,
  topology,    ///< after each change of topology: closed, 2-manifold, outward, finite; what debug builds do in a
               ///< Simulation
  everything,  ///< and after each step: no drop meets itself, and the target volumes add up
};

/// Everything a step needs to know, the same for every drop.
struct StepOptions {
  Level level = Level::calibrated;
  Eigen::Vector3d gravity{0, 0, -981};  ///< cm/s^2
  Liquid liquid;
  PaperCoefficients paper;  ///< read by Level::paper only
  VolumeCorrectionMethod volume_correction = VolumeCorrectionMethod::global;
  EdgeBand band;
  bool remesh = true;
  bool split = true;
  bool merge = true;                          ///< drops that meet become one; read by Simulation, not by step_drop
  bool keep_air = false, self_merge = false;  ///< see MergeOptions
  SolverOptions solver;
  Verify verify = Verify::nothing;
  /// Seconds on some clock, for StepReport::stage_seconds; the library itself never reads one.
  double (*clock)() = nullptr;
};

/// What happened in a step, summed over drops.
struct StepReport {
  std::array<double, num_stages> stage_seconds{};  ///< zero without a clock
  std::size_t triangles = 0;                       ///< at the end of the step
  std::size_t edge_operations = 0;                 ///< splits, collapses and flips
  std::size_t cuts = 0;                            ///< necks cut
  std::size_t deleted = 0;                         ///< pieces too small to go on as drops
  std::size_t limited_volume = 0;                  ///< volume corrections cut to their limit
  std::size_t merges = 0;                          ///< pairs of drops that became one
  std::size_t folds = 0;                           ///< drops that fused with themselves
  std::size_t refused = 0;                         ///< pairs that met and could not be united in this step
  std::size_t taken_back = 0;                      ///< vertices that went back so that no surface meets itself
  std::size_t retries = 0;                         ///< ladder steps that a union took in vain
  double overlap = 0;                              ///< cm^3 that merging drops both claimed, lost and repaired
  std::size_t rejected = 0;                        ///< substeps of Level::pressure taken back for shorter ones
  std::size_t recoveries = 0;                      ///< substeps that blew up and were taken back for shorter ones
  std::size_t rounded = 0;                         ///< specks that were lost and became balls
  int substeps = 0;                                ///< most of any drop
  int solver_iterations = 0;                       ///< most of any drop
  std::size_t asleep = 0;                          ///< drops that were not stepped, being at rest
  std::size_t asleep_triangles = 0;                ///< theirs; `triangles` counts them too
  std::array<std::size_t, num_stages> skipped{};   ///< by stage: substeps of a drop in which it had nothing to do
  double volume_added = 0;                         ///< by sources, cm^3
  double worst_volume_error = 0;                   ///< largest |V - V_target| / V_target before topology changed

  StepReport& operator+=(const StepReport& other);
  StepReport& operator+=(const MergeReport& merge);

  /// For checkpoints: see frames/checkpoint_archive.h.
  template <class Self, class Archive>
  static void visit(Self& self, Archive& archive) {
    archive("stage_seconds", self.stage_seconds);
    archive("triangles", self.triangles);
    archive("edge_operations", self.edge_operations);
    archive("cuts", self.cuts);
    archive("deleted", self.deleted);
    archive("limited_volume", self.limited_volume);
    archive("merges", self.merges);
    archive("folds", self.folds);
    archive("refused", self.refused);
    archive("taken_back", self.taken_back);
    archive("retries", self.retries);
    archive("overlap", self.overlap);
    archive("rejected", self.rejected);
    archive("recoveries", self.recoveries);
    archive("rounded", self.rounded);
    archive("asleep", self.asleep);
    archive("asleep_triangles", self.asleep_triangles);
    archive("skipped", self.skipped);
    archive("volume_added", self.volume_added);
    archive("substeps", self.substeps);
    archive("solver_iterations", self.solver_iterations);
    archive("worst_volume_error", self.worst_volume_error);
  }
  void skip(Stage stage) { ++skipped[static_cast<std::size_t>(stage)]; }
};

/// How remeshing runs in a step.
RemeshOptions remesh_options(const StepOptions& step);

/// One step of one drop, from time - dt to time (s): the paper's Figure 1 from external forces to
/// mesh split. Pieces that pinched off go behind `cut_off`. Returns whether the drop goes on: false if it was too
/// small, and then there are no pieces and the drop may only be assigned to or destroyed. It is cut into equal substeps
/// where one would be too long: see docs/MODELS.md. `remesher` keeps working arrays from call to call: one a thread. A
/// substep after which the drop is not fit to go on is taken back and done in halves: see StepReport::recoveries.
/// Throws NumericsError if 1/64 of a substep fails still, but for a drop hardly larger than an edge, which becomes a
/// ball (StepReport::rounded); SoundnessError if options.verify finds a drop unsound.
bool step_in_place(Drop& drop, std::vector<Drop>& cut_off, const std::vector<Solid>& solids, double time, double dt,
                   const StepOptions& options, Remesher& remesher, StepReport& report);

/// The same. Returns what became of the drop: itself and its pieces in one list.
std::vector<Drop> step_drop(Drop drop, const std::vector<Solid>& solids, double time, double dt,
                            const StepOptions& options, Remesher& remesher, StepReport& report);

}  // namespace meniscus
