// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/scene/scene.h"
#include "meniscus/simulation/step.h"

#include <string>

namespace meniscus {

const char* level_name(Level level);  ///< "paper", ... as scenes spell it

/// What `"model": "auto"` stands for in a scene.
struct LevelChoice {
  Level level = Level::calibrated;
  VolumeCorrectionMethod volume_correction = VolumeCorrectionMethod::global;
  SolverOptions solver;
  double longest_phase = default_longest_phase;  ///< StepOptions::longest_phase
  bool meets = true;                             ///< whether the tables say that it meets the scene's accuracy
  std::string why;                               ///< in a sentence or two
};

/// The cheapest level, volume correction, solver and substep that the measured
/// tables (src/simulation/measured_levels.h, from docs/charts) say meet
/// scene.accuracy:
/// - look: shapes at rest within 10 %,
/// - shape: shapes at rest within 1 % on the scene's mesh,
/// - motion: the frequency of mode 2 within 2 % and at least 0.8 of its
/// amplitude kept a period, and shapes if there
///   are solids.
/// Where nothing meets it, the most accurate, and `meets` is false. Looks at
/// the smallest drop of the scene.
LevelChoice choose_level(const Scene& scene);

/// The scene with "auto" replaced by what was chosen; others as they are.
StepOptions resolve_level(const Scene& scene, StepOptions options);

}  // namespace meniscus
