// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/topology/merge_meshes.h"

#include "command.h"
#include "meniscus/core/error.h"
#include "mesh_files.h"
#include "report.h"

#include <algorithm>
#include <filesystem>
#include <map>

namespace meniscus::tools {
namespace {

struct MergeVerbOptions {
  CommonOptions common;
  std::vector<std::string> inputs;
  std::string output, save_failing;
  std::string operation = "union";
  bool repair = false, fill_cavities = false;
  double max_shift = BooleanOptions{}.max_shift;
};

const std::map<std::string, BooleanOperation> operations = {{"union", BooleanOperation::unite},
                                                            {"intersection", BooleanOperation::intersect},
                                                            {"difference", BooleanOperation::subtract}};

/// Target volumes are those of single drops: they mean nothing after a merge.
void drop_targets(MeshData& data) {
  const auto is_target = [](const std::string& c) { return c.find(" target_volume ") != std::string::npos; };
  data.comments.erase(std::remove_if(data.comments.begin(), data.comments.end(), is_target), data.comments.end());
}

void save_failing(const std::string& directory, const std::pair<MeshData, MeshData>& pair, const Console& console) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) throw FileError(directory + ": cannot be made: " + error.message());
  const std::filesystem::path base(directory);
  write_mesh(base / "a.ply", pair.first);
  write_mesh(base / "b.ply", pair.second);
  console.say(directory + ": the pair that was refused, as a.ply and b.ply");
}

void add_counts(Report& report, const MeshMergeReport& merge) {
  report.add("outcome", name(merge.outcome));
  report.add("step", name(merge.step));
  report.add("joins", merge.joins);
  report.add("crossings", merge.crossings);
  report.add("retries", merge.retries);
  report.add("shift", merge.shift);
}

[[noreturn]] void refuse(const MergeVerbOptions& options, const MeshMergeReport& merge, Report& report) {
  report.set_reason(name(merge.refusal));
  if (!options.save_failing.empty() && merge.failed)
    save_failing(options.save_failing, *merge.failed, options.common.console());
  throw GeometryError(fmt::format("{} and {}: {}", shown_name(options.inputs[merge.first]),
                                  shown_name(options.inputs[merge.second]), merge.message));
}

/// Mends a mesh if asked to; throws GeometryError if it is not sound then.
void prepare(MeshData& mesh, const MergeVerbOptions& options) {
  if (options.repair && !inspect(mesh).sound) mesh = repair_soup(mesh);
  require_sound(mesh);
}

int merge(const MergeVerbOptions& options) {
  check_output(options.output, options.common);
  return run_reported(options.common, [&](Report& report) {
    std::vector<MeshData> meshes;
    for (const auto& file : options.inputs) {
      meshes.push_back(read_input(file, options.common));
      report.add_input(file, meshes.back());
    }
    report.add("operation", options.operation);
    BooleanOptions boolean;
    boolean.max_shift = options.max_shift;
    boolean.keep_cavities = !options.fill_cavities;
    MeshMergeReport merged;
    auto result = report.timed([&] {
      for (std::size_t k = 0; k < meshes.size(); ++k) naming(options.inputs[k], [&] { prepare(meshes[k], options); });
      return merge_meshes(meshes, operations.at(options.operation), boolean, merged);
    });
    add_counts(report, merged);
    if (!result) refuse(options, merged, report);
    if (result->triangles.empty()) {
      report.set_reason("empty_result");
      throw GeometryError(fmt::format("the {} is empty: there is nothing to write", options.operation));
    }
    drop_targets(*result);
    report.add_output(options.output, *result);
    write_output(options.output, *result, options.common);
    std::string text = fmt::format("{} joins, {} of surfaces that meet; {} vertices, {} faces", merged.joins,
                                   merged.crossings, result->points.size(), result->triangles.size());
    if (merged.shift > 0) text += fmt::format("; meshes moved by up to {:.1e} cm", merged.shift);
    options.common.console().say(text);
  });
}

}  // namespace

void add_merge(CLI::App& app, Run& run) {
  const auto options = std::make_shared<MergeVerbOptions>();
  CLI::App* verb = add_verb(app,
                            {"merge",
                             "Unite closed meshes to one, or take what they have in common, or the first less the "
                             "rest. Vertex attributes are carried over. What cannot be done soundly is refused.",
                             {"meniscus merge a.ply b.ply c.ply -o one.ply",
                              "meniscus merge block.off hole.off -o rest.off --operation difference"}},
                            options->common);
  verb->add_option("IN", options->inputs, "Closed meshes (.ply, .off, .obj, .stl); - for stdin, once")->required();
  add_output(*verb, options->output, "Mesh to write, or - for stdout")->type_name("OUT");
  verb->add_option("--operation", options->operation, "union, intersection, or difference: the first less the rest")
      ->capture_default_str()
      ->type_name("OPERATION")
      ->check(CLI::IsMember({"union", "intersection", "difference"}));
  verb->add_flag("--repair", options->repair,
                 "Mend inputs that are not sound first: weld, orient, fill holes, unite overlapping components");
  verb->add_flag("--fill-cavities", options->fill_cavities, "Drop air that is shut in");
  verb->add_option("--max-shift", options->max_shift,
                   "How far a mesh may be moved where nothing else helps, as a share of its size; 0: never")
      ->capture_default_str()
      ->type_name("SHARE")
      ->check(CLI::Range(0.0, 1e-3));
  verb->add_option("--save-failing", options->save_failing, "Where to write a pair that is refused")
      ->type_name("DIRECTORY");
  add_format(*verb, options->common);
  verb->callback([=, &run] { run = [=] { return merge(*options); }; });
}

}  // namespace meniscus::tools
