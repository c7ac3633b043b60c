// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.h"
#include "meniscus/core/error.h"
#include "mesh_files.h"
#include "report.h"

namespace meniscus::tools {
namespace {

struct ConvertOptions {
  CommonOptions common;
  std::string input, output;
  std::optional<MeshFormat> output_format;
  bool text = false;
};

int convert(const ConvertOptions& options) {
  CommonOptions output = options.common;
  if (options.output_format) output.format = options.output_format;
  check_output(options.output, output);
  return run_reported(options.common, [&](Report& report) {
    const MeshData data = report.timed([&] { return read_input(options.input, options.common); });
    report.add_input(options.input, data);
    report.timed([&] { write_output(options.output, data, output, {!options.text}); });
    if (options.common.has_report()) report.add_output(options.output, data);
  });
}

}  // namespace

void add_convert(CLI::App& app, Run& run) {
  const auto options = std::make_shared<ConvertOptions>();
  CLI::App* verb =
      add_verb(app,
               {"convert",
                "Read a mesh in one format, write it in another. Nothing is repaired; attributes (velocity, "
                "drop, ...) and comments are kept where the format can hold them, which is PLY.",
                {"meniscus convert drop.off drop.ply", "cat drop.stl | meniscus convert --format stl - drop.obj"}},
               options->common);
  verb->add_option("IN", options->input, "Mesh (.ply, .off, .obj, .stl), or - for stdin")->required();
  verb->add_option("OUT", options->output, "Mesh to write, or - for stdout")->required();
  add_format(*verb, options->common);
  verb->add_option_function<std::string>(
          "--output-format", [options](const std::string& name) { options->output_format = parse_format(name); },
          "Format of stdout, where it is not that of stdin")
      ->type_name("FORMAT");
  verb->add_flag("--text", options->text, "Write PLY and STL as text rather than binary");
  verb->callback([=, &run] { run = [=] { return convert(*options); }; });
}

}  // namespace meniscus::tools
