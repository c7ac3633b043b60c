// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/topology/split.h"
#include "meniscus/topology/merge_meshes.h"

#include "command.h"
#include "meniscus/core/error.h"
#include "mesh_files.h"
#include "report.h"

#include <array>
#include <sstream>

namespace meniscus::tools {
namespace {

struct SplitOptions {
  CommonOptions common;
  std::string input, output, plane, cutter;
  std::optional<double> neck;
};

constexpr const char* placeholder = "{}";

void check_pattern(const SplitOptions& options) {
  const std::size_t first = options.output.find(placeholder);
  if (first == std::string::npos || options.output.find(placeholder, first + 1) != std::string::npos)
    throw UsageError(fmt::format(
        "--output: \"{}\" must hold {{}} once, where the piece's number goes, as in out_{{}}.ply", options.output));
  format_of(options.output);
}

std::string piece_name(const SplitOptions& options, std::size_t piece) {
  std::string file = options.output;
  return file.replace(file.find(placeholder), 2, std::to_string(piece));
}

/// nx,ny,nz,d as four numbers.
std::array<double, 4> parse_plane(const std::string& text) {
  std::array<double, 4> plane{};
  std::istringstream words(text);
  std::string word;
  std::size_t k = 0;
  while (std::getline(words, word, ',') && k < 4) plane[k++] = parse_number("--plane", word);
  if (k != 4 || words.good())
    throw UsageError(fmt::format("--plane: \"{}\" must be four numbers, as in 0,0,1,0.5", text));
  return plane;
}

/// The mesh that cuts: the one in --cutter, or all that lies below --plane.
MeshData cutter_of(const MeshData& data, const SplitOptions& options, Report& report) {
  if (options.cutter.empty()) {
    const auto [x, y, z, d] = parse_plane(options.plane);
    return half_space(data, {x, y, z}, d);
  }
  MeshData cutter = read_input(options.cutter, options.common);
  report.add_input(options.cutter, cutter);
  return cutter;
}

/// The components inside and outside the cutter, those inside first.
std::vector<MeshData> cut(const MeshData& data, const SplitOptions& options, Report& report) {
  const MeshData cutter = cutter_of(data, options, report);
  MeshMergeReport merged;
  const auto parts = report.timed([&] {
    try {
      return divide(data, cutter, {}, merged);
    } catch (const GeometryError&) {
      naming(options.input, [&] { require_sound(data); });
      naming(options.cutter, [&] { require_sound(cutter); });
      throw;
    }
  });
  report.add("retries", merged.retries);
  report.add("shift", merged.shift);
  if (!parts) {
    report.set_reason(name(merged.refusal));
    throw GeometryError(shown_name(options.input) + ": " + merged.message);
  }
  std::vector<MeshData> pieces;
  for (const MeshData* part : {&parts->first, &parts->second})
    if (!part->triangles.empty())
      for (const Mesh& piece : connected_components(to_mesh(*part)))
        pieces.push_back(to_mesh_data(piece, part->attributes));
  return pieces;
}

std::vector<MeshData> separate(const MeshData& data, const SplitOptions& options, Report& report, CutReport& cuts) {
  std::vector<MeshData> pieces;
  const std::vector<Mesh> meshes = report.timed([&] {
    Drop drop = to_drop(data, options.input);
    if (options.neck) cuts = naming(options.input, [&] { return cut_necks(drop, *options.neck); });
    return connected_components(drop.mesh());
  });
  pieces.reserve(meshes.size());
  for (const Mesh& mesh : meshes) pieces.push_back(to_output(mesh, data, meshes.size() == 1 && cuts.cuts == 0));
  return pieces;
}

std::string describe(std::size_t pieces, const CutReport& cuts) {
  return fmt::format("{} {}, {} cut", pieces, pieces == 1 ? "piece" : "pieces",
                     cuts.cuts == 1 ? "1 neck" : fmt::format("{} necks", cuts.cuts));
}

int split(const SplitOptions& options) {
  const bool is_cut = !options.plane.empty() || !options.cutter.empty();
  if (!options.plane.empty()) parse_plane(options.plane);  // throws before anything is read
  check_pattern(options);
  return run_reported(options.common, [&](Report& report) {
    const MeshData data = read_input(options.input, options.common);
    report.add_input(options.input, data);
    CutReport cuts;
    const std::vector<MeshData> pieces = is_cut ? cut(data, options, report) : separate(data, options, report, cuts);
    report.add("cuts", cuts.cuts);
    report.add("cuts_refused", cuts.refused);
    report.add("pieces", pieces.size());
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      report.add_output(piece_name(options, k), pieces[k]);
      write_output(piece_name(options, k), pieces[k], options.common);
    }
    options.common.console().say(describe(pieces.size(), cuts));
    if (cuts.refused > 0)
      options.common.console().say(
          fmt::format("warning: {} thin places could not be cut soundly and were left as they are", cuts.refused));
  });
}

}  // namespace

void add_split(CLI::App& app, Run& run) {
  const auto options = std::make_shared<SplitOptions>();
  CLI::App* verb =
      add_verb(app,
               {"split",
                "Write each connected component of a closed mesh to a file of its own, after cutting it along a plane, "
                "another mesh or across thin necks if asked to. All pieces are closed.",
                {"meniscus split dumbbell.off -o 'half_{}.off' --neck 0.05",
                 "meniscus split drop.ply -o 'part_{}.ply' --plane 0,0,1,0.1"}},
               options->common);
  verb->add_option("IN", options->input, "Closed mesh (.ply, .off, .obj, .stl), or - for stdin")->required();
  add_output(*verb, options->output, "Meshes to write; {} becomes 0, 1, ... in the order of first vertices")
      ->type_name("'OUT_{}.ply'");
  add_positive(*verb, "--neck", options->neck, "cm", "Cut necks thinner than this diameter (default: none)");
  CLI::Option* neck = verb->get_option("--neck");
  CLI::Option* plane =
      verb->add_option("--plane", options->plane, "Cut along the plane of the points x with n.x = d (n of any length)");
  plane->type_name("nx,ny,nz,d")->excludes(neck);
  verb->add_option("--cutter", options->cutter,
                   "Cut along the surface of a closed mesh; the pieces inside it come first")
      ->type_name("MESH")
      ->excludes(neck)
      ->excludes(plane);
  add_format(*verb, options->common);
  verb->callback([=, &run] { run = [=] { return split(*options); }; });
}

}  // namespace meniscus::tools
