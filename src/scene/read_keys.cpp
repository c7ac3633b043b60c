// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/scene/nearest_name.h"
#include "scene_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace meniscus::scene_detail {
namespace {

// No length, time or speed of a drop is beyond these; products of such numbers stay finite.
constexpr double least_positive = 1e-15;

std::string joined(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, ", ")); }

std::string with_article(const std::string& noun) {
  return (std::string("aeiou").find(noun.front()) == std::string::npos ? "a " : "an ") + noun;
}

class KeyReader {
 public:
  KeyReader(const std::filesystem::path& directory, SceneFiles files, std::vector<Problem>& problems)
      : directory_(directory), files_(files), problems_(problems) {}

  // An object with the keys of the table. `shape` narrows them; `noun` names the object in messages.
  void read_object(const Node& node, const std::string& pointer, const std::vector<Key>& keys, void* owner,
                   const std::string& shape = {}, const std::string& noun = {}) {
    for (std::size_t i = 0; i < node.children.size(); ++i) {
      const Node& child = node.children[i];
      const std::string at = child_pointer(pointer, child.key);
      const Node* first = node.find(child.key);
      if (first != &child) {
        report(child.key_place, at,
               fmt::format("duplicate key; the first is at {}:{}", first->key_place.line, first->key_place.column));
        continue;
      }
      const Key* key = find_key(keys, child.key);
      if (!key)
        report(child.key_place, at, unknown_key(child.key, keys, shape));
      else if (!key->applies_to(shape))
        report(child.key_place, at, foreign_key(*key, keys, shape, noun));
      else
        read_value(child, at, *key, owner);
    }
    for (const Key& key : keys) {
      if (key.is_required && key.applies_to(shape) && !node.find(key.name)) {
        report(node.place, pointer, fmt::format("missing \"{}\" ({})", key.name, key.describe()));
      }
    }
  }

 private:
  void report(const Place& place, const std::string& pointer, std::string message) {
    if (problems_.size() >= most_problems) return;
    problems_.push_back({place, pointer, std::move(message)});
  }

  static std::vector<std::string> names(const std::vector<Key>& keys, const std::string& shape) {
    std::vector<std::string> all;
    for (const Key& key : keys) {
      const bool is_usable = key.kind != KeyKind::ignored && key.kind != KeyKind::unavailable;
      if (is_usable && key.applies_to(shape)) all.push_back(key.name);
    }
    return all;
  }

  static std::string unknown_key(const std::string& name, const std::vector<Key>& keys, const std::string& shape) {
    const std::vector<std::string> known = names(keys, shape);
    const std::string nearest = nearest_name(name, known);
    if (!nearest.empty()) {
      return fmt::format("unknown key; did you mean \"{}\"? ({})", nearest, find_key(keys, nearest)->describe());
    }
    for (const Key& section : scene_keys()) {
      if (find_key(section.keys, name))
        return fmt::format("unknown key here; \"{}\" belongs in \"{}\"", name, section.name);
    }
    if (find_key(scene_keys(), name))
      return fmt::format("unknown key here; \"{}\" belongs at the top of the scene", name);
    return "unknown key; the keys here are " + joined(known);
  }

  static std::string foreign_key(const Key& key, const std::vector<Key>& keys, const std::string& shape,
                                 const std::string& noun) {
    return fmt::format("{} {} has no \"{}\"; its keys are {}", with_article(shape), noun, key.name,
                       joined(names(keys, shape)));
  }

  void read_value(const Node& node, const std::string& pointer, const Key& key, void* owner) {
    if (node.is_bad) return;
    switch (key.kind) {
      case KeyKind::ignored:
        return;
      case KeyKind::unavailable:
        return report(node.key_place, pointer, key.help + ": not available in this version");
      case KeyKind::section:
        if (expect(node.is_object(), "an object", node, pointer)) read_object(node, pointer, key.keys, owner);
        return;
      case KeyKind::list:
        if (expect(node.is_list(), "a list of objects", node, pointer)) read_items(node, pointer, *key.items, owner);
        return;
      case KeyKind::vector:
        return read_vector(node, pointer, key, owner);
      case KeyKind::number:
      case KeyKind::integer:
        if (is_number(node, pointer, key)) key.set(owner, node.scalar.get<double>());
        return;
      case KeyKind::boolean:
        if (expect(node.scalar.is_boolean(), "true or false", node, pointer)) key.set(owner, node.scalar.get<bool>());
        return;
      case KeyKind::text:
      case KeyKind::file:
      case KeyKind::choice:
        return read_words(node, pointer, key, owner);
    }
  }

  bool expect(bool is_right, const char* wanted, const Node& node, const std::string& pointer) {
    if (!is_right) report(node.place, pointer, fmt::format("expected {}, found {}", wanted, node.describe()));
    return is_right;
  }

  // Whether it is a number that the key takes; reports if not.
  bool is_number(const Node& node, const std::string& pointer, const Key& key) {
    if (node.is_bad) return false;
    const bool is_integer = key.kind == KeyKind::integer;
    if (!expect(node.scalar.is_number(), is_integer ? "a whole number" : "a number", node, pointer)) return false;
    const double x = node.scalar.get<double>();
    std::string must;
    if (!key.range.contains(x))
      must = key.range.describe();
    else if (is_integer && x != std::floor(x))
      must = "a whole number";
    else if (std::abs(x) > largest_magnitude)
      must = fmt::format("at most {} in magnitude", largest_magnitude);
    else if (key.range.low == 0 && key.range.is_low_open && x < least_positive)
      must = fmt::format("at least {}", least_positive);
    if (must.empty()) return true;
    report(node.place, pointer,
           fmt::format("{} is out of range; it must be {}{}{}", x, must, key.unit.empty() ? "" : " ", key.unit));
    return false;
  }

  void read_vector(const Node& node, const std::string& pointer, const Key& key, void* owner) {
    if (!expect(node.is_list() && node.children.size() == 3, "a list of 3 numbers", node, pointer)) return;
    Json value = Json::array();
    bool is_zero = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const Node& child = node.children[i];
      if (!is_number(child, child_pointer(pointer, i), key)) continue;
      value.push_back(child.scalar.get<double>());
      if (std::abs(value.back().get<double>()) > least_positive) is_zero = false;
    }
    if (value.size() != 3) return;
    if (key.is_nonzero && is_zero) return report(node.place, pointer, "a direction cannot be zero");
    key.set(owner, value);
  }

  void read_words(const Node& node, const std::string& pointer, const Key& key, void* owner) {
    if (!expect(node.scalar.is_string(), "a string", node, pointer)) return;
    const std::string& words = node.scalar.get_ref<const std::string&>();
    std::string wrong;
    if (key.kind == KeyKind::choice)
      wrong = wrong_choice(words, key);
    else if (words.empty())
      wrong = "must not be empty";
    else if (std::any_of(words.begin(), words.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; })) {
      wrong = "must not hold control characters";
    } else if (key.kind == KeyKind::file) {
      wrong = wrong_file(words);
    }
    if (!wrong.empty()) return report(node.place, pointer, wrong);
    key.set(owner, words);
  }

  static std::string wrong_choice(const std::string& word, const Key& key) {
    std::vector<std::string> available;
    for (const Choice& choice : key.choices) {
      if (choice.is_available) available.push_back(choice.name);
      if (choice.name == word) {
        return choice.is_available ? "" : fmt::format("\"{}\" is not available in this version", word);
      }
    }
    const std::string nearest = nearest_name(word, available);
    std::string message = fmt::format("\"{}\" is not one of {}", word, joined(available));
    if (!nearest.empty())
      message += fmt::format("; did you mean \"{}\"?", nearest);
    else if (key.name == "shape" && word == "mesh")
      message += "; a mesh file has \"mesh\": FILE in place of \"shape\"";
    return message;
  }

  std::string wrong_file(const std::string& name) const {
    if (files_ == SceneFiles::not_looked_for) return {};
    const std::filesystem::path path = (directory_ / name).lexically_normal();
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (std::filesystem::is_regular_file(status)) return {};
    if (std::filesystem::is_directory(status)) return fmt::format("\"{}\" is a directory", path.string());
    if (status.type() != std::filesystem::file_type::not_found)
      return fmt::format("\"{}\" cannot be read ({})", path.string(),
                         error ? error.message() : "it is no regular file");
    return fmt::format("no such file: \"{}\" (names are relative to the scene's directory)", path.string());
  }

  void read_items(const Node& node, const std::string& pointer, const Items& items, void* owner) {
    for (std::size_t i = 0; i < node.children.size(); ++i) {
      const Node& child = node.children[i];
      const std::string at = child_pointer(pointer, i);
      void* item = items.append(owner);
      if (child.is_bad || !expect(child.is_object(), "an object", child, at)) continue;
      const std::optional<std::string> shape = shape_of(child, at, items);
      read_object(child, at, shape ? items.keys : optional_keys(items), item, shape.value_or(""), items.noun);
      if (!items.finish) continue;
      std::set<std::string> given;
      for (const Node& member : child.children) given.insert(member.key);
      items.finish(item, given);
    }
  }

  // The item's shape: the word of its key "shape", or the shape whose own key is there. "" if the
  // items have no shapes; nothing if it cannot be known (reported here, or when "shape" is read).
  std::optional<std::string> shape_of(const Node& node, const std::string& pointer, const Items& items) {
    if (items.shapes.empty()) return "";
    const Key* shape_key = find_key(items.keys, "shape");
    if (const Node* shape = node.find("shape")) {
      if (!shape->scalar.is_string()) return std::nullopt;
      const std::string& word = shape->scalar.get_ref<const std::string&>();
      return wrong_choice(word, *shape_key).empty() ? std::optional<std::string>(word) : std::nullopt;
    }
    std::string alternatives;
    for (const std::string& shape : items.shapes) {
      const Key* own = find_key(items.keys, shape);
      if (own && node.find(shape)) return shape;
      if (own) alternatives += fmt::format(" or \"{}\" ({})", own->name, own->describe());
    }
    const bool is_planned = std::any_of(node.children.begin(), node.children.end(), [&](const Node& child) {
      const Key* key = find_key(items.keys, child.key);
      return key && key->kind == KeyKind::unavailable;
    });
    if (!is_planned)
      report(node.place, pointer, fmt::format("missing \"shape\" ({}){}", shape_key->describe(), alternatives));
    return std::nullopt;
  }

  // The keys of all shapes, none of them required: for an item of unknown shape.
  static std::vector<Key> optional_keys(const Items& items) {
    std::vector<Key> keys = items.keys;
    for (Key& key : keys) key.is_required = false;
    return keys;
  }

  const std::filesystem::path& directory_;
  const SceneFiles files_;
  std::vector<Problem>& problems_;
};

}  // namespace

void read_keys(const Node& root, Scene& scene, SceneFiles files, std::vector<Problem>& problems) {
  if (root.is_bad) return;
  if (!root.is_object()) {
    problems.push_back(
        {root.place, "", fmt::format("expected an object with the keys of a scene, found {}", root.describe())});
    return;
  }
  KeyReader(scene.directory, files, problems).read_object(root, "", scene_keys(), &scene);
}

}  // namespace meniscus::scene_detail
