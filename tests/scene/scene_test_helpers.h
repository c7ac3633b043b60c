// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/scene/read_scene.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace meniscus::test {

inline Scene parse(const std::string& text, const std::vector<std::string>& settings = {}) {
  return parse_scene(text, "s.json", std::string(MENISCUS_DATA_DIR) + "/scenes", settings);
}

/// The messages that a scene is refused with; none if it is taken.
inline std::vector<std::string> messages(const std::string& text, const std::vector<std::string>& settings = {}) {
  try {
    parse(text, settings);
  } catch (const SceneError& error) {
    return error.messages();
  }
  return {};
}

inline void expect_messages(const std::string& text, const std::vector<std::string>& expected,
                            const std::vector<std::string>& settings = {}) {
  EXPECT_EQ(messages(text, settings), expected) << text;
}

inline std::string read_text(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  EXPECT_TRUE(stream) << path;
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// `head` put before a sound drop: R"("frames": 3)" becomes a whole scene. Starts at column 2.
inline std::string with_drop(const std::string& head) {
  return "{" + head + (head.empty() ? "" : ", ") + R"("drops": [{"shape": "sphere", "radius": 0.2}]})";
}

}  // namespace meniscus::test
