// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "command.h"
#include "meniscus/frames/frame_writer.h"
#include "meniscus/io/directory_lock.h"
#include "meniscus/scene/scene.h"
#include "meniscus/state/drop.h"
#include "resume.h"

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
  std::vector<std::string> solids;  ///< solid_checksums when the run began
  Scene scene;
  std::optional<std::vector<Drop>> drops;  ///< instead of the scene's
  std::int64_t steps = 0;
  int checkpoint_every = 10;  ///< frames; 0: only if the run is interrupted
  bool verify = false;        ///< ask the independent judge after each step
  bool dry_run = false;
  bool is_complete = false;             ///< `output` holds the whole run; nothing is to be done
  bool overwrite = false;               ///< an interrupted run that lies in `output`
  std::optional<DirectoryLock> lock;    ///< on `output`; run_evolution takes it if nobody has before
  std::unique_ptr<ResumePoint> resume;  ///< or nullptr: from the start
};

/// Runs it: steps, frames, measures.csv, run.json, report, progress line. SIGINT and SIGTERM end it
/// after the step at hand, with a checkpoint; a second one at once. Returns the exit code.
/// Throws whatever the simulation throws, after run.json was written.
int run_evolution(RunPlan plan, const CommonOptions& common);

}  // namespace meniscus::tools
