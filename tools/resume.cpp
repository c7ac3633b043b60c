// SPDX-License-Identifier: GPL-3.0-or-later
#include "resume.h"

#include "meniscus/core/error.h"
#include "meniscus/core/version.h"
#include "meniscus/frames/checkpoint_archive.h"
#include "meniscus/frames/checkpoint_file.h"
#include "meniscus/io/read_file.h"
#include "meniscus/scene/read_scene.h"
#include "meniscus/scene/write_scene.h"

#include <nlohmann/json.hpp>

namespace meniscus::tools {
namespace {

using Json = nlohmann::json;

/// The values that describe_run wrote.
struct RunDescription {
  std::string version, scene, file, directory;
  std::vector<std::string> inputs;

  template <class Self, class Archive>
  static void visit(Self& self, Archive& archive) {
    archive("version", self.version);
    archive("scene", self.scene);
    archive("file", self.file);
    archive("directory", self.directory);
    archive("inputs", self.inputs);
  }
};

std::unique_ptr<ResumePoint> read_point(const std::filesystem::path& file) {
  auto state = std::make_shared<const Json>(decode_checkpoint(read_file(file), file.string()));
  CheckpointReader read(*state, file.string());
  RunDescription run;
  read("run", run);
  if (run.version != version())
    throw FileError(fmt::format("{}: was written by meniscus {}; this is {}: start over, or use that version",
                                file.string(), run.version, version()));
  auto point = std::make_unique<ResumePoint>();
  point->scene = parse_scene(run.scene, file.string(), run.directory);
  point->scene.file = run.file;
  point->file = file;
  point->state = std::move(state);
  point->inputs = std::move(run.inputs);
  return point;
}

}  // namespace

Json describe_run(const Scene& scene, const std::vector<std::string>& inputs) {
  const RunDescription run{version(), resolved_scene(scene), scene.file.string(), scene.directory.string(), inputs};
  CheckpointWriter writer;
  RunDescription::visit(run, writer);
  return writer.state();
}

std::unique_ptr<ResumePoint> find_resume_point(const std::filesystem::path& directory, const Console& console) {
  std::string damaged;
  for (const std::filesystem::path& file : find_checkpoints(directory)) {
    try {
      return read_point(file);
    } catch (const FileError& error) {
      damaged = error.what();
      console.say(damaged);
    }
  }
  if (!damaged.empty())
    throw FileError(directory.string() + ": holds no checkpoint that is whole; start over with --overwrite");
  return nullptr;
}

void check_same_scene(const ResumePoint& point, const Scene& scene) {
  Json theirs = Json::parse(resolved_scene(point.scene)), ours = Json::parse(resolved_scene(scene));
  theirs.erase("frames");
  ours.erase("frames");
  const Json differences = Json::diff(theirs, ours);
  if (!differences.empty())
    throw UsageError(
        fmt::format("--resume: the run in {} has another scene: {} differs; leave the scene out to go on "
                    "with its own, or start over with --overwrite",
                    point.file.parent_path().string(), differences[0]["path"].get<std::string>()));
}

bool is_run_complete(const std::filesystem::path& directory) {
  if (!std::filesystem::exists(directory / "run.json")) return false;
  const Json run = Json::parse(read_file(directory / "run.json"), nullptr, false);
  return run.is_object() && run.value("status", "") == "ok";
}

}  // namespace meniscus::tools
