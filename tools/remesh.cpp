// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/topology/remesh.h"

#include "command.h"
#include "meniscus/core/error.h"
#include "meniscus/topology/remesh_isotropic.h"
#include "mesh_files.h"
#include "report.h"

namespace meniscus::tools {
namespace {

struct RemeshVerbOptions {
  CommonOptions common;
  std::string input, output, method = "band";
  std::optional<double> edge_min, edge_max, edge, features, smoothing;
  int passes = 3;
};

constexpr double radians = 3.14159265358979323846 / 180;

EdgeBand band_of(const RemeshVerbOptions& options) {
  if (options.edge && (options.edge_min || options.edge_max))
    throw UsageError("--edge stands for a band of its own; give either --edge or --edge-min and --edge-max");
  if (!options.edge && !(options.edge_min && options.edge_max))
    throw UsageError("give the edges' lengths: --edge-min and --edge-max, or --edge (cm)");
  EdgeBand band;
  band.edge_min = options.edge ? *options.edge / 2 : *options.edge_min;
  band.edge_max = options.edge ? *options.edge * 1.5 : *options.edge_max;
  return band;
}

RemeshOptions library_options(const RemeshVerbOptions& options) {
  RemeshOptions remesh;
  remesh.band = band_of(options);
  remesh.max_passes = options.passes;
  remesh.smoothing = options.smoothing.value_or(0);
  if (options.features && *options.features > 180)
    throw UsageError(fmt::format("--features: faces turn by at most 180 degrees, not by {}", *options.features));
  if (options.features) remesh.feature_angle = *options.features * radians;
  check_options(remesh);
  return remesh;
}

void add_counts(Report& report, const RemeshReport& remesh) {
  report.add("splits", remesh.splits);
  report.add("collapses", remesh.collapses);
  report.add("flips", remesh.flips);
  report.add("lifts", remesh.lifts);
  report.add("cuts", remesh.cuts);
  report.add("passes", remesh.passes);
  report.add("retries", remesh.retries);
  report.add("edges_below", remesh.edges_below);
  report.add("edges_above", remesh.edges_above);
  const RefusedEdges& refused = remesh.refused;
  report.add("refused", {{"link_condition", refused.link_condition},
                         {"would_invert", refused.would_invert},
                         {"would_be_sliver", refused.would_be_sliver},
                         {"would_be_long", refused.would_be_long},
                         {"valence", refused.valence},
                         {"feature", refused.feature},
                         {"contact_line", refused.contact_line},
                         {"near_intersection", refused.near_intersection}});
}

std::string describe(const RemeshReport& remesh, double volume_change) {
  return fmt::format(
      "{} splits, {} collapses, {} flips, {} cuts; {} edges left below the band, {} above; volume {:+.2g} %",
      remesh.splits, remesh.collapses, remesh.flips, remesh.cuts, remesh.edges_below, remesh.edges_above,
      100 * volume_change);
}

MeshData remesh_by_band(const MeshData& data, const RemeshVerbOptions& options, Report& report) {
  Drop drop = to_drop(data, options.input);
  const double volume = drop.volume();
  const RemeshReport result = report.timed(
      [&] { return naming(options.input, [&] { return remesh_to_band(drop, library_options(options)); }); });
  add_counts(report, result);
  options.common.console().say(describe(result, drop.volume() / volume - 1));
  return to_output(drop.mesh(), data, result.cuts == 0);
}

MeshData remesh_by_cgal(const MeshData& data, const RemeshVerbOptions& options, Report& report) {
  const RemeshOptions remesh = library_options(options);
  const double target = (remesh.band.edge_min + remesh.band.edge_max) / 2;
  Mesh mesh = to_drop(data, options.input).mesh();
  report.timed(
      [&] { naming(options.input, [&] { remesh_isotropic(mesh, target, remesh.max_passes, remesh.feature_angle); }); });
  report.add("passes", remesh.max_passes);
  return to_output(mesh, data, true);
}

int remesh_file(const RemeshVerbOptions& options) {
  check_output(options.output, options.common);
  library_options(options);  // throws before anything is read
  return run_reported(options.common, [&](Report& report) {
    const MeshData data = read_input(options.input, options.common);
    report.add_input(options.input, data);
    report.add("method", options.method);
    const MeshData result =
        options.method == "band" ? remesh_by_band(data, options, report) : remesh_by_cgal(data, options, report);
    report.add_output(options.output, result);
    write_output(options.output, result, options.common);
  });
}

}  // namespace

void add_remesh(CLI::App& app, Run& run) {
  const auto options = std::make_shared<RemeshVerbOptions>();
  CLI::App* verb =
      add_verb(app,
               {"remesh",
                "Split, collapse and flip edges until their lengths lie in a band. Velocity and other vertex "
                "attributes are carried over. The mesh must be closed.",
                {"meniscus remesh drop.ply -o even.ply --edge-min 0.04 --edge-max 0.12",
                 "meniscus remesh box.off -o fine.off --edge 0.02 --features 40"}},
               options->common);
  verb->add_option("IN", options->input, "Closed mesh (.ply, .off, .obj, .stl), or - for stdin")->required();
  add_output(*verb, options->output, "Mesh to write, or - for stdout")->type_name("OUT");
  add_positive(*verb, "--edge-min", options->edge_min, "cm", "Shortest edge, less than half of --edge-max");
  add_positive(*verb, "--edge-max", options->edge_max, "cm", "Longest edge");
  add_positive(*verb, "--edge", options->edge, "cm", "The band from half of this to one and a half times it");
  verb->add_option("--method", options->method, "band: ours; isotropic: CGAL's, to the middle of the band")
      ->capture_default_str()
      ->type_name("METHOD")
      ->check(CLI::IsMember({"band", "isotropic"}));
  add_positive(*verb, "--features", options->features, "DEGREES",
               "Keep edges whose faces turn by more (default: none)");
  verb->add_option("--passes", options->passes, "Rounds of split, collapse and flip")
      ->capture_default_str()
      ->type_name("N")
      ->check(CLI::Range(1, 1000));
  add_positive(*verb, "--smoothing", options->smoothing, "SHARE",
               "Share of the way to the neighbours' centre that vertices slide a pass, at most 1 (default: 0)");
  add_format(*verb, options->common);
  verb->callback([=, &run] { run = [=] { return remesh_file(*options); }; });
}

}  // namespace meniscus::tools
