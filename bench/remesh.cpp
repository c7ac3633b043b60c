// SPDX-License-Identifier: GPL-3.0-or-later
// Remeshing beside CGAL's isotropic_remeshing, in one run: bench_remesh [--quick] [FILE...]
// Random runs of remesh and split before an independent judge: bench_remesh --stress [N [FIRST_SEED]]
#include "meniscus/topology/remesh.h"
#include "../tests/support/judge.h"
#include "../tests/support/random_shapes.h"
#include "meniscus/core/error.h"
#include "meniscus/topology/split.h"

#include <CGAL/Polygon_mesh_processing/IO/polygon_mesh_io.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <Eigen/Geometry>

#include <cstdlib>
#include <string>

namespace {

using namespace meniscus;

/// User CPU seconds of this process so far.
double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec) + 1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
}

struct Quality {
  double least_degrees = 180, share_under_30 = 0;
};

Quality quality_of(const Mesh& mesh) {
  Quality quality;
  std::size_t under = 0, all = 0;
  for (const auto h : mesh.halfedges()) {  // the corner at the target of each halfedge
    const Eigen::Vector3d x = to_eigen(mesh.point(mesh.target(h)));
    const Eigen::Vector3d u = to_eigen(mesh.point(mesh.source(h))) - x,
                          w = to_eigen(mesh.point(mesh.target(mesh.next(h)))) - x;
    const double degrees = std::atan2(u.cross(w).norm(), u.dot(w)) * 57.29577951308232;
    quality.least_degrees = std::min(quality.least_degrees, degrees);
    under += degrees < 30;
    ++all;
  }
  quality.share_under_30 = static_cast<double>(under) / static_cast<double>(all);
  return quality;
}

std::size_t out_of_band(const Mesh& mesh, const EdgeBand& band) {
  std::size_t count = 0;
  for (const auto e : mesh.edges()) {
    const auto h = mesh.halfedge(e);
    const double length = (to_eigen(mesh.point(mesh.target(h))) - to_eigen(mesh.point(mesh.source(h)))).norm();
    count += length < band.edge_min || length > band.edge_max;
  }
  return count;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// Median user seconds of `repeats` runs on copies of what `prepare` makes; `result` is the last one.
template <class Prepare, class Run>
double timed(int repeats, Prepare prepare, Run run, Mesh& result) {
  std::vector<double> seconds;
  for (int k = 0; k < repeats; ++k) {
    auto copy = prepare();
    const double start = cpu_seconds();
    run(copy);
    seconds.push_back(cpu_seconds() - start);
    if constexpr (std::is_same_v<decltype(copy), Drop>)
      result = copy.mesh();
    else
      result = copy;
  }
  return median(seconds);
}

std::string reasons(const RefusedEdges& r) {
  std::string text;
  const auto add = [&](const char* name, std::size_t count) {
    if (count > 0) text += fmt::format(" {} {}", count, name);
  };
  add("link condition", r.link_condition);
  add("would invert", r.would_invert);
  add("would be a sliver", r.would_be_sliver);
  add("would be long", r.would_be_long);
  add("valence", r.valence);
  add("near an intersection", r.near_intersection);
  return text.empty() ? "" : " (" + text.substr(1) + ")";
}

void print_row(const char* what, double seconds, const Mesh& mesh, const EdgeBand& band, const std::string& notes) {
  const Quality quality = quality_of(mesh);
  fmt::print("  {:22} {:8.1f} ms {:9} faces {:7} out of band  least {:5.1f} deg  under 30: {:.4f} %{}\n", what,
             1e3 * seconds, mesh.number_of_faces(), out_of_band(mesh, band), quality.least_degrees,
             100 * quality.share_under_30, notes);
}

void compare(const std::string& name, const Mesh& mesh, double scale, int repeats) {
  const double target = scale * random_shapes::mean_edge(mesh);
  RemeshOptions options;
  options.band = {0.5 * target, 1.5 * target, 1};
  options.max_passes = 10;
  options.smoothing = 0.5;
  fmt::print("{}, {} faces, target {} x the mean edge\n", name, mesh.number_of_faces(), scale);
  Mesh result;
  const Drop drop(mesh);
  RemeshReport report;
  const auto copy = [&] { return drop; };
  double ours = timed(
      repeats, copy, [&](Drop& d) { report = remesh(d, options); }, result);
  print_row("ours", ours, result, options.band, reasons(report.refused));
  const double checked = timed(
      repeats, copy, [&](Drop& d) { report = remesh_to_band(d, options); }, result);
  print_row("ours, checked", checked, result, options.band, reasons(report.refused));
  const double cgal = timed(
      repeats, [&] { return mesh; },
      [&](Mesh& m) {
        CGAL::Polygon_mesh_processing::isotropic_remeshing(m.faces(), target, m,
                                                           CGAL::parameters::number_of_iterations(3));
        m.collect_garbage();
      },
      result);
  print_row("CGAL isotropic, 3", cgal, result, options.band,
            fmt::format("  time ratio {:.3f}, checked {:.3f}", ours / cgal, checked / cgal));
}

void unchanged(const std::string& name, const Mesh& mesh) {
  Drop drop(mesh);
  const double h = random_shapes::mean_edge(mesh);
  RemeshOptions options;
  options.band = {0.5 * h, 1.5 * h, 0.5};
  Remesher remesher;
  remesher.remesh(drop, options);
  const int calls = static_cast<int>(2e7 / drop.mesh().number_of_faces()) + 1;
  bool changed = false;
  const double start = cpu_seconds();
  for (int k = 0; k < calls; ++k) changed |= remesher.remesh(drop, options).changed();
  const double seconds = cpu_seconds() - start;
  fmt::print("unchanged {}: {:.2f} ns a triangle{}\n", name, 1e9 * seconds / calls / drop.mesh().number_of_faces(),
             changed ? " (but something changed)" : "");
}

int stress(unsigned runs, unsigned first_seed) {
  unsigned unsound = 0, met = 0, were_meeting = 0, refused = 0;
  std::size_t cuts = 0, operations = 0;
  for (unsigned seed = first_seed; seed < first_seed + runs; ++seed) {
    random_shapes::Numbers numbers(seed);
    const Mesh mesh = random_shapes::shape(numbers);
    const RemeshOptions options = random_shapes::options_for(mesh, numbers);
    const bool met_before = judge::meets_itself(mesh);
    were_meeting += met_before;
    Drop drop(mesh), checked(mesh);
    const RemeshReport report = remesh(drop, options);
    cuts += report.cuts;
    operations += report.splits + report.collapses + report.flips;
    std::string defect = judge::connectivity_defect(drop);
    bool meets = !met_before && judge::meets_itself(drop.mesh());
    SplitReport split;
    for (const Drop& piece : split_components(std::move(drop), split)) {
      if (defect.empty()) defect = judge::topology_defect(piece.mesh());
    }
    try {
      remesh_to_band(checked, options);
      if (defect.empty() && !met_before && judge::meets_itself(checked.mesh()))
        defect = "remesh_to_band let the surface meet itself";
    } catch (const GeometryError&) {
      ++refused;
    }
    unsound += !defect.empty();
    met += meets;
    if (!defect.empty() || meets)
      fmt::print("seed {}: {}\n", seed, defect.empty() ? "the surface meets itself" : defect);
  }
  fmt::print(
      "{} runs: {} unsound, {} self-intersections introduced by remesh ({} inputs met themselves before), "
      "{} refused by remesh_to_band; {} operations, {} cuts\n",
      runs, unsound, met, were_meeting, refused, operations, cuts);
  return unsound + met > 0 ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace meniscus;
  std::vector<std::string> arguments(argv + 1, argv + argc);
  bool quick = false;
  if (!arguments.empty() && arguments[0] == "--stress")
    return stress(arguments.size() > 1 ? static_cast<unsigned>(std::atoi(arguments[1].c_str())) : 1000,
                  arguments.size() > 2 ? static_cast<unsigned>(std::atoi(arguments[2].c_str())) : 0);
  if (!arguments.empty() && arguments[0] == "--quick") {
    quick = true;
    arguments.erase(arguments.begin());
  }
  std::vector<std::pair<std::string, Mesh>> meshes;
  for (const std::string& file : arguments) {
    Mesh mesh;
    if (!CGAL::Polygon_mesh_processing::IO::read_polygon_mesh(file, mesh)) {
      fmt::print(stderr, "{}: cannot be read\n", file);
      return 3;
    }
    meshes.emplace_back(file, mesh);
  }
  if (meshes.empty())
    for (const int frequency : quick ? std::vector<int>{32} : std::vector<int>{32, 71}) {
      meshes.emplace_back("sphere", make_icosphere(Eigen::Vector3d::Zero(), 1, frequency));
      meshes.emplace_back("irregular sphere", random_shapes::irregular_sphere(1, frequency, 0.35, 1));
    }
  for (const auto& [name, mesh] : meshes) unchanged(name, mesh);
  for (const auto& [name, mesh] : meshes)
    for (const double scale : {1.0, 2.0, 0.5}) compare(name, mesh, scale, mesh.number_of_faces() > 50000 ? 3 : 5);
  return 0;
}
