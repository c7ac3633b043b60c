// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/scene/read_scene.h"

#include "scene/scene_test_helpers.h"

#include <random>

namespace meniscus::test {
namespace {

TEST(SceneErrors, UnknownKeysNameTheNearest) {
  expect_messages(
      "{\n  \"drops\": [\n    { \"shape\": \"sphere\", \"radius\": 1 },\n    { \"shape\": \"sphere\", \"raduis\": 2, "
      "\"radius\": 1 } ] }",
      {"s.json:4:26 /drops/1/raduis: unknown key; did you mean \"radius\"? (cm, > 0)"});
  expect_messages(with_drop(R"("liquid": {"visc": 1})"),
                  {"s.json:1:13 /liquid/visc: unknown key; did you mean \"viscosity\"? (cm^2/s, >= 0)"});
  expect_messages(with_drop(R"("Frames": 1)"),
                  {"s.json:1:2 /Frames: unknown key; did you mean \"frames\"? (a whole number, >= 0, <= 10000000)"});
  expect_messages(with_drop(R"("viscosity": 1)"),
                  {"s.json:1:2 /viscosity: unknown key here; \"viscosity\" belongs in \"liquid\""});
  expect_messages(with_drop(R"("liquid": {"gravity": [0,0,0]})"),
                  {"s.json:1:13 /liquid/gravity: unknown key here; \"gravity\" belongs at the top of the scene"});
  expect_messages(with_drop(R"("liquid": {"a/b~": 1})"),
                  {"s.json:1:13 /liquid/a~1b~0: unknown key; the keys here are density, surface_tension, viscosity"});
}

TEST(SceneErrors, KeysOfOtherShapes) {
  expect_messages(
      R"({"drops": [{"shape": "box", "size": [1,1,1], "radius": 1}]})",
      {"s.json:1:46 /drops/0/radius: a box drop has no \"radius\"; its keys are shape, center, size, rotate_deg, "
       "velocity, angular_velocity"});
  expect_messages(
      R"({"drops": [{"shape": "sphere", "radius": 1, "mesh": "x.off"}]})",
      {"s.json:1:45 /drops/0/mesh: a sphere drop has no \"mesh\"; its keys are shape, center, radius, velocity, "
       "angular_velocity"});
}

TEST(SceneErrors, WrongTypes) {
  expect_messages(with_drop(R"("time_step": "fast")"), {"s.json:1:15 /time_step: expected a number, found a string"});
  expect_messages(with_drop(R"("frames": 2.5)"),
                  {"s.json:1:12 /frames: 2.5 is out of range; it must be a whole number"});
  expect_messages(with_drop(R"("frames": null)"), {"s.json:1:12 /frames: expected a whole number, found null"});
  expect_messages(with_drop(R"("liquid": 3)"), {"s.json:1:12 /liquid: expected an object, found a number"});
  expect_messages(with_drop(R"("gravity": [0, 1])"),
                  {"s.json:1:13 /gravity: expected a list of 3 numbers, found a list of 2"});
  expect_messages(with_drop(R"("gravity": [0, true, []])"),
                  {"s.json:1:17 /gravity/1: expected a number, found true",
                   "s.json:1:23 /gravity/2: expected a number, found a list of 0"});
  expect_messages(with_drop(R"("topology": {"split": 1})"),
                  {"s.json:1:24 /topology/split: expected true or false, found a number"});
  expect_messages(with_drop(R"("model": 5)"), {"s.json:1:11 /model: expected a string, found a number"});
  expect_messages(with_drop(R"("solids": {})"), {"s.json:1:12 /solids: expected a list of objects, found an object"});
  expect_messages(R"({"drops": [7]})", {"s.json:1:12 /drops/0: expected an object, found a number"});
  expect_messages("[]", {"s.json:1:1: expected an object with the keys of a scene, found a list of 0"});
  expect_messages(" 12", {"s.json:1:2: expected an object with the keys of a scene, found a number"});
}

TEST(SceneErrors, ValuesOutOfRange) {
  expect_messages(with_drop(R"("time_step": 0)"),
                  {"s.json:1:15 /time_step: 0 is out of range; it must be > 0, <= 1 s"});
  expect_messages(with_drop(R"("frames": -1)"),
                  {"s.json:1:12 /frames: -1 is out of range; it must be >= 0, <= 10000000"});
  expect_messages(with_drop(R"("liquid": {"density": -2.5})"),
                  {"s.json:1:24 /liquid/density: -2.5 is out of range; it must be > 0 g/cm^3"});
  expect_messages(
      with_drop(R"("gravity": [0, 0, -1e10])"),
      {"s.json:1:20 /gravity/2: -10000000000 is out of range; it must be at most 1000000000 in magnitude cm/s^2"});
  expect_messages(with_drop(R"("liquid": {"density": 1e-300})"),
                  {"s.json:1:24 /liquid/density: 1e-300 is out of range; it must be at least 1e-15 g/cm^3"});
  expect_messages(with_drop(R"("solids": [{"shape": "plane", "normal": [0, 0, 0]}])"),
                  {"s.json:1:42 /solids/0/normal: a direction cannot be zero"});
  expect_messages(with_drop(R"("solids": [{"shape": "plane", "advancing_angle_deg": 181}])"),
                  {"s.json:1:55 /solids/0/advancing_angle_deg: 181 is out of range; it must be > 0, <= 180 degrees"});
}

TEST(SceneErrors, WordsThatAreNoChoice) {
  expect_messages(with_drop(R"("model": "calibratd")"), {"s.json:1:11 /model: \"calibratd\" is not one of paper, "
                                                         "calibrated, pressure, auto; did you mean \"calibrated\"?"});
  expect_messages(
      R"({"drops": [{"shape": "mesh", "file": "a.off"}]})",
      {"s.json:1:22 /drops/0/shape: \"mesh\" is not one of sphere, ellipsoid, box, cap, scatter; a mesh file has "
       "\"mesh\": "
       "FILE in place of \"shape\"",
       "s.json:1:30 /drops/0/file: unknown key; the keys here are shape, mesh, center, radius, semi_axes, size, "
       "count, seed, radius_min, radius_max, sizes, gap, on, angle_deg, scale, rotate_deg, translate, velocity, "
       "angular_velocity"});
}

TEST(SceneErrors, WhatThisVersionCannotDo) {
  for (const char* model : {"dispersive", "potential"}) {
    expect_messages(with_drop(std::string("\"model\": \"") + model + "\""),
                    {std::string("s.json:1:11 /model: \"") + model + "\" is not available in this version"});
  }
}

TEST(SceneErrors, AnAccuracyWithoutTheModelAuto) {
  const std::string why = "/accuracy: only \"model\": \"auto\" has an accuracy; set that, or leave \"accuracy\" out";
  expect_messages(with_drop(R"("accuracy": "look")"), {"s.json:1:14 " + why});
  expect_messages(with_drop(R"("model": "pressure", "accuracy": "motion")"), {"s.json:1:35 " + why});
  expect_messages(with_drop(R"("model": "auto", "accuracy": "motions")"),
                  {"s.json:1:31 /accuracy: \"motions\" is not one of look, shape, motion; did you mean \"motion\"?"});
  expect_messages(with_drop(R"("substeps": 0)"),
                  {"s.json:1:14 /substeps: 0 is out of range; it must be >= 1, <= 1000"});
}

TEST(SceneErrors, MissingKeys) {
  const std::string no_liquid = "missing \"drops\" (a list of objects), and there are no \"sources\"";
  expect_messages("{ }", {"s.json:1:1: " + no_liquid});
  expect_messages(R"({"sources": []})", {"s.json:1:1: " + no_liquid});
  expect_messages(R"({"drops": []})", {"s.json:1:11 /drops: there are no drops; give at least one"});
  expect_messages(R"({"drops": [{"shape": "sphere"}]})", {"s.json:1:12 /drops/0: missing \"radius\" (cm, > 0)"});
  expect_messages(
      R"({"drops": [{"radius": 1}]})",
      {"s.json:1:12 /drops/0: missing \"shape\" (one of sphere, ellipsoid, box, cap, scatter) or \"mesh\" (a file)"});
  expect_messages(with_drop(R"("solids": [{"shape": "sphere", "keys": [{"time": 1}]}])"),
                  {"s.json:1:13 /solids/0: missing \"radius\" (cm, > 0)",
                   "s.json:1:42 /solids/0/keys/0: missing \"position\" (three numbers, cm)"});
}

TEST(SceneErrors, MissingFiles) {
  const std::string directory = MENISCUS_DATA_DIR;
  expect_messages(R"({"drops": [{"mesh": "../meshes/none.off"}]})",
                  {"s.json:1:21 /drops/0/mesh: no such file: \"" + directory +
                   "/meshes/none.off\" (names are relative to the scene's directory)"});
  expect_messages(R"({"drops": [{"mesh": "../scenes"}]})",
                  {"s.json:1:21 /drops/0/mesh: \"" + directory + "/scenes\" is a directory"});
  expect_messages(R"({"drops": [{"mesh": ""}]})", {"s.json:1:21 /drops/0/mesh: must not be empty"});
  expect_messages(R"({"drops": [{"mesh": "a\u0000b"}]})",
                  {"s.json:1:21 /drops/0/mesh: must not hold control characters"});
}

TEST(SceneErrors, DuplicateKeys) {
  expect_messages(with_drop("\"frames\": 1,\n \"frames\": 2"),
                  {"s.json:2:2 /frames: duplicate key; the first is at 1:2"});
  expect_messages(with_drop(R"("solids": [{"name": "a", "shape": "plane"}, {"name": "a", "shape": "plane"}])"),
                  {"s.json:1:55 /solids/1/name: solid 0 already has the name \"a\""});
}

TEST(SceneErrors, Syntax) {
  expect_messages("{\n  \"frames\": 1,\n}",
                  {"s.json:3:1: syntax error: unexpected '}'; expected string literal (is there a comma "
                   "too many before it?)"});
  expect_messages("{\"frames\": 1\n  \"time_step\": 2}",
                  {"s.json:2:3: syntax error: unexpected string literal; expected '}' (is a "
                   "comma missing before it?)"});
  expect_messages("{\"liquid\": {\"density\": abc}}", {"s.json:1:24 /liquid: syntax error: invalid literal"});
  expect_messages("", {"s.json:1:1: syntax error: unexpected end of input; expected '[', '{', or a literal"});
  expect_messages("{\"frames\": 1", {"s.json:1:13: syntax error: unexpected end of input; expected '}'"});
  expect_messages("{} {}", {"s.json:1:4: syntax error: unexpected '{'; expected end of input"});
  expect_messages(std::string("{}\0{}", 5), {"s.json:1:3: syntax error: a NUL character"});
  const std::vector<std::string> deep = messages(std::string(100000, '['));
  ASSERT_EQ(deep.size(), 1u);
  EXPECT_EQ(deep[0].substr(0, 12), "s.json:1:33 ");
  EXPECT_NE(deep[0].find("nested deeper than 32 levels"), std::string::npos);
}

/// Each of these took minutes or more when places and duplicates were looked for anew for every word.
TEST(SceneErrors, LargeScenesAreReadOrRefusedAtOnce) {
  std::string drops, keys, solids;
  for (int i = 0; i < 50000; ++i) {
    drops += fmt::format(R"({}{{"shape":"sphere","radius":0.2,"center":[{},0,0]}})", i == 0 ? "" : ",", i);
    solids += fmt::format(R"({}{{"shape":"sphere","radius":1,"name":"{}","keys":[{{"time":0,"position":[0,0,0]}}]}})",
                          i == 0 ? "" : ",", i);
  }
  for (int i = 0; i < 300000; ++i) keys += fmt::format(R"("{}":0,)", i);
  EXPECT_EQ(parse("{\"drops\":[" + drops + "]}").drops.size(), 50000u);  // one line of 2.5 MB
  EXPECT_EQ(parse(with_drop("\"solids\":[" + solids + "]")).solids.size(), 50000u);
  const auto refused = messages("{" + keys + "\"drops\":[]}");
  ASSERT_EQ(refused.size(), 1u);
  EXPECT_NE(refused[0].find("an object of more than 1000 keys"), std::string::npos) << refused[0];
  std::string many = "[0";
  for (int i = 0; i < 100000; ++i) many += ",0";
  EXPECT_NE(messages("{\"drops\":" + many + "]}")[0].find("a list of more than 100000 items"), std::string::npos);
  std::string wrong = R"({"raduis":1})";
  for (int i = 0; i < 50000; ++i) wrong += R"(,{"raduis":1})";
  EXPECT_EQ(messages("{\"drops\":[" + wrong + "]}").size(), 101u) << "a hundred, and how many more";
}

TEST(SceneErrors, ColumnsCountCharactersAndLinesMayEndInAnyWay) {
  expect_messages("{\"$schema\": \"\u00e9\u4e2d\U0001F4A7\", \"x\\\"y\\\\\": 1,\r\n\t\"drops\": 1}",
                  {"s.json:1:20 /x\"y\\: unknown key; the keys here are time_step, frames, steps_per_frame, gravity, "
                   "sleep, model, accuracy, substeps, liquid, "
                   "paper, volume_correction, mesh, topology, solver, solids, drops, sources",
                   "s.json:2:11 /drops: expected a list of objects, found a number"});
}

TEST(SceneErrors, NumbersThatAreNotFinite) {
  expect_messages(with_drop("\"time_step\": 1e999,\n \"gravity\": [0, 0, -1e999], \"frames\": -1"),
                  {"s.json:1:15 /time_step: the number 1e999 is too large",
                   "s.json:2:20 /gravity/2: the number -1e999 is too large",
                   "s.json:2:39 /frames: -1 is out of range; it must be >= 0, <= 10000000"});
  expect_messages("1e999", {"s.json:1:1: the number 1e999 is too large"});
  EXPECT_EQ(messages(with_drop(R"("time_step": NaN)")).size(), 1u);
  std::string many = "[1e999";
  for (int i = 0; i < 20000; ++i) many += ",1e999";
  EXPECT_FALSE(messages("{\"drops\": " + many + "]}").empty());
}

TEST(SceneErrors, EdgeLengths) {
  expect_messages(with_drop(R"("mesh": {"edge_min": 0.1, "edge_max": 0.2})"),
                  {"s.json:1:23 /mesh/edge_min: edge_min 0.1 must be less than half of edge_max 0.2, or every split "
                   "would be undone"});
  expect_messages(
      with_drop(R"("mesh": {"edge_max": 0.05})"),
      {"s.json:1:23 /mesh/edge_max: edge_min 0.04 must be less than half of edge_max 0.05, or every split would be "
       "undone"});
  // A ball of radius r has 4 pi r^2 / (sqrt(3)/4 l^2) faces: 50 million at l = 7.6185e-4 r.
  const auto ball = [](const char* edge_max) {
    return messages(R"({"mesh": {"edge_min": 1e-5, "edge_max": )" + std::string(edge_max) +
                    R"(}, "drops": [{"shape": "sphere", "radius": 1}]})");
  };
  EXPECT_EQ(ball("1.53e-3").size(), 0u);
  ASSERT_EQ(ball("1.50e-3").size(), 1u);
  EXPECT_NE(ball("1.50e-3")[0].find("s.json:1:61 /drops/0: edges of 0.000755 cm need 50.9 million faces"),
            std::string::npos)
      << ball("1.50e-3")[0];
  expect_messages(R"({"drops": [{"shape": "sphere", "radius": 0.01}]})",
                  {"s.json:1:12 /drops/0: the drop is smaller than one tetrahedron of edges of edge_min 0.04 cm; lower "
                   "mesh.edge_min "
                   "and mesh.edge_max, or make the drop larger"});
}

TEST(SceneErrors, Solids) {
  expect_messages(with_drop(R"("solids": [{"shape": "plane", "advancing_angle_deg": 50, "receding_angle_deg": 60}])"),
                  {"s.json:1:81 /solids/0/receding_angle_deg: the receding angle 60 exceeds the advancing angle 50"});
  expect_messages(with_drop(R"("solids": [{"shape": "capsule", "radius": 1, "from": [1,1,1], "to": [1,1,1]}])"),
                  {"s.json:1:70 /solids/0/to: \"from\" and \"to\" are the same point; the axis has no direction"});
  expect_messages(
      with_drop(
          R"("solids": [{"shape": "plane", "velocity": [1,0,0], "keys": [{"time": 1, "position": [0,0,0]}, {"time": 1, "position": [0,0,1]}]}])"),
      {"s.json:1:44 /solids/0/velocity: \"velocity\" and \"keys\" exclude each other",
       "s.json:1:105 /solids/0/keys/1/time: times must increase from key to key"});
}

TEST(SceneErrors, Caps) {
  expect_messages(
      R"({"drops": [{"shape": "cap", "radius": 0.2, "on": "plat"}], "solids": [{"shape": "plane", "name": "plate"}]})",
      {"s.json:1:50 /drops/0/on: no solid has the name \"plat\"; did you mean \"plate\"?"});
  expect_messages(
      R"({"drops": [{"shape": "cap", "radius": 0.2, "on": "ball"}], "solids": [{"shape": "sphere", "radius": 1, "name": "ball"}]})",
      {});
  expect_messages(R"({"drops": [{"shape": "cap", "radius": 0.2}]})", {"s.json:1:12 /drops/0: missing \"on\" (text)"});
}

TEST(SceneErrors, Scatter) {
  const auto with_scatter = [](const std::string& keys) {
    return R"({"drops": [{"shape": "scatter", "size": [1,1,1], "count": 5)" + keys + "}]}";
  };
  expect_messages(with_scatter(""), {});
  expect_messages(with_scatter(R"(, "radius_min": 0.3, "radius_max": 0.2)"),
                  {"s.json:1:95 /drops/0/radius_max: radius_max 0.2 is less than radius_min 0.3"});
  expect_messages(with_scatter(R"(, "on": "pane")"), {"s.json:1:68 /drops/0/on: no solid has the name \"pane\""});
  expect_messages(R"({"drops": [{"shape": "scatter"}]})",
                  {"s.json:1:12 /drops/0: missing \"size\" (three numbers, cm, > 0)",
                   "s.json:1:12 /drops/0: missing \"count\" (a whole number, >= 1, <= 1000000)"});
  EXPECT_EQ(messages(with_scatter(R"(, "radius_min": 0.001)")).size(), 1u);  // smaller than a tetrahedron
}

TEST(SceneErrors, Sources) {
  const auto with_source = [](const std::string& keys) { return R"({"sources": [{"shape": "disc")" + keys + "}]}"; };
  expect_messages(with_source(""), {});
  expect_messages(with_source(R"(, "start": 2, "stop": 1)"),
                  {"s.json:1:52 /sources/0/stop: a source that starts at 2 s must stop later than that"});
  expect_messages(with_source(R"(, "radius": 0.01)"),
                  {"s.json:1:42 /sources/0/radius: a source of radius 0.01 cm is too small for edges of edge_min 0.04 "
                   "cm; lower mesh.edge_min and mesh.edge_max, or make it larger"});
  expect_messages(R"({"sources": [{}]})", {"s.json:1:14 /sources/0: missing \"shape\" (one of disc)"});
}

TEST(SceneErrors, CapsOnSolidsThatNothingWets) {
  const std::string solid = R"("solids": [{"shape": "plane", "name": "p", "advancing_angle_deg": 180}]})";
  expect_messages(
      R"({"drops": [{"shape": "cap", "radius": 0.2, "on": "p"}], )" + solid,
      {"s.json:1:12 /drops/0: nothing wets that solid (its angles are 180 degrees); give the cap an \"angle_deg\""});
  expect_messages(R"({"drops": [{"shape": "cap", "radius": 0.2, "on": "p", "angle_deg": 150}], )" + solid, {});
}

TEST(SceneErrors, LongNamesAreCutShort) {
  const auto found = messages(with_drop("\"" + std::string(100000, 'k') + "\": 1"));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_LT(found[0].size(), 600u);
}

TEST(SceneErrors, AllAtOnceInTheOrderOfTheFile) {
  expect_messages(R"({
  "time_stp": 0.1,
  "frames": "many",
  "liquid": { "density": 0 },
  "mesh": { "edge_min": 0.1, "edge_max": 0.1 },
  "solids": [ { "shape": "sphere" },
              { "shape": "plane", "receding_angle_deg": 100 } ],
  "drops": [ { "mesh": "none.off" } ]
})",
                  {"s.json:2:3 /time_stp: unknown key; did you mean \"time_step\"? (s, > 0, <= 1)",
                   "s.json:3:13 /frames: expected a whole number, found a string",
                   "s.json:4:26 /liquid/density: 0 is out of range; it must be > 0 g/cm^3",
                   "s.json:5:25 /mesh/edge_min: edge_min 0.1 must be less than half of edge_max 0.1, or every split "
                   "would be undone",
                   "s.json:6:15 /solids/0: missing \"radius\" (cm, > 0)",
                   "s.json:7:57 /solids/1/receding_angle_deg: the receding angle 100 exceeds the advancing angle 90",
                   "s.json:8:24 /drops/0/mesh: no such file: \"" + std::string(MENISCUS_DATA_DIR) +
                       "/scenes/none.off\" (names are relative to the scene's directory)"});
}

TEST(SceneErrors, AreCountedBeyondAHundred) {
  std::string keys;
  for (int i = 0; i < 150; ++i) keys += "\"?" + std::to_string(i) + "\": 0, ";
  const auto found = messages(with_drop(keys + "\"frames\": 1"));
  ASSERT_EQ(found.size(), 101u);
  EXPECT_EQ(found.back(), "... and 50 more");
}

TEST(SceneErrors, RandomMutationsAreRefusedOrRead) {
  const std::string sound = read_text(std::string(MENISCUS_DATA_DIR) + "/scenes/resting_90.json");
  const std::vector<std::string> pieces = {"{",        "}",         "[",
                                           "]",        ",",         ":",
                                           "\"",       "\\",        "-",
                                           "1e999",    "null",      "//",
                                           "/*",       "\n",        "0",
                                           "\xff",     "\"drops\"", "\"shape\": \"cap\"",
                                           "\"mesh\"", "1e300",     "\"on\": \"plate\"",
                                           "\\u0000"};
  std::mt19937 random(20240607);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  int num_refused = 0;
  for (int run = 0; run < 2000; ++run) {
    std::string text = sound;
    for (std::size_t edit = 0; edit <= below(4); ++edit) {
      const std::size_t at = below(text.size());
      switch (below(4)) {
        case 0:
          text[at] = static_cast<char>(below(256));
          break;
        case 1:
          text.erase(at, below(20));
          break;
        case 2:
          text.insert(at, pieces[below(pieces.size())]);
          break;
        case 3:
          text.insert(at, text.substr(below(text.size()), below(60)));
          break;
      }
    }
    try {
      const Scene scene = parse(text);
      EXPECT_FALSE(scene.drops.empty() && scene.sources.empty());
    } catch (const SceneError& error) {
      ++num_refused;
      EXPECT_FALSE(error.messages().empty());
      for (const std::string& message : error.messages()) EXPECT_EQ(message.find('\n'), std::string::npos);
    }
  }
  EXPECT_GT(num_refused, 500);
  EXPECT_LT(num_refused, 2000);
}

}  // namespace
}  // namespace meniscus::test
