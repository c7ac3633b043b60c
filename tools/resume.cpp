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
  std::vector<std::string> inputs, solids;

  template <class Self, class Archive>
  static void visit(Self& self, Archive& archive) {
    archive("version", self.version);
    archive("scene", self.scene);
    archive("file", self.file);
    archive("directory", self.directory);
    archive("inputs", self.inputs);
    archive("solids", self.solids);
  }
};

std::string file_checksum(const std::filesystem::path& file) {
  const std::string bytes = read_file(file);
  return fmt::format("{:08x} {}", checksum(bytes), bytes.size());
}

std::unique_ptr<ResumePoint> read_point(const std::filesystem::path& file) {
  auto state = std::make_shared<const Json>(decode_checkpoint(read_file(file), file.string()));
  CheckpointReader read(*state, file.string());
  RunDescription run;
  read("run", run);
  if (run.version != version())
    throw FileError(fmt::format("{}: was written by meniscus {}; this is {}: start over, or use that version",
                                file.string(), run.version, version()));
  auto point = std::make_unique<ResumePoint>();
  point->scene = parse_scene(run.scene, file.string(), run.directory, {}, SceneFiles::not_looked_for);
  point->scene.file = run.file;
  point->file = file;
  point->state = std::move(state);
  point->inputs = std::move(run.inputs);
  point->solids = std::move(run.solids);
  return point;
}

/// Throws UsageError unless two resolved scenes are the same but for the number of frames.
void check_same(Json theirs, Json ours, const std::filesystem::path& directory) {
  theirs.erase("frames");
  ours.erase("frames");
  const Json differences = Json::diff(theirs, ours);
  if (!differences.empty())
    throw UsageError(
        fmt::format("--resume: the run in {} has another scene: {} differs; leave the scene out to go on "
                    "with its own, or start over with --overwrite",
                    directory.string(), differences[0]["path"].get<std::string>()));
}

/// A directory's run.json; an empty object if there is none that can be read.
Json read_report(const std::filesystem::path& directory) {
  if (!std::filesystem::exists(directory / "run.json")) return Json::object();
  const Json report = Json::parse(read_file(directory / "run.json"), nullptr, false);
  return report.is_object() ? report : Json::object();
}

}  // namespace

Json describe_run(const Scene& scene, const std::vector<std::string>& inputs, const std::vector<std::string>& solids) {
  const std::string directory = (std::filesystem::current_path() / scene.directory).lexically_normal().string();
  const RunDescription run{version(), resolved_scene(scene), scene.file.string(), directory, inputs, solids};
  CheckpointWriter writer;
  RunDescription::visit(run, writer);
  return writer.state();
}

std::vector<std::string> solid_checksums(const Scene& scene) {
  std::vector<std::string> sums;
  for (const SolidSpec& solid : scene.solids)
    if (solid.shape == SolidShape::mesh) sums.push_back(file_checksum(scene.locate(solid.file)));
  return sums;
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
  check_same(Json::parse(resolved_scene(point.scene)), Json::parse(resolved_scene(scene)), point.file.parent_path());
}

void check_same_solids(const ResumePoint& point, const Scene& scene) {
  std::size_t k = 0;
  for (const SolidSpec& solid : scene.solids) {
    if (solid.shape != SolidShape::mesh) continue;
    const std::filesystem::path file = scene.locate(solid.file);
    const bool is_there = std::filesystem::exists(file);
    if (is_there && k < point.solids.size() && file_checksum(file) == point.solids[k++]) continue;
    throw FileError(
        fmt::format("{}: {} since the run in {} began, which goes on with the mesh that was there; put it back, "
                    "name the scene where it lies now, or start over with --overwrite",
                    file.string(), is_there ? "has changed" : "is gone", point.file.parent_path().string()));
  }
}

bool is_run_complete(const std::filesystem::path& directory) {
  return read_report(directory).value("status", "") == "ok";
}

void check_asks_no_more(const std::filesystem::path& directory, const Scene* scene, std::optional<int> frames,
                        std::optional<std::int64_t> steps) {
  const Json report = read_report(directory), theirs = report.value("resolved_scene", Json::object());
  const Json ours = scene ? Json::parse(resolved_scene(*scene)) : theirs;
  check_same(theirs, ours, directory);
  const std::int64_t done = report.value("steps", std::int64_t{0});
  const std::int64_t in_frames =
      frames.value_or(ours.value("frames", 0)) * ours.value("steps_per_frame", std::int64_t{1});
  if (steps.value_or(in_frames) > done && (scene || frames || steps))
    throw UsageError(
        fmt::format("--resume: the run in {} is complete after {} steps and keeps no checkpoint to go on "
                    "from; leave --resume out to start over",
                    directory.string(), done));
}

}  // namespace meniscus::tools
