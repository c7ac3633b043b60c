// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.h"
#include "meniscus/core/error.h"
#include "meniscus/frames/frame_time.h"
#include "meniscus/frames/write_sequence.h"
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

/// The format of a file that only frames are written as; nothing for meshes.
std::optional<FrameFormat> animation_format(const std::string& file) {
  const std::string extension = std::filesystem::path(file).extension().string();
  const std::optional<FrameFormat> format = find_frame_format(extension.empty() ? extension : extension.substr(1));
  const bool is_ours = format == FrameFormat::vtp || format == FrameFormat::glb || format == FrameFormat::usda;
  return is_ours ? format : std::nullopt;
}

/// A directory of frames as one file that plays them.
int convert_frames(const ConvertOptions& options) {
  const std::optional<FrameFormat> format = animation_format(options.output);
  if (!format) throw UsageError(options.output + ": of a directory of frames, .usda or .glb can be made");
  const std::vector<std::filesystem::path> frames = find_frames(options.input);
  if (frames.empty()) throw FileError(options.input + ": holds no frames (frame_0000.ply, ...)");
  const double start = seconds_now();
  write_sequence(options.output, *format, frames);
  write_report({{"status", "ok"}, {"frames", frames.size()}, {"seconds", seconds_now() - start}}, options.common);
  return done;
}

/// A mesh as a frame for other programs.
int convert_frame(const ConvertOptions& options, FrameFormat format) {
  return run_reported(options.common, [&](Report& report) {
    const MeshData data = report.timed([&] { return read_input(options.input, options.common); });
    report.add_input(options.input, data);
    report.timed([&] {
      naming(options.input, [&] { write_frame(options.output, format, data, frame_time(data).value_or(0)); });
    });
    if (options.common.has_report()) report.add_output(options.output, data);
  });
}

int convert(const ConvertOptions& options) {
  if (options.input != "-" && std::filesystem::is_directory(options.input)) return convert_frames(options);
  if (const auto format = animation_format(options.output)) return convert_frame(options, *format);
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
                "drop, ...) and comments are kept where the format can hold them: all in PLY, velocity, drop and "
                "contact in VTP, GLB and USDA, which are written only. A directory of frames becomes one animation.",
                {"meniscus convert drop.off drop.ply", "meniscus convert out/splash splash.usda"}},
               options->common);
  verb->add_option("IN", options->input, "Mesh (.ply, .off, .obj, .stl), directory of frames, or - for stdin")
      ->required();
  verb->add_option("OUT", options->output, "Mesh to write (.vtp, .glb, .usda too), or - for stdout")->required();
  add_format(*verb, options->common);
  verb->add_option_function<std::string>(
          "--output-format", [options](const std::string& name) { options->output_format = parse_format(name); },
          "Format of stdout, where it is not that of stdin")
      ->type_name("FORMAT");
  verb->add_flag("--text", options->text, "Write PLY and STL as text rather than binary");
  verb->callback([=, &run] { run = [=] { return convert(*options); }; });
}

}  // namespace meniscus::tools
