// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/scene/read_scene.h"

#include "scene_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <tuple>

namespace meniscus {
namespace {

using namespace scene_detail;

constexpr std::size_t largest_file = std::size_t{16} << 20;
constexpr std::size_t most_messages = 100;

std::string without_control_characters(const std::string& text) {
  std::string clean;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x20 || code == 0x7f)
      clean += fmt::format("\\u{:04x}", code);
    else
      clean += c;
  }
  return clean;
}

std::string at_most(std::string text, std::size_t bytes) {
  if (text.size() <= bytes) return text;
  while (bytes > 0 && (static_cast<unsigned char>(text[bytes]) & 0xC0u) == 0x80u) --bytes;  // whole characters
  return text.substr(0, bytes) + "...";
}

std::string to_message(const Problem& problem, const std::string& name) {
  std::string where;
  if (problem.place.setting.empty()) {
    where = fmt::format("{}:{}:{}", name, problem.place.line, problem.place.column);
    if (!problem.pointer.empty()) where += " " + at_most(problem.pointer, 200);
  } else {
    where = "--set " + at_most(problem.place.setting, 200);
    if (problem.pointer != problem.place.setting_pointer) where += " " + at_most(problem.pointer, 200);
  }
  return without_control_characters(where + ": " + at_most(problem.message, 1000));
}

std::vector<std::string> to_messages(std::vector<Problem> problems, const std::string& name) {
  const auto order = [](const Problem& p) {
    return std::make_tuple(!p.place.setting.empty(), p.place.line, p.place.column);
  };
  std::stable_sort(problems.begin(), problems.end(),
                   [&](const Problem& a, const Problem& b) { return order(a) < order(b); });
  std::vector<std::string> messages;
  for (std::size_t i = 0; i < std::min(problems.size(), most_messages); ++i)
    messages.push_back(to_message(problems[i], name));
  if (problems.size() > most_messages)
    messages.push_back(fmt::format("... and {}{} more", problems.size() < most_problems ? "" : "at least ",
                                   problems.size() - most_messages));
  return messages;
}

std::string read_text(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw FileError(path.string() + ": is a directory, not a scene file");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw FileError(path.string() + ": cannot be opened; does it exist, and may you read it?");
  std::string text(largest_file + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream.bad()) throw FileError(path.string() + ": cannot be read");
  text.resize(static_cast<std::size_t>(stream.gcount()));
  if (text.size() > largest_file) throw FileError(path.string() + ": is larger than 16 MB; is it a scene?");
  return text;
}

}  // namespace

SceneError::SceneError(std::vector<std::string> messages)
    : UsageError(fmt::format("{}", fmt::join(messages, "\n"))), messages_(std::move(messages)) {}

Scene parse_scene(std::string_view text, const std::string& name, const std::filesystem::path& directory,
                  const std::vector<std::string>& settings, SceneFiles files) {
  std::vector<Problem> problems;
  Node root = parse_tree(text, problems);
  Scene scene;
  scene.directory = directory;
  if (!root.is_bad) {
    for (const std::string& setting : settings) apply_setting(root, setting, problems);
    read_keys(root, scene, files, problems);
    check_scene(root, scene, problems);
  }
  if (!problems.empty()) throw SceneError(to_messages(std::move(problems), name));
  return scene;
}

Scene read_scene(const std::filesystem::path& path, const std::vector<std::string>& settings) {
  Scene scene = parse_scene(read_text(path), path.string(), path.parent_path(), settings);
  scene.file = path;
  return scene;
}

Scene default_scene() { return {}; }

}  // namespace meniscus
