// SPDX-License-Identifier: GPL-3.0-or-later
// The cost of a step, scene by scene, without frames: bench_step [--quick] [--json FILE] [--threads 1,2] [--steps N]
// [NAME...]. Names are those of bench/step_scenes.h and of data/scenes; all of the former if none is
// given.
// Each run is a process of its own, so that its peak memory is its own. "quiet" steps are those in which no drop's
// mesh changed. CPU times are of all threads, those of stages of the thread that steps the drop: on a machine that
// others use they say more than steps a second do.
#include "count_allocations.h"
#include "step_scenes.h"

#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <fstream>
#include <functional>
#include <iostream>
#include <optional>
#include <string_view>

namespace {

using namespace meniscus;
using Json = nlohmann::ordered_json;

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double seconds_of(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double cpu_seconds() { return seconds_of(CLOCK_PROCESS_CPUTIME_ID); }
/// Of the calling thread: what a stage costs whatever else runs.
double thread_cpu_seconds() { return seconds_of(CLOCK_THREAD_CPUTIME_ID); }

/// The q-quantile by the nearest rank; 0 of none.
double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const double rank = std::ceil(q * static_cast<double>(values.size()));
  return values[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

double peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

/// A number for the bits of all positions and velocities.
std::size_t bits_of(const std::vector<Drop>& drops) {
  std::size_t bits = drops.size();
  for (const Drop& drop : drops)
    for (const double* data : {drop.positions().data(), drop.velocities().data()}) {
      const std::string_view bytes(reinterpret_cast<const char*>(data), 3 * sizeof(double) * drop.num_rows());
      bits = bits * 31 + std::hash<std::string_view>()(bytes);
    }
  return bits;
}

/// What is noted while steps are taken.
struct Run {
  std::vector<double> step_ms, quiet_allocations;
  StepReport sum, staged;
  int staged_steps = 0;
  std::size_t most_triangles = 0;
  double wall = 0, cpu = 0;
};

void take_step(Simulation& simulation, Run& run) {
  const std::size_t allocations = bench::num_allocations;
  const double cpu = cpu_seconds(), wall = wall_seconds();
  const StepReport report = simulation.step();
  const double seconds = wall_seconds() - wall;
  run.wall += seconds;
  run.cpu += cpu_seconds() - cpu;
  run.step_ms.push_back(1e3 * seconds);
  run.most_triangles = std::max(run.most_triangles, report.triangles);
  run.sum += report;
  if (report.edge_operations + report.cuts + report.merges + report.folds + report.deleted + report.taken_back == 0)
    run.quiet_allocations.push_back(static_cast<double>(bench::num_allocations - allocations));
}

/// A step that is not counted, for the time of each stage: reading a thread's clock costs a microsecond.
void take_staged_step(Simulation& simulation, Run& run) {
  simulation.set_clock(&thread_cpu_seconds);
  run.staged += simulation.step();
  simulation.set_clock(nullptr);
  ++run.staged_steps;
}

Json measure(const std::string& name, int threads, int steps) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  const double base = peak_bytes();
  const bench::Setting setting = bench::make_setting(name);
  Simulation simulation = setting.simulation();
  const bool quick = steps > 0 && steps < setting.settling;
  for (int k = 0; k < (quick ? 1 : setting.settling); ++k) simulation.step();
  Run run;
  take_step(simulation, run);
  if (steps <= 0)  // 20 million triangle-steps
    steps = static_cast<int>(
        std::clamp(2e7 / static_cast<double>(std::max<std::size_t>(run.most_triangles, 1)), 60.0, 2000.0));
  run = {};
  run.step_ms.reserve(static_cast<std::size_t>(steps));
  run.quiet_allocations.reserve(static_cast<std::size_t>(steps));
  constexpr std::size_t staged_every = 4;
  while (static_cast<int>(run.step_ms.size()) < steps) {
    if (run.step_ms.size() % staged_every == 0) take_staged_step(simulation, run);
    take_step(simulation, run);
  }

  const double n = steps, triangles = static_cast<double>(run.sum.triangles) / n;
  Json stages = Json::object();
  for (std::size_t k = 0; k < num_stages; ++k)
    stages[stage_name(static_cast<Stage>(k))] = 1e3 * run.staged.stage_seconds[k] / run.staged_steps;
  return {
      {"name", name},
      {"threads", threads},
      {"steps", steps},
      {"drops", simulation.drops().size()},
      {"asleep_drops", static_cast<double>(run.sum.asleep) / n},
      {"triangles", {{"mean", triangles}, {"max", run.most_triangles}}},
      {"steps_per_second", n / run.wall},
      {"triangle_steps_per_second", triangles * n / run.wall},
      {"cpu_ms", 1e3 * run.cpu / n},
      {"cpu_ns_per_triangle", 1e9 * run.cpu / n / triangles},
      {"step_ms",
       {{"p50", quantile(run.step_ms, 0.5)}, {"p99", quantile(run.step_ms, 0.99)}, {"max", quantile(run.step_ms, 1)}}},
      {"stage_ms", std::move(stages)},
      {"solver_iterations", run.sum.solver_iterations},
      {"substeps", run.sum.substeps},
      {"edge_operations", run.sum.edge_operations},
      {"quiet_steps", run.quiet_allocations.size()},
      {"quiet_allocations",
       {{"p50", quantile(run.quiet_allocations, 0.5)}, {"max", quantile(run.quiet_allocations, 1)}}},
      {"peak_bytes", peak_bytes()},
      {"peak_bytes_per_triangle",
       (peak_bytes() - base) / static_cast<double>(std::max<std::size_t>(run.most_triangles, 1))},
      {"bits", bits_of(simulation.drops())}};
}

/// Runs `measure` in a process of its own.
Json measure_apart(const std::string& name, int threads, int steps) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe");
  std::cout.flush();
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no process");
  if (child == 0) {
    close(ends[0]);
    Json result;
    try {
      result = measure(name, threads, steps);
    } catch (const std::exception& error) {
      result = {{"name", name}, {"threads", threads}, {"failure", error.what()}};
    }
    const std::string text = result.dump(-1, ' ', false, Json::error_handler_t::replace);
    const bool written = write(ends[1], text.data(), text.size()) == static_cast<ssize_t>(text.size());
    _exit(written ? 0 : 1);
  }
  close(ends[1]);
  std::string text;
  char buffer[4096];
  for (ssize_t count = 0; (count = read(ends[0], buffer, sizeof buffer)) > 0;)
    text.append(buffer, static_cast<std::size_t>(count));
  close(ends[0]);
  waitpid(child, nullptr, 0);
  const Json result = Json::parse(text, nullptr, false);
  return result.is_object() ? result : Json{{"name", name}, {"threads", threads}, {"failure", "it crashed"}};
}

void print_head() {
  fmt::print("{:<18} {:>7} {:>9} {:>8} {:>8} {:>8} {:>8} {:>8} {:>7} {:>6} {:>8} {:>8}\n", "scene", "threads",
             "triangles", "steps/s", "M tri/s", "p50 ms", "p99 ms", "max ms", "CPU ns", "solver", "allocs", "KB/tri");
}

void print_row(const Json& r) {
  if (r.contains("failure")) {
    fmt::print("{:<18} {:>7} stopped: {}\n", r["name"].get<std::string>(), r["threads"].get<int>(),
               r["failure"].get<std::string>());
    return;
  }
  const auto number = [&](const char* pointer) { return r[Json::json_pointer(pointer)].get<double>(); };
  fmt::print("{:<18} {:>7} {:>9.0f} {:>8.1f} {:>8.2f} {:>8.3f} {:>8.3f} {:>8.3f} {:>7.1f} {:>6.0f} {:>8} {:>8.2f}\n",
             r["name"].get<std::string>(), r["threads"].get<int>(), number("/triangles/mean"),
             number("/steps_per_second"), 1e-6 * number("/triangle_steps_per_second"), number("/step_ms/p50"),
             number("/step_ms/p99"), number("/step_ms/max"), number("/cpu_ns_per_triangle"),
             number("/solver_iterations"),
             number("/quiet_steps") > 0 ? fmt::format("{:.0f}", number("/quiet_allocations/p50")) : "-",
             number("/peak_bytes_per_triangle") / 1024);
  std::string stages;
  for (const auto& [stage, ms] : r["stage_ms"].items())
    if (ms.get<double>() > 0) stages += fmt::format("  {} {:.3f}", stage, ms.get<double>());
  fmt::print("   ms:{}\n", stages);
}

/// The slope of log(step) over log(triangles) of the free drops on one thread, by least squares; none of fewer than
/// two.
std::optional<double> exponent(const Json& results) {
  std::vector<std::array<double, 2>> points;
  for (const Json& r : results) {
    const std::string name = r["name"];
    if (name.rfind("free_", 0) != 0 || name.find("pressure") != std::string::npos || r["threads"] != 1 ||
        r.contains("failure"))
      continue;
    points.push_back({std::log(r["triangles"]["mean"].get<double>()), std::log(r["cpu_ms"].get<double>())});
  }
  if (points.size() < 2) return std::nullopt;
  double x = 0, y = 0, xx = 0, xy = 0;
  for (const auto& p : points)
    x += p[0] / static_cast<double>(points.size()), y += p[1] / static_cast<double>(points.size());
  for (const auto& p : points) xx += (p[0] - x) * (p[0] - x), xy += (p[0] - x) * (p[1] - y);
  return xx > 0 ? std::optional(xy / xx) : std::nullopt;
}

/// What two thread counts of the same scene say of each other.
void print_pairs(const Json& results) {
  for (std::size_t k = 1; k < results.size(); ++k) {
    const Json &a = results[k - 1], &b = results[k];
    if (a["name"] != b["name"] || a.contains("failure") || b.contains("failure")) continue;
    fmt::print("{}: {} threads / {}: {:.2f} times the steps; {}\n", a["name"].get<std::string>(),
               b["threads"].get<int>(), a["threads"].get<int>(),
               a["step_ms"]["p50"].get<double>() / b["step_ms"]["p50"].get<double>(),
               a["bits"] == b["bits"] ? "the same bits" : "NOT the same bits");
  }
}

}  // namespace

int main(int argc, char** argv) {
  bool quick = false;
  std::string json_name;
  std::vector<std::string> names;
  std::vector<int> threads{1, 2};
  int steps = 0;
  CLI::App app("The cost of a step, scene by scene");
  app.add_flag("--quick", quick, "a few steps of small scenes, to see that it runs");
  app.add_option("--json", json_name, "write the report there (- is stdout, instead of the table)");
  app.add_option("--threads", threads, "numbers of threads, each measured")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::PositiveNumber);
  app.add_option("--steps", steps, "steps to measure (else 20 million triangle-steps, 60 to 2000)");
  app.add_option("names", names, "scenes");
  CLI11_PARSE(app, argc, argv);
  if (names.empty()) names = bench::all_settings();
  if (quick) names = {"free_5k", "collide"};
  if (quick) steps = 3;
  const bool table = json_name != "-";
  Json results = Json::array();
  if (table) print_head();
  bool whole = true;
  for (const std::string& name : names)
    for (const int count : threads) {
      results.push_back(measure_apart(name, count, steps));
      whole = whole && !results.back().contains("failure");
      if (table) print_row(results.back());
      std::fflush(stdout);
    }
  Json report{{"results", results}};
  if (const auto slope = exponent(results)) {
    report["exponent"] = *slope;
    if (table) fmt::print("cost grows as triangles^{:.2f}\n", *slope);
  }
  if (table) print_pairs(results);
  if (json_name == "-") std::cout << report.dump(2) << '\n';
  if (!json_name.empty() && table) {
    std::ofstream file(json_name);
    file << report.dump(2) << '\n';
    if (!file.flush()) {
      fmt::print(stderr, "{}: cannot be written\n", json_name);
      return 3;
    }
  }
  return whole ? 0 : 5;
}
