// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace meniscus::scene_detail {
namespace {

// "/drops/0/radius" or "drops.0.radius" as its words; nothing if it is malformed.
std::optional<std::vector<std::string>> split_path(const std::string& path) {
  std::string pointer = path;
  if (path.empty()) return std::nullopt;
  if (path.front() != '/') {
    pointer = "/" + path;
    std::replace(pointer.begin(), pointer.end(), '.', '/');
  }
  std::vector<std::string> words;
  try {
    for (nlohmann::json::json_pointer rest(pointer); !rest.empty(); rest.pop_back()) words.push_back(rest.back());
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
  if (std::any_of(words.begin(), words.end(), [](const std::string& word) { return word.empty(); }))
    return std::nullopt;
  std::reverse(words.begin(), words.end());
  return words;
}

std::optional<std::size_t> to_index(const std::string& word) {
  const bool is_index = !word.empty() && word.size() <= 6 && (word == "0" || word.front() != '0') &&
                        word.find_first_not_of("0123456789") == std::string::npos;
  return is_index ? std::optional<std::size_t>(std::stoul(word)) : std::nullopt;
}

void mark(Node& node, const Place& place) {
  node.place = node.key_place = place;
  for (Node& child : node.children) mark(child, place);
}

// A JSON value, or else text.
Node parse_value(const std::string& value, const Place& place, std::vector<Problem>& problems) {
  std::vector<Problem> found;
  Node node = parse_tree(value, found);
  if (node.is_bad && node.place.line == 0) {  // no JSON
    node = Node{};
    node.scalar = value;
  } else {
    for (Problem& problem : found) {
      problems.push_back({place, place.setting_pointer + problem.pointer, problem.message});
    }
  }
  return node;
}

// The child called `word`, made if it is not there; nullptr, with a problem, if there can be none.
Node* step_into(Node& node, const std::string& word, const std::string& pointer, const Place& place,
                std::vector<Problem>& problems) {
  const auto fail = [&](std::string message) {
    problems.push_back({place, place.setting_pointer, std::move(message)});
    return nullptr;
  };
  const std::string name = pointer.empty() ? std::string("the scene") : pointer;
  if (node.is_object()) {
    if (Node* child = node.find(word)) return child;
    Node& added = node.children.emplace_back();
    added.key = word;
    return &added;
  }
  if (!node.is_list()) return fail(fmt::format("{} is {}, which has no \"{}\"", name, node.describe(), word));
  const std::optional<std::size_t> index = to_index(word);
  if (!index) return fail(fmt::format("{} is a list, so \"{}\" should be an index from 0", name, word));
  if (*index > node.children.size()) {
    return fail(fmt::format("{} has {} items in the scene; the next to add is number {}", name, node.children.size(),
                            node.children.size()));
  }
  if (*index == node.children.size()) node.children.emplace_back();
  return &node.children[*index];
}

}  // namespace

void apply_setting(Node& root, const std::string& setting, std::vector<Problem>& problems) {
  Place place;
  place.setting = setting;
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos) {
    problems.push_back({place, "", "expected path=value, as in liquid.viscosity=0.1"});
    return;
  }
  try {
    (void)nlohmann::json(setting).dump();
  } catch (const nlohmann::json::exception&) {
    problems.push_back({place, "", "this is not UTF-8 text"});
    return;
  }
  const auto words = split_path(setting.substr(0, equals));
  if (!words) {
    problems.push_back({place, "", "expected a path before the =, as in drops.0.radius or /drops/0/radius"});
    return;
  }
  for (const std::string& word : *words) place.setting_pointer = child_pointer(place.setting_pointer, word);

  Node* node = &root;
  std::string pointer;
  for (std::size_t i = 0; i < words->size(); ++i) {
    const bool is_new = node->place.line == 0 && node->place.setting.empty();
    if (is_new) {  // a list or an object that only this path speaks of
      node->kind = to_index((*words)[i]) ? Node::Kind::list : Node::Kind::object;
      node->place = place;
      if (!node->key.empty()) node->key_place = place;
    }
    node = step_into(*node, (*words)[i], pointer, place, problems);
    if (!node) return;
    pointer = child_pointer(pointer, (*words)[i]);
  }
  Node value = parse_value(setting.substr(equals + 1), place, problems);
  value.key = node->key;
  mark(value, place);
  *node = std::move(value);
}

}  // namespace meniscus::scene_detail
