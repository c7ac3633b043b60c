// SPDX-License-Identifier: GPL-3.0-or-later
// The map of failure: each way to take a step of curvature flow, each operator and each level over time step, edge
// length, mesh quality and tension: did it blow up, with what first. Spheroids of water's density, 2 : 1, of the
// volume of a ball of R = 0.2 cm. Writes stability.csv, .json and .svg.
//
//   bench_stability [--quick] [--only METHOD] [--out DIRECTORY]
//   bench_stability --stress N [--seed S] [--outside] [--limit SECONDS]
//     N random runs inside (or outside) of the safe region, remeshing, solids and all, each given up after so many
//     seconds of processor time (default 60)
#include "meniscus/core/error.h"
#include "stress.h"
#include "support/chart_table.h"
#include "support/levels.h"
#include "support/process.h"
#include "support/run_bench.h"
#include "trial.h"

#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <functional>

namespace {

using namespace meniscus;
using namespace meniscus::bench;

constexpr const char* usage =
    "bench_stability [--quick] [--only METHOD] [--out DIRECTORY] | --stress N [--seed S] [--outside] [--limit SECONDS]";

struct Method {
  std::string name;
  std::function<TrialResult(const TrialCase&)> run;
  double least_edge = 0;  ///< cm
};

std::vector<Method> methods() {
  std::vector<Method> all;
  for (std::size_t k = 0; k < flow_names.size(); ++k)
    all.push_back({flow_names[k], [k](const TrialCase& trial) { return try_flow(static_cast<Flow>(k), trial); }});
  for (std::size_t k = 0; k < operator_names.size(); ++k)
    all.push_back({operator_names[k], [k](const TrialCase& t) { return try_operator(static_cast<Operator>(k), t); }});
  for (const NamedLevel& level : levels)
    for (const bool on_plane : {false, true})
      all.push_back({std::string(level.name) + (on_plane ? " on plane" : " in air"),
                     [=](const TrialCase& trial) { return try_level(level.level, on_plane, trial); },
                     on_plane ? 0.06 : 0.03});  // a drop that crumples takes long
  return all;
}

const double rates[] = {15, 30, 60, 120, 240, 480, 960, 1920, 4800};

ChartTable measure(bool quick, const std::string& only) {
  const std::vector<Method> all = methods();
  if (std::none_of(all.begin(), all.end(), [&](const Method& m) { return m.name.find(only) != std::string::npos; }))
    throw UsageError(fmt::format("there is no method \"{}\"", only));
  ChartTable table("stability", "What fails first: spheroids 2:1 of R = 0.2 cm; 12 steps, of levels at least 0.05 s",
                   {"method", "quality", "edge", "tension", "time_step", "failure", "steps", "recoveries"});
  table.fold_from(4);
  for (const Method& method : all) {
    if (method.name.find(only) == std::string::npos) continue;
    for (std::size_t q = 0; q < quality_names.size(); ++q)
      for (const double edge : {0.06, 0.03, 0.015})
        for (const double tension : {7.2, 72.0, 720.0})
          for (const double rate : rates) {
            if (edge < method.least_edge) continue;
            if (quick && (edge < 0.06 || tension != 72 || (rate != 60 && rate != 960))) continue;
            TrialCase trial;
            trial.quality = static_cast<Quality>(q);
            trial.edge = edge;
            trial.tension = tension;
            trial.time_step = 1 / rate;
            if (quick) trial.steps = 4;
            const TrialResult result = method.run(trial);
            table.add({method.name, std::string(quality_names[q]), edge, tension, 1 / rate,
                       std::string(failure_name(result.failure)), double(result.steps), double(result.recoveries)});
          }
  }
  return table;
}

int run(int argc, char** argv) {
  bool quick = false, outside = false;
  int stress = 0;
  unsigned seed = 1;
  double limit = 60;
  std::string only;
  std::filesystem::path out;
  for (int k = 1; k < argc; ++k) {
    const std::string word = argv[k];
    if (word == "--quick")
      quick = true;
    else if (word == "--outside")
      outside = true;
    else if (word == "--only" && k + 1 < argc)
      only = argv[++k];
    else if (word == "--out" && k + 1 < argc)
      out = argv[++k];
    else if (word == "--stress" && k + 1 < argc)
      stress = std::stoi(argv[++k]);
    else if (word == "--seed" && k + 1 < argc)
      seed = static_cast<unsigned>(std::stoul(argv[++k]));
    else if (word == "--limit" && k + 1 < argc)
      limit = std::stod(argv[++k]);
    else
      throw UsageError(usage);
  }
  const oneapi::tbb::global_control one_thread(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  if (stress > 0) return run_stress(stress, seed, outside, limit);
  const TemporaryDirectory temporary;
  if (out.empty()) out = quick ? temporary.path() : std::filesystem::path(MENISCUS_SOURCE_DIR "/docs/charts");
  measure(quick, only).write(out);
  draw("stability", out);
  if (quick) run_stress(20, seed, false, limit);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return run_bench(argc, argv, usage, [&] { return run(argc, argv); });
}
