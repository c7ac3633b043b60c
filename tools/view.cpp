// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.h"
#include "meniscus/core/error.h"
#include "meniscus/frames/frame_time.h"
#include "meniscus/io/read_mesh.h"
#include "meniscus/io/write_file_atomically.h"
#include "page.h"
#include "report.h"

namespace meniscus::tools {

#ifdef MENISCUS_VIEWER
std::vector<std::string> page_pieces();  // made by tools/viewer/build.mjs
#else
static std::vector<std::string> page_pieces() {
  throw UsageError("view: this program was built without the page; configure with -DMENISCUS_VIEWER=ON (needs Node)");
}
#endif

namespace {

namespace fs = std::filesystem;

struct ViewOptions {
  CommonOptions common;
  std::vector<std::string> inputs;
  std::string html, title;
};

/// "splash" of "out/splash/".
std::string last_name(const fs::path& path) {
  const fs::path whole = fs::absolute(path).lexically_normal();
  return (whole.has_filename() ? whole : whole.parent_path()).filename().string();
}

PageInput read_run(const fs::path& directory, const Console& console) {
  PageInput input;
  input.title = last_name(directory);
  input.frames = find_frames(directory);
  if (input.frames.empty())
    throw FileError(
        fmt::format("{}: holds no frames (frame_0000.ply, ...); write some with meniscus evolve SCENE -o {}",
                    directory.string(), directory.string()));
  input.timed = frame_time(read_mesh(input.frames.front())).has_value();
  input.scene = read_run_scene(directory, console);
  return input;
}

PageInput list_meshes(const std::vector<std::string>& files) {
  PageInput input;
  input.title = files.size() == 1 ? last_name(files.front()) : fmt::format("{} meshes", files.size());
  for (const std::string& file : files) {
    if (fs::is_directory(file))
      throw UsageError(fmt::format("{}: give either one directory of frames, or meshes", file));
    format_of(file);
    if (!fs::exists(file)) throw FileError(file + ": there is no such file; correct the name");
    input.frames.emplace_back(file);
  }
  return input;
}

/// A page or report must not replace a frame that it shows.
void check_frames_survive(const std::vector<fs::path>& frames, const std::string& output) {
  for (const fs::path& frame : frames)
    if (is_same_file(frame, output))
      throw UsageError(fmt::format("{}: is a frame that would be lost; choose another name", output));
}

int view(const ViewOptions& options) {
  const std::vector<std::string> pieces = page_pieces();
  const double start = seconds_now();
  PageInput input = options.inputs.size() == 1 && fs::is_directory(options.inputs.front())
                        ? read_run(options.inputs.front(), options.common.console())
                        : list_meshes(options.inputs);
  for (const std::string& output : {options.html, options.common.json}) check_frames_survive(input.frames, output);
  if (!options.title.empty()) input.title = options.title;
  PageReport page;
  const std::string html = make_page(input, pieces, page);
  options.html == "-" ? write_stdout(html) : write_file_atomically(options.html, html);
  write_report({{"status", "ok"},
                {"frames", page.frames},
                {"max_triangles", page.max_triangles},
                {"topologies", page.topologies},
                {"solids", input.scene.solids.size()},
                {"bytes", html.size()},
                {"seconds", seconds_now() - start}},
               options.common);
  options.common.console().say(fmt::format("{}: {} frames, up to {} triangles, {:.1f} MB", options.html, page.frames,
                                           page.max_triangles, 1e-6 * static_cast<double>(html.size())));
  return done;
}

}  // namespace

void add_view(CLI::App& app, Run& run) {
  const auto options = std::make_shared<ViewOptions>();
  CLI::App* verb = add_verb(
      app,
      {"view",
       "Write one HTML page that plays frames. It opens offline in a browser with WebGL 2. "
       "Meshes are frames of their own, in the order given.",
       {"meniscus view out/splash --html splash.html", "meniscus view before.off after.off --html compare.html"}},
      options->common);
  verb->add_option("DIR", options->inputs, "A directory of frames, or meshes (.ply, .off, .obj, .stl)")->required();
  verb->add_option("--html", options->html, "The page to write, or - for stdout")->required()->type_name("FILE");
  verb->add_option("--title", options->title, "What the page is called (default: the directory's or mesh's name)")
      ->type_name("TEXT");
  verb->callback([=, &run] { run = [=] { return view(*options); }; });
}

}  // namespace meniscus::tools
