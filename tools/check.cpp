// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.h"
#include "meniscus/core/error.h"
#include "mesh_files.h"
#include "report.h"

#include <algorithm>

namespace meniscus::tools {
namespace {

struct CheckOptions {
  CommonOptions common;
  std::vector<std::string> files;
};

constexpr double degrees = 180 / 3.14159265358979323846;

std::string count(std::size_t n, const char* one, const char* many) {
  return fmt::format("{} {}", n, n == 1 ? one : many);
}

std::string ids(const char* what, const std::vector<std::size_t>& list) {
  return list.empty() ? std::string() : fmt::format("      {}: {}\n", what, fmt::join(list, " "));
}

std::string properties(const Inspection& i) {
  std::string text = i.closed ? "closed" : "not closed";
  text += i.manifold ? ", manifold" : ", not manifold";
  text += i.outward ? ", outward" : ", not outward";
  text += i.self_intersecting ? ", self-intersecting" : ", not self-intersecting";
  return text + (i.bounds_volume ? ", bounds a volume" : ", bounds no volume");
}

/// A paragraph for people.
std::string describe(const std::string& file, const Inspection& i, bool verbose) {
  std::string text = fmt::format("{}: {}\n", shown_name(file), i.sound ? "sound" : "NOT SOUND");
  text += fmt::format("  {}, {}, {}", count(i.vertices, "vertex", "vertices"), count(i.faces, "face", "faces"),
                      count(i.components, "component", "components"));
  text += i.genus ? fmt::format(", genus {}\n", *i.genus) : "\n";
  text += fmt::format("  {}\n", properties(i));
  text += fmt::format("  volume {:.6g} cm^3, area {:.6g} cm^2\n", i.volume, i.area);
  text += fmt::format("  edges {:.4g} / {:.4g} / {:.4g} cm (min / mean / max), angles {:.3g} to {:.4g} degrees\n",
                      i.edge_length.min, i.edge_length.mean, i.edge_length.max, i.angle.least * degrees,
                      i.angle.greatest * degrees);
  for (const Defect& defect : i.defects) {
    text += fmt::format("  {}: {}\n", name(defect.kind), defect.message);
    if (verbose) text += ids("faces", defect.faces) + ids("vertices", defect.vertices);
  }
  return text;
}

/// Checks one file: its exit code. A file that cannot be read does not keep the others from being checked.
int check_file(const std::string& file, const CheckOptions& options, Json& list) {
  try {
    const Inspection inspection = inspect(read_input(file, options.common));
    list.push_back(to_json(file, inspection));
    if (options.common.json != "-" && !options.common.quiet)
      write_stdout(describe(file, inspection, options.common.verbose));
    return inspection.sound ? done : defects_found;
  } catch (const FileError& error) {
    if (options.files.size() == 1) throw;
    say_error(error.what());
    list.push_back({{"file", shown_name(file)}, {"sound", false}, {"error", error.what()}});
    return 3;
  }
}

int check(const CheckOptions& options) {
  if (std::count(options.files.begin(), options.files.end(), "-") > 1)
    throw UsageError("-: stdin can be read only once");
  for (const std::string& file : options.files)  // before the first is read
    if (file != "-") format_of(file);
  Json list = Json::array();
  int code = done;
  for (const std::string& file : options.files) code = std::max(code, check_file(file, options, list));
  write_report(list, options.common);
  return code;
}

}  // namespace

void add_check(CLI::App& app, Run& run) {
  const auto options = std::make_shared<CheckOptions>();
  CLI::App* verb = add_verb(
      app,
      {"check",
       "Say whether each mesh is sound: closed, 2-manifold, outward, not self-intersecting, bounding a volume. "
       "Exit code 0: all are; 1: some are not; 3: some cannot be read.",
       {"meniscus check drop.ply", "meniscus check --json report.json frames/*.ply"}},
      options->common);
  verb->add_option("FILE", options->files, "Meshes (.ply, .off, .obj, .stl; lengths in cm), or - for stdin")
      ->required();
  add_format(*verb, options->common);
  verb->callback([=, &run] { run = [=] { return check(*options); }; });
}

}  // namespace meniscus::tools
