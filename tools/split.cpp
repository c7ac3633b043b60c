// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/topology/split.h"

#include "command.h"
#include "meniscus/core/error.h"
#include "mesh_files.h"
#include "report.h"

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

int split(const SplitOptions& options) {
  if (!options.plane.empty() || !options.cutter.empty())
    throw UsageError(fmt::format("--{}: comes with merge in a later version; use --neck, or nothing for components",
                                 options.plane.empty() ? "cutter" : "plane"));
  check_pattern(options);
  return run_reported(options.common, [&](Report& report) {
    const MeshData data = read_input(options.input, options.common);
    report.add_input(options.input, data);
    CutReport cut;
    const std::vector<Mesh> pieces = report.timed([&] {
      Drop drop = to_drop(data, options.input);
      if (options.neck) cut = naming(options.input, [&] { return cut_necks(drop, *options.neck); });
      return connected_components(drop.mesh());
    });
    report.add("cuts", cut.cuts);
    report.add("cuts_refused", cut.refused);
    report.add("pieces", pieces.size());
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      const MeshData piece = to_output(pieces[k], data, pieces.size() == 1 && cut.cuts == 0);
      report.add_output(piece_name(options, k), piece);
      write_output(piece_name(options, k), piece, options.common);
    }
    options.common.console().say(fmt::format("{} {}, {} cut", pieces.size(), pieces.size() == 1 ? "piece" : "pieces",
                                             cut.cuts == 1 ? "1 neck" : fmt::format("{} necks", cut.cuts)));
    if (cut.refused > 0)
      options.common.console().say(
          fmt::format("warning: {} thin places could not be cut soundly and were left as they are", cut.refused));
  });
}

}  // namespace

void add_split(CLI::App& app, Run& run) {
  const auto options = std::make_shared<SplitOptions>();
  CLI::App* verb = add_verb(
      app,
      {"split",
       "Write each connected component of a closed mesh to a file of its own, after cutting and "
       "closing thin necks if asked to.",
       {"meniscus split spray.ply -o 'drop_{}.ply'", "meniscus split dumbbell.off -o 'half_{}.off' --neck 0.05"}},
      options->common);
  verb->add_option("IN", options->input, "Closed mesh (.ply, .off, .obj, .stl), or - for stdin")->required();
  add_output(*verb, options->output, "Meshes to write; {} becomes 0, 1, ... in the order of first vertices")
      ->type_name("'OUT_{}.ply'");
  add_positive(*verb, "--neck", options->neck, "cm", "Cut necks thinner than this diameter (default: none)");
  verb->add_option("--plane", options->plane, "Comes in a later version")->type_name("nx,ny,nz,d");
  verb->add_option("--cutter", options->cutter, "Comes in a later version")->type_name("MESH");
  add_format(*verb, options->common);
  verb->callback([=, &run] { run = [=] { return split(*options); }; });
}

}  // namespace meniscus::tools
