// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "command.h"
#include "meniscus/frames/frame_writer.h"
#include "meniscus/scene/scene.h"
#include "meniscus/state/drop.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace meniscus::tools {

/// A run that is ready to go.
struct RunPlan {
  std::filesystem::path output;  ///< the directory of frames
  FrameOptions frame_options;
  std::vector<std::string> inputs;  ///< as on the command line
  Scene scene;
  std::optional<std::vector<Drop>> drops;  ///< instead of the scene's
  std::int64_t steps = 0;
  bool dry_run = false;
};

/// Runs it: steps, frames, measures.csv, run.json, report, progress line. SIGINT and SIGTERM end it
/// after the step at hand; a second one at once. Returns the exit code.
/// Throws whatever the simulation throws, after run.json was written.
int run_evolution(RunPlan plan, const CommonOptions& common);

}  // namespace meniscus::tools
