// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/scene/scene.h"
#include "meniscus/state/drop.h"
#include "meniscus/state/solid.h"

#include <limits>
#include <string>
#include <vector>

namespace meniscus {

/// What an accuracy asks for, as relative errors; infinite: nothing.
struct AccuracyTarget {
  double volume_error = 0;                                           ///< of a drop
  double rest_error = std::numeric_limits<double>::infinity();       ///< of height and contact radius, Young-Laplace
  double frequency_error = std::numeric_limits<double>::infinity();  ///< of mode 2, Rayleigh
  double amplitude_error = std::numeric_limits<double>::infinity();  ///< of what mode 2 keeps a period, exactly 1
  double solver_error = 0;  ///< of mode 2's amplitude, by the linear solver's tolerance alone
};
AccuracyTarget target_of(Accuracy accuracy);
const char* accuracy_name(Accuracy accuracy);  ///< "look", ...
const char* level_name(Level level);           ///< "paper", ...

/// What a simulation takes its steps with.
struct ModelChoice {
  Level level = Level::calibrated;
  VolumeCorrectionMethod volume_correction = VolumeCorrectionMethod::global;  ///< not read by Level::pressure
  SolverMethod solver_method = SolverMethod::automatic;                       ///< likewise
  double solver_tolerance = 1e-6;
  int substeps = 1;    ///< steps of the model in one of the scene's
  bool is_met = true;  ///< whether the measurements say that the accuracy is reached
  std::string why;     ///< one or two sentences; empty if the scene leaves nothing open

  /// For checkpoints: see frames/checkpoint_archive.h.
  template <class Self, class Archive>
  static void visit(Self& self, Archive& archive) {
    archive("level", self.level);
    archive("volume_correction", self.volume_correction);
    archive("solver_method", self.solver_method);
    archive("solver_tolerance", self.solver_tolerance);
    archive("substeps", self.substeps);
    archive("is_met", self.is_met);
    archive("why", self.why);
  }
};

/// The level "auto": for scene.accuracy the cheapest level, volume correction, solver and number of substeps that were
/// measured to be enough for these drops and solids (docs/charts, made into src/simulation/measurements.cpp by
/// scripts/measurements). What the scene gave itself (Scene::given) is left as it is. Without an accuracy: what the
/// scene says.
///
/// The smallest drop at the start counts for time steps and edges. Figures of drops on solids count if a drop touches
/// one or something (gravity, a velocity, a source) may bring one there. Where no level is known to be enough,
/// is_met is false and the level that came nearest is taken. Level::paper is never chosen: it reads nothing of the
/// liquid. Reads nothing but its arguments: the same scene, the same choice.
ModelChoice choose_model(const Scene& scene, const std::vector<Drop>& drops, const std::vector<Solid>& solids);

/// The scene that says itself what was chosen for it: no accuracy, and the same steps to the bit.
Scene with_choice(Scene scene, const ModelChoice& choice);

}  // namespace meniscus
