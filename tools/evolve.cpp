// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.h"
#include "evolve_run.h"
#include "meniscus/core/error.h"
#include "meniscus/io/read_file.h"
#include "meniscus/scene/read_scene.h"
#include "mesh_files.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <iostream>

namespace meniscus::tools {
namespace {

struct EvolveOptions {
  CommonOptions common;
  std::vector<std::string> inputs, settings;
  std::string output, frames_as = "ply", gravity;
  std::optional<double> time_step;
  std::optional<int> frames;
  std::optional<std::int64_t> steps;
  int checkpoint_every = 10;
  bool dry_run = false, no_frames = false, resume = false, overwrite = false, verify = false;
};

bool is_scene(const std::string& file) { return std::filesystem::path(file).extension() == ".json"; }

std::string gravity_setting(const std::string& text) {
  std::vector<double> g;
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t end = std::min(text.find(',', start), text.size());
    g.push_back(parse_number("--gravity", text.substr(start, end - start)));
    start = end + 1;
  }
  if (g.size() != 3)
    throw UsageError(fmt::format("--gravity: \"{}\" is not three numbers x,y,z (cm/s^2), as in 0,0,-981", text));
  return fmt::format("gravity=[{:.17g},{:.17g},{:.17g}]", g[0], g[1], g[2]);
}

/// --set, and the options that are short for one. What is given by name comes last and wins.
std::vector<std::string> all_settings(const EvolveOptions& options) {
  std::vector<std::string> settings = options.settings;
  if (options.time_step) settings.push_back(fmt::format("time_step={:.17g}", *options.time_step));
  if (!options.gravity.empty()) settings.push_back(gravity_setting(options.gravity));
  if (options.frames) settings.push_back(fmt::format("frames={}", *options.frames));
  return settings;
}

bool is_piped(const EvolveOptions& options) {
  return std::find(options.inputs.begin(), options.inputs.end(), "-") != options.inputs.end();
}

/// Meshes instead of a scene: the scene that names them as its drops, with defaults for the rest. If one comes through
/// stdin, which no scene can name, a sphere holds its place until the scene is checked, and it ends up without drops.
Scene scene_of_meshes(const EvolveOptions& options) {
  nlohmann::ordered_json drops = nlohmann::ordered_json::array();
  for (const std::string& file : options.inputs) {
    if (file == "-") {
      drops.push_back({{"shape", "sphere"}, {"radius", 1}});
      continue;
    }
    format_of(file);
    if (!std::filesystem::exists(file)) throw FileError(file + ": there is no such file; correct the name");
    drops.push_back({{"mesh", file}});
  }
  const nlohmann::ordered_json scene{{"drops", drops}};
  Scene checked = parse_scene(scene.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace),
                              "<command line>", "", all_settings(options));
  if (is_piped(options)) checked.drops.clear();
  return checked;
}

Scene read_input_scene(const EvolveOptions& options) {
  const auto num_scenes = std::count_if(options.inputs.begin(), options.inputs.end(), is_scene);
  if (num_scenes > 0 && options.inputs.size() > 1)
    throw UsageError("give either one scene (.json) or meshes, not both; a scene names its meshes itself");
  if (num_scenes == 1) return read_scene(options.inputs.front(), all_settings(options));
  return scene_of_meshes(options);
}

/// Drops of which one came through stdin: then all meshes are read here.
std::optional<std::vector<Drop>> read_piped_drops(const EvolveOptions& options) {
  if (!is_piped(options)) return std::nullopt;
  if (std::count(options.inputs.begin(), options.inputs.end(), "-") > 1)
    throw UsageError("-: stdin can be read only once");
  std::vector<Drop> drops;
  for (const std::string& file : options.inputs) {
    const MeshData data = read_input(file, options.common);
    for (Drop& drop : naming(file, [&] { return to_drops(data); })) {
      drop.set_id(static_cast<int>(drops.size()));
      drops.push_back(std::move(drop));
    }
  }
  return drops;
}

/// What a run writes must not replace what it starts from, nor its report what it writes.
void check_files_survive(const EvolveOptions& options, const Scene& scene) {
  const auto place_of = [](const std::filesystem::path& file) {
    std::error_code error;
    const std::filesystem::path place = std::filesystem::weakly_canonical(file, error);
    return error ? file : place;
  };
  const std::filesystem::path output = place_of(options.output);
  const auto is_written = [&](const std::filesystem::path& file) {
    const std::filesystem::path place = place_of(file);
    const std::string name = place.filename().string();
    return place.parent_path() == output &&
           (name == "run.json" || name == "measures.csv" || (!options.no_frames && is_frame_name(name)));
  };
  std::vector<std::filesystem::path> read;
  if (!options.resume)  // else a checkpoint has them
    for (const DropSpec& drop : scene.drops)
      if (drop.shape == DropShape::mesh) read.push_back(scene.locate(drop.file));
  for (const SolidSpec& solid : scene.solids)
    if (solid.shape == SolidShape::mesh) read.push_back(scene.locate(solid.file));
  if (!options.inputs.empty() && is_scene(options.inputs.front())) read.push_back(options.inputs.front());
  for (const std::filesystem::path& file : read)
    if (is_written(file))
      throw UsageError(
          fmt::format("{}: lies in {}, whose frames and reports this run replaces; choose another directory "
                      "with -o",
                      file.string(), options.output));
  const std::string& report = options.common.json;
  if (!report.empty() && report != "-" && is_written(report))
    throw UsageError(fmt::format("--json {}: the run writes that file itself; choose another name", report));
}

/// What a run starts from: the scene and drops of the command line, or a checkpoint.
void read_start(const EvolveOptions& options, RunPlan& plan) {
  plan.inputs = options.inputs;
  if (options.resume) plan.resume = find_resume_point(options.output, options.common.console());
  plan.is_complete = options.resume && !plan.resume && is_run_complete(options.output);
  if (plan.is_complete && options.inputs.empty())
    return check_asks_no_more(options.output, nullptr, options.frames, options.steps);
  if (options.inputs.empty() && !plan.resume)
    throw UsageError(options.resume
                         ? fmt::format("--resume: {} holds no checkpoint; name the scene to start with", options.output)
                         : "SCENE is required: a scene (.json), or meshes to evolve in the default one");
  if (!plan.resume) {
    plan.scene = read_input_scene(options);
    if (plan.is_complete) return check_asks_no_more(options.output, &plan.scene, std::nullopt, options.steps);
    plan.drops = read_piped_drops(options);
    plan.solids = solid_checksums(plan.scene);
    return;
  }
  plan.scene = plan.resume->scene;
  if (!options.inputs.empty()) {
    plan.scene = read_input_scene(options);
    check_same_scene(*plan.resume, plan.scene);
  } else {
    if (!all_settings(options).empty() && !options.frames)
      throw UsageError("--resume: name the scene to change it; without one, the run goes on as it was");
    plan.inputs = plan.resume->inputs;
    if (options.frames) plan.scene.frames = *options.frames;
  }
  check_same_solids(*plan.resume, plan.scene);
  plan.solids = plan.resume->solids;
}

int evolve(const EvolveOptions& options) {
  if (options.output == "-") throw UsageError("-o -: frames cannot go to stdout; name a directory");
  RunPlan plan;
  plan.output = options.output;
  plan.overwrite = options.overwrite;
  if (options.resume && !options.dry_run && std::filesystem::exists(options.output)) plan.lock.emplace(options.output);
  read_start(options, plan);
  if (plan.is_complete) {
    options.common.console().say(fmt::format("{}: the run is complete; there is nothing to resume", options.output));
    return done;
  }
  plan.frame_options.meshes = !options.no_frames;
  plan.frame_options.formats = parse_frame_formats(options.frames_as);
  plan.dry_run = options.dry_run;
  plan.verify = options.verify;
  plan.checkpoint_every = options.checkpoint_every;
  plan.frame_options.density = plan.scene.liquid.density;
  plan.steps = options.steps ? *options.steps : std::int64_t{plan.scene.frames} * plan.scene.steps_per_frame;
  check_files_survive(options, plan.scene);
  return run_evolution(std::move(plan), options.common);
}

void add_options(CLI::App& verb, EvolveOptions& options) {
  verb.add_option("SCENE", options.inputs,
                  "A scene (.json), or meshes (.ply, .off, ...; - for stdin) to evolve in the default one; may be "
                  "left out with --resume");
  add_output(verb, options.output, "Directory of frames, measures.csv and run.json; made if need be")->type_name("DIR");
  CLI::Option* frames = verb.add_option("--frames", options.frames, "Frames after the first (default: the scene's)")
                            ->type_name("N")
                            ->check(CLI::Range(0, 10000000));
  verb.add_option("--steps", options.steps, "Steps in all, instead of --frames; the last one is a frame too")
      ->type_name("N")
      ->check(CLI::Range(0, 1000000000))
      ->excludes(frames);
  verb.add_option("--set", options.settings, "Set a key of the scene, as in liquid.viscosity=0.1; may be repeated")
      ->type_name("PATH=VALUE")
      ->expected(1)
      ->take_all();
  add_positive(verb, "--time-step", options.time_step, "s", "Time of a step (default: the scene's, 1/240)");
  verb.add_option("--gravity", options.gravity, "cm/s^2 (default: the scene's, 0,0,-981)")->type_name("x,y,z");
  verb.add_flag("--dry-run", options.dry_run, "Read and build everything, say what would run, write nothing");
  verb.add_flag("--no-frames", options.no_frames, "Write measures.csv and run.json only");
  verb.add_option("--frames-as", options.frames_as,
                  "Formats of frames, joined by commas: ply, off, obj, vtp, glb, usda; PLY always is")
      ->capture_default_str()
      ->type_name("FORMATS");
  verb.add_option("--checkpoint-every", options.checkpoint_every,
                  "Frames from one checkpoint to the next; 0: only if the run is interrupted")
      ->capture_default_str()
      ->type_name("N")
      ->check(CLI::Range(0, 1000000));
  CLI::Option* resume = verb.add_flag(
      "--resume", options.resume,
      "Go on from the last checkpoint in DIR to the same bytes as without the interruption; start if there is none");
  verb.add_flag("--verify", options.verify,
                "Have an independent judge look at each drop after each step (slow); what it finds ends the run with "
                "exit code 5 and is written to DIR/violation");
  verb.add_flag("--overwrite", options.overwrite, "Start over although DIR holds an interrupted run")->excludes(resume);
}

}  // namespace

void add_evolve(CLI::App& app, Run& run) {
  const auto options = std::make_shared<EvolveOptions>();
  CLI::App* verb = add_verb(app,
                            {"evolve",
                             "Run a scene, or meshes as drops in the default scene: frames, measures, a summary.",
                             {"meniscus evolve data/scenes/splash.json -o out",
                              "meniscus evolve drop.ply other.off -o out --steps 100 --gravity 0,0,0"}},
                            options->common);
  add_options(*verb, *options);
  add_format(*verb, options->common);
  verb->callback([=, &run] { run = [=] { return evolve(*options); }; });
}

}  // namespace meniscus::tools
