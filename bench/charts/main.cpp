// SPDX-License-Identifier: GPL-3.0-or-later
// Speed against accuracy: every chart of docs/ACCURACY.md, as CSV, JSON and SVG.
//
//   bench_charts [--quick] [--only NAME] [--draw] [--out DIRECTORY]
//
// --draw only draws again from the CSV that are there. --quick measures a few points of each, into a temporary
// directory unless --out is given. Peers (gerris, evolver) are run side by side where they are installed.
#include "charts.h"
#include "meniscus/core/error.h"
#include "support/process.h"
#include "support/run_bench.h"

#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>

#include <string>

namespace {

using namespace meniscus;
using namespace meniscus::bench;

constexpr const char* usage = "bench_charts [--quick] [--only NAME] [--draw] [--out DIRECTORY]";

const struct {
  const char* name;
  ChartTable (*measure)(bool quick);
} charts[] = {{"oscillation", oscillation_chart},
              {"sessile", sessile_chart},
              {"curvature", curvature_chart},
              {"volume_correction", volume_correction_chart},
              {"merge_remesh", merge_remesh_chart},
              {"size", size_chart},
              {"thread", thread_chart}};

struct Options {
  bool quick = false, draw_only = false;
  std::string only;
  std::filesystem::path out;
};

Options parse(int argc, char** argv) {
  Options options;
  for (int k = 1; k < argc; ++k) {
    const std::string word = argv[k];
    if (word == "--quick")
      options.quick = true;
    else if (word == "--draw")
      options.draw_only = true;
    else if (word == "--only" && k + 1 < argc)
      options.only = argv[++k];
    else if (word == "--out" && k + 1 < argc)
      options.out = argv[++k];
    else
      throw UsageError(usage);
  }
  return options;
}

int run(const Options& options) {
  const oneapi::tbb::global_control one_thread(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  const TemporaryDirectory temporary;
  std::filesystem::path out = options.out;
  if (out.empty()) out = options.quick ? temporary.path() : std::filesystem::path(MENISCUS_SOURCE_DIR "/docs/charts");
  bool found = false;
  for (const auto& chart : charts) {
    if (!options.only.empty() && options.only != chart.name) continue;
    found = true;
    if (!options.draw_only) chart.measure(options.quick).write(out);
    draw(chart.name, out);
  }
  if (!found) throw UsageError(fmt::format("there is no chart \"{}\"", options.only));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return run_bench(argc, argv, usage, [&] { return run(parse(argc, argv)); });
}
