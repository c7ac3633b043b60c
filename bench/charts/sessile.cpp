// SPDX-License-Identifier: GPL-3.0-or-later
// Water laid on a plane without hysteresis, 20 % too wide at first, until it rests: height and contact radius beside
// Young-Laplace against processor seconds, for each level, mesh, contact angle and size. Beside Surface Evolver with
// linear and quadratic facets.
#include "charts.h"
#include "references/drop_at_rest.h"
#include "support/levels.h"
#include "support/process.h"
#include "support/rest.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <sstream>

namespace meniscus::bench {
namespace {

constexpr double degree = pi / 180, nan = std::numeric_limits<double>::quiet_NaN();

/// Height and contact radius of what `dump_it` of
/// bench/peers/evolver_sessile.py printed: "V id on_plane x y z".
struct Evolved {
  double height = nan, contact_radius = nan, facets = nan;
};

Evolved read_dump(const std::string& output, bool quadratic) {
  Evolved evolved;
  std::vector<Eigen::Vector2d> line;
  std::stringstream stream(output);
  for (std::string text; std::getline(stream, text);) {
    std::stringstream words(text);
    std::string kind, skip;
    words >> kind;
    if (kind == "RESULT") words >> skip >> evolved.facets;
    if (kind != "V") continue;
    int id = 0, on_plane = 0;
    double x = 0, y = 0, z = 0;
    if (!(words >> id >> on_plane >> x >> y >> z)) continue;
    evolved.height = std::isnan(evolved.height) ? z : std::max(evolved.height, z);
    if (on_plane) line.emplace_back(x, y);
  }
  // The plane's vertices by angle: the polygon's area, or with quadratic edges,
  // which follow the circle, the mean radius.
  std::sort(line.begin(), line.end(),
            [](const auto& a, const auto& b) { return std::atan2(a.y(), a.x()) < std::atan2(b.y(), b.x()); });
  double area = 0, sum = 0;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const Eigen::Vector2d& next = line[(k + 1) % line.size()];
    area += 0.5 * (line[k].x() * next.y() - line[k].y() * next.x());
    sum += line[k].norm();
  }
  if (line.size() > 2)
    evolved.contact_radius = quadratic ? sum / static_cast<double>(line.size()) : std::sqrt(area / pi);
  return evolved;
}

void add_evolver(ChartTable& table, double radius, double angle, int refinements, bool quadratic) {
  const TemporaryDirectory directory;
  const Finished made = run_program({"python3", MENISCUS_SOURCE_DIR "/bench/peers/evolver_sessile.py", "6",
                                     fmt::format("{}", angle), "981", fmt::format("{}", radius)},
                                    directory.path());
  std::string commands = "relax;\n";
  for (int k = 0; k < refinements; ++k) commands += "r; relax;\n";
  if (quadratic) commands += "quadratic; relax;\n";
  commands += "hessian; hessian; hessian; dump_it; q\n";
  const std::string file = (directory.path() / "drop.fe").string();
  const Finished written = run_program({"cp", "/dev/stdin", file}, directory.path(), made.output);
  const Finished run = run_program({"evolver", "-x", file}, directory.path(), commands + "q\n");
  const Evolved evolved = read_dump(run.output, quadratic);
  const auto exact = references::drop_at_rest(4 * pi / 3 * std::pow(radius, 3), angle * degree, 981, Liquid(),
                                              references::Hold::sessile);
  if (made.code != 0 || written.code != 0 || std::isnan(evolved.height)) {
    fmt::print("evolver: no result at R = {}, {} degrees, {} refinements\n", radius, angle, refinements);
    return;
  }
  table.add({std::string(quadratic ? "evolver quadratic" : "evolver linear"), radius, angle, nan, evolved.facets,
             evolved.height / exact.height - 1, evolved.contact_radius / exact.contact_radius - 1, nan, run.cpu_seconds,
             nan});
}

}  // namespace

ChartTable sessile_chart(bool quick) {
  ChartTable table("sessile", "Water at rest on a plane, beside Young-Laplace",
                   {"method", "radius", "angle", "edge_over_radius", "triangles", "height_error",
                    "contact_radius_error", "seconds_to_rest", "cpu_seconds", "time_step"});
  for (const NamedLevel& level : levels)
    for (const double radius : {0.1, 0.2, 0.3})
      for (const double angle : {30.0, 60.0, 90.0, 120.0, 150.0})
        for (const double share : {0.2, 0.14, 0.1, 0.07, 0.05}) {  // edge_min over the radius
          if (quick && (radius != 0.2 || angle != 90 || share != 0.2)) continue;
          if ((angle < 60 || angle > 120) && share != 0.1) continue;
          const bool paper = level.level == Level::paper;  // most of its runs shatter, which takes long
          if (paper && (radius != 0.2 || share < 0.1)) continue;
          RestCase rest;
          rest.level = level.level;
          rest.radius = radius;
          rest.angle = angle * degree;
          rest.edge_min = share * radius;
          rest.time_step = paper ? 1.0 / 960 : 1.0 / 240;  // as in data/scenes/resting_*.json, and four times that
          if (paper) rest.longest = 0.5;
          const RestRun run = run_to_rest(rest);
          table.add({std::string(level.name), radius, angle, share, run.triangles, run.height_error, run.radius_error,
                     run.rested ? run.seconds : nan, run.cpu_seconds, rest.time_step});
        }
  if (quick) return table;
  if (!is_installed("evolver")) {
    fmt::print("evolver: skipped, it is not installed\n");
    return table;
  }
  for (const double radius : {0.1, 0.2, 0.3})
    for (const double angle : {60.0, 90.0, 120.0})
      for (const int refinements : {2, 3, 4, 5}) {
        add_evolver(table, radius, angle, refinements, false);
        if (refinements < 4) add_evolver(table, radius, angle, refinements, true);
      }
  return table;
}

}  // namespace meniscus::bench
