// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/scene/write_scene.h"

#include "meniscus/scene/nearest_name.h"
#include "scene/scene_test_helpers.h"

#include <fmt/format.h>
#include <rapidcheck/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>

namespace meniscus::test {
namespace {

TEST(ResolvedScene, FillsInTheDefaultsOfEachShape) {
  const auto scene = nlohmann::json::parse(resolved_scene(parse(with_drop(R"("solids": [{"shape": "plane"}])"))));
  EXPECT_EQ(scene["frames"], 120);
  EXPECT_EQ(scene["liquid"]["density"], 1);
  EXPECT_EQ(scene["solver"]["method"], "auto");
  EXPECT_EQ(scene["solids"][0]["advancing_angle_deg"], 90);
  EXPECT_FALSE(scene["solids"][0].contains("radius"));
  EXPECT_EQ(scene["drops"][0]["radius"], 0.2);
  EXPECT_FALSE(scene["drops"][0].contains("size"));
  EXPECT_EQ(scene["sources"].size(), 0u);
}

TEST(ResolvedScene, ExampleScenesReadBackTheSame) {
  for (const auto& entry : std::filesystem::directory_iterator(std::string(MENISCUS_DATA_DIR) + "/scenes")) {
    if (entry.path().extension() != ".json") continue;
    const Scene scene = read_scene(entry.path());
    const std::string text = resolved_scene(scene);
    EXPECT_EQ(resolved_scene(parse_scene(text, "run.json", scene.directory)), text) << entry.path();
  }
}

TEST(ResolvedScene, WhatTheModelAutoChoosesIsNoValueOfTheScenes) {
  const Scene scene = parse(with_drop(R"("model": "auto", "accuracy": "motion", "solver": {"tolerance": 1e-5})"));
  const std::string text = resolved_scene(scene);
  const auto json = nlohmann::json::parse(text);
  EXPECT_EQ(json["model"], "auto");
  EXPECT_EQ(json["accuracy"], "motion");
  EXPECT_EQ(json["solver"], nlohmann::json({{"tolerance", 1e-5}}));
  for (const char* key : {"volume_correction", "substeps"}) EXPECT_FALSE(json.contains(key)) << key;
  EXPECT_EQ(resolved_scene(parse(text)), text);
  EXPECT_FALSE(nlohmann::json::parse(resolved_scene(parse(with_drop("")))).contains("accuracy"));
}

TEST(ResolvedScene, MovingSolidsAndCapsReadBackTheSame) {
  const Scene scene = parse(R"({"solids": [
      {"name": "p", "shape": "plane", "velocity": [1, 2, 3]},
      {"shape": "cylinder", "from": [0,0,0], "to": [0,0,1], "radius": 1,
       "keys": [{"time": 0, "position": [0,0,0.1]}, {"time": 0.5, "position": [1,0,0]}]}],
    "drops": [{"shape": "cap", "on": "p", "radius": 0.1}, {"shape": "cap", "on": "p", "radius": 0.1, "angle_deg": 33.3}]})");
  const std::string text = resolved_scene(scene);
  const Scene again = parse(text);
  EXPECT_EQ(resolved_scene(again), text);
  EXPECT_EQ(again.solids[1].keys.size(), 2u);
  EXPECT_EQ(again.solids[1].keys[1].time, 0.5);
  EXPECT_EQ(again.solids[0].velocity, scene.solids[0].velocity);
  EXPECT_EQ(again.drops[1].angle, scene.drops[1].angle);
  EXPECT_FALSE(again.drops[0].angle.has_value());
}

TEST(ResolvedScene, SourcesScatterAndEdgesReadBackTheSame) {
  const Scene scene = parse(R"({"sleep": true, "solids": [
      {"name": "b", "shape": "box", "size": [1,1,1], "edge_radius": 0.05},
      {"shape": "cylinder", "from": [0,0,0], "to": [0,0,1], "radius": 1}],
    "drops": [{"shape": "scatter", "on": "b", "count": 3, "size": [1,1,0.1], "sizes": "uniform", "seed": 7}],
    "sources": [{"shape": "disc", "speed": 5}, {"shape": "disc", "start": 1, "stop": 2.5}]})");
  const std::string text = resolved_scene(scene);
  const Scene again = parse(text);
  EXPECT_EQ(resolved_scene(again), text);
  EXPECT_TRUE(again.sleep);
  EXPECT_EQ(again.solids[0].edge_radius, 0.05);
  EXPECT_FALSE(again.solids[1].edge_radius.has_value());
  EXPECT_EQ(again.drops[0].seed, 7);
  EXPECT_EQ(again.drops[0].sizes, ScatterSizes::uniform);
  EXPECT_TRUE(std::isinf(again.sources[0].stop));
  EXPECT_EQ(again.sources[1].stop, 2.5);
}

// A double in [1e-9, 1) with all its bits.
double fraction() {
  const auto bits = *rc::gen::inRange<std::int64_t>(std::int64_t{1} << 24, std::int64_t{1} << 53);
  return static_cast<double>(bits) / 0x1p53;
}

RC_GTEST_PROP(ResolvedScene, AnglesReadBackToTheSameBits, ()) {
  const double advancing = 90 + 90 * fraction(), receding = 90 * fraction();
  const Scene scene = parse(
      with_drop(fmt::format(R"("solids": [{{"shape": "plane", "advancing_angle_deg": {}, "receding_angle_deg": {}}}])",
                            advancing, receding)));
  const Scene again = parse(resolved_scene(scene));
  RC_ASSERT(again.solids[0].advancing_angle == scene.solids[0].advancing_angle);
  RC_ASSERT(again.solids[0].receding_angle == scene.solids[0].receding_angle);
}

TEST(DefaultScene, IsWhatAnEmptySceneMeans) {
  EXPECT_EQ(resolved_scene(default_scene()), [] {
    Scene scene = parse(with_drop(""));
    scene.drops.clear();
    return resolved_scene(scene);
  }());
}

TEST(NearestName, FindsSlipsAndAbbreviationsOnly) {
  const std::vector<std::string> names = {"radius", "center", "velocity", "angular_velocity"};
  EXPECT_EQ(nearest_name("raduis", names), "radius");  // swapped
  EXPECT_EQ(nearest_name("radus", names), "radius");   // left out
  EXPECT_EQ(nearest_name("centre", names), "center");
  EXPECT_EQ(nearest_name("RADIUS", names), "radius");
  EXPECT_EQ(nearest_name("vel", names), "velocity");  // cut short
  EXPECT_EQ(nearest_name("temperature", names), "");
  EXPECT_EQ(nearest_name("x", names), "");
  EXPECT_EQ(nearest_name("", names), "");
  EXPECT_EQ(nearest_name(std::string(1000000, 'r'), names), "");
  EXPECT_EQ(nearest_name("radius", {}), "");
}

}  // namespace
}  // namespace meniscus::test
