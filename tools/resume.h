// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "console.h"
#include "meniscus/scene/scene.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace meniscus::tools {

/// What a run goes on from.
struct ResumePoint {
  std::filesystem::path file;  ///< the checkpoint
  std::shared_ptr<const nlohmann::json> state;
  std::vector<std::string> inputs;  ///< of the command line that started the run
  std::vector<std::string> solids;  ///< solid_checksums when it started
  Scene scene;
};

/// What a checkpoint says beside the state: enough to go on without the files that the run began with (but
/// those of solids).
nlohmann::json describe_run(const Scene& scene, const std::vector<std::string>& inputs,
                            const std::vector<std::string>& solids);

/// One a solid that is a mesh: checksum and length of its file. Throws FileError if one cannot be read.
std::vector<std::string> solid_checksums(const Scene& scene);

/// The newest checkpoint in a directory that is whole, or nullptr. Warns of damaged ones; throws FileError if
/// there are only such.
std::unique_ptr<ResumePoint> find_resume_point(const std::filesystem::path& directory, const Console& console);

/// Throws UsageError, naming the first key that differs, unless the scene is the checkpoint's; the number of
/// frames may differ.
void check_same_scene(const ResumePoint& point, const Scene& scene);

/// Throws FileError unless the meshes of the scene's solids are what they were when the run began.
void check_same_solids(const ResumePoint& point, const Scene& scene);

/// Whether a directory's run.json tells of a run that came to its end.
bool is_run_complete(const std::filesystem::path& directory);

/// Throws UsageError if a complete run has another scene than this one (nullptr: none is given), or fewer steps than
/// are asked for now.
void check_asks_no_more(const std::filesystem::path& directory, const Scene* scene, std::optional<int> frames,
                        std::optional<std::int64_t> steps);

}  // namespace meniscus::tools
