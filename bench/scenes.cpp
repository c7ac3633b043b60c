// SPDX-License-Identifier: GPL-3.0-or-later
// Runs the scenes of data/scenes and prints, a line a scene: how many triangles, steps and frames a second, whether
// every frame is sound by geometry/inspect, the volume's ledger, and the paper's figure beside it.
#include "meniscus/geometry/inspect.h"
#include "meniscus/scene/read_scene.h"
#include "meniscus/simulation/simulation.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>

namespace {

using namespace meniscus;
namespace fs = std::filesystem;

/// What the paper states of its own scenes, on eight cores.
const std::map<std::string, std::string> paper_figures = {{"tap_low", "tap 50 FPS"},
                                                          {"tap_middle", "tap 50 FPS"},
                                                          {"tap_high", "tap 50 FPS"},
                                                          {"bird", "bird 10 FPS at 10K"},
                                                          {"lotus", "lotus 35 FPS at 30K"}};

struct Result {
  std::size_t triangles = 0, most_triangles = 0, steps = 0, frames = 0, unsound = 0, cuts = 0, deleted = 0, asleep = 0;
  double seconds = 0, volume_error = 0, first_unsound = 0;
  std::string failure;
};

void judge_frame(const Simulation& simulation, Result& result) {
  ++result.frames;
  if (inspect(to_mesh_data(simulation.drops())).sound || simulation.drops().empty()) return;
  if (result.unsound++ == 0) result.first_unsound = simulation.time();
}

Result run(const Scene& scene, int frames) {
  Result result;
  Simulation simulation(scene);
  double expected = simulation.target_volume();
  judge_frame(simulation, result);
  try {
    for (int f = 0; f < frames; ++f) {
      for (int k = 0; k < scene.steps_per_frame; ++k) {
        const auto start = std::chrono::steady_clock::now();
        const StepReport report = simulation.step();
        result.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        ++result.steps;
        result.triangles += report.triangles;
        result.most_triangles = std::max(result.most_triangles, report.triangles);
        result.cuts += report.cuts;
        result.deleted += report.deleted;
        result.asleep += report.asleep;
        expected += report.volume_added;
      }
      if (expected > 0)
        result.volume_error = std::max(result.volume_error, std::abs(simulation.volume() / expected - 1));
      judge_frame(simulation, result);
    }
  } catch (const std::exception& error) {
    result.failure = error.what();
  }
  return result;
}

void print(const std::string& name, const Scene& scene, const Result& r) {
  const auto figure = paper_figures.find(name);
  const double steps = static_cast<double>(std::max<std::size_t>(r.steps, 1)), rate = steps / r.seconds;
  fmt::print("{:<14} {:>9.0f} {:>8} {:>8.1f} {:>8.1f} {:>7.2f} {:>10} {:>9.1e} {:>5} {:>5} {:>6.1f}  {}\n", name,
             static_cast<double>(r.triangles) / steps, r.most_triangles, rate, rate / scene.steps_per_frame,
             rate * static_cast<double>(r.triangles) / steps * 1e-6,
             r.unsound == 0 ? "all" : fmt::format("{}/{}", r.frames - r.unsound, r.frames), r.volume_error, r.cuts,
             r.deleted, static_cast<double>(r.asleep) / steps, figure == paper_figures.end() ? "" : figure->second);
  if (r.unsound > 0) fmt::print("    not sound first at {:.4f} s\n", r.first_unsound);
  if (!r.failure.empty()) fmt::print("    stopped: {}\n", r.failure);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app("The scenes of data/scenes: what each costs, whether every frame is sound, and the paper's figure");
  bool quick = false;
  int frames = -1;
  std::vector<std::string> names, settings;
  app.add_flag("--quick", quick, "a frame of each, to see that it runs");
  app.add_option("--frames", frames, "frames of each (else as the scene says)");
  app.add_option("--set", settings, "KEY=VALUE: another value in each scene, as in `meniscus evolve`");
  app.add_option("names", names, "scenes, without .json (else all)");
  CLI11_PARSE(app, argc, argv);
  if (quick) frames = 1;
  const fs::path directory = fs::path(MENISCUS_DATA_DIR) / "scenes";
  if (names.empty())
    for (const auto& entry : fs::directory_iterator(directory))
      if (entry.path().extension() == ".json") names.push_back(entry.path().stem());
  std::sort(names.begin(), names.end());
  fmt::print("{:<14} {:>9} {:>8} {:>8} {:>8} {:>7} {:>10} {:>9} {:>5} {:>5} {:>6}  {}\n", "scene", "triangles", "most",
             "steps/s", "frames/s", "M tri/s", "sound", "volume", "cuts", "lost", "asleep", "the paper");
  bool all_whole = true;
  for (const std::string& name : names) {
    const Scene scene = read_scene(directory / (name + ".json"), settings);
    const Result result = run(scene, frames < 0 ? scene.frames : frames);
    print(name, scene, result);
    all_whole = all_whole && result.failure.empty();
  }
  return all_whole ? 0 : 1;
} catch (const std::exception& error) {
  fmt::print(stderr, "bench_scenes: {}\n", error.what());
  return 2;
}
