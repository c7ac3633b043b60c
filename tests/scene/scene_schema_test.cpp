// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/scene/scene_schema.h"

#include "scene/scene_test_helpers.h"

#include <nlohmann/json.hpp>

#include <cstdlib>
#include <filesystem>

namespace meniscus::test {
namespace {

using nlohmann::json;

// Whether the schema knows all names in the value and finds all that it requires; enough of a
// validator for the schema's own use of oneOf, const and required.
bool accepts_names(const json& schema, const json& value) {
  if (schema.contains("oneOf")) {
    int matches = 0;
    for (const json& variant : schema["oneOf"]) matches += accepts_names(variant, value) ? 1 : 0;
    return matches == 1;
  }
  if (schema.contains("const")) return schema["const"] == value;
  if (schema.contains("enum")) {
    return std::find(schema["enum"].begin(), schema["enum"].end(), value) != schema["enum"].end();
  }
  if (schema.value("type", "") == "object") {
    if (!value.is_object()) return false;
    for (const json& name : schema.value("required", json::array())) {
      if (!value.contains(name.get<std::string>())) return false;
    }
    for (const auto& member : value.items()) {
      if (!schema["properties"].contains(member.key())) return false;
      if (!accepts_names(schema["properties"][member.key()], member.value())) return false;
    }
  }
  if (schema.value("type", "") == "array") {
    if (!value.is_array() || value.size() < schema.value("minItems", std::size_t{0})) return false;
    for (const json& item : value) {
      if (!accepts_names(schema["items"], item)) return false;
    }
  }
  return true;
}

TEST(SceneSchema, IsJsonWithARangeUnitAndDefault) {
  const json schema = json::parse(scene_schema());
  EXPECT_EQ(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
  EXPECT_EQ(schema["anyOf"], json::parse(R"([{"required": ["drops"]}, {"required": ["sources"]}])"));
  EXPECT_EQ(schema["additionalProperties"], false);
  const json& step = schema["properties"]["time_step"];
  EXPECT_EQ(step["type"], "number");
  EXPECT_EQ(step["exclusiveMinimum"], 0);
  EXPECT_EQ(step["maximum"], 1);
  EXPECT_EQ(step["default"], 1.0 / 240);
  EXPECT_EQ(schema["properties"]["model"]["enum"], json::array({"paper", "calibrated", "pressure", "auto"}));
  EXPECT_EQ(schema["properties"]["gravity"]["default"], json::array({0, 0, -981}));
  EXPECT_EQ(schema["properties"]["solids"]["items"]["oneOf"].size(), 6u);
  EXPECT_EQ(schema["properties"]["drops"]["items"]["oneOf"].size(), 6u);
  EXPECT_EQ(schema["properties"]["sleep"]["default"], false);
}

TEST(SceneSchema, AcceptsTheExampleScenesAndNoOtherNames) {
  const json schema = json::parse(scene_schema());
  for (const auto& entry : std::filesystem::directory_iterator(std::string(MENISCUS_DATA_DIR) + "/scenes")) {
    if (entry.path().extension() != ".json") continue;
    json scene = json::parse(read_text(entry.path()), nullptr, true, true);
    EXPECT_TRUE(accepts_names(schema, scene)) << entry.path();
    scene[scene.contains("drops") ? "drops" : "sources"][0]["raduis"] = 1;
    EXPECT_FALSE(accepts_names(schema, scene)) << entry.path();
  }
}

// Run with MENISCUS_UPDATE_DOCS=1 in the environment to bring the page up to date.
TEST(SceneReference, ThePageIsCurrent) {
  const std::string path = std::string(MENISCUS_SOURCE_DIR) + "/docs/SCENE.md";
  const std::string begin = "<!-- begin: scene reference -->\n", end = "<!-- end: scene reference -->";
  std::string page = read_text(path);
  const std::size_t from = page.find(begin), to = page.find(end);
  ASSERT_TRUE(from != std::string::npos && to != std::string::npos && from < to);
  const std::string found = page.substr(from + begin.size(), to - from - begin.size());
  const std::string expected = "\n" + scene_reference_markdown() + "\n";
  const char* update = std::getenv("MENISCUS_UPDATE_DOCS");
  if (found != expected && update && std::string(update) == "1") {
    page.replace(from + begin.size(), found.size(), expected);
    std::ofstream(path, std::ios::binary) << page;
    return;
  }
  EXPECT_EQ(found, expected) << "docs/SCENE.md is out of date; run this test with MENISCUS_UPDATE_DOCS=1";
}

}  // namespace
}  // namespace meniscus::test
