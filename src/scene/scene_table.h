// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/scene/scene.h"

#include <nlohmann/json.hpp>

#include <functional>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <vector>

/// The one table of all keys that a scene may hold. The reader, the writer, the schema and the
/// reference are loops over it.
namespace meniscus::scene_detail {

using Json = nlohmann::ordered_json;

enum class KeyKind {
  number,
  integer,
  boolean,
  text,
  file,         ///< the name of a file that must exist
  choice,       ///< one of some words
  vector,       ///< three numbers
  section,      ///< an object
  list,         ///< of objects
  ignored,      ///< accepted, without effect
  unavailable,  ///< known, but not in this version
};

struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool is_low_open = false;
  bool is_high_open = false;

  bool contains(double x) const { return (is_low_open ? x > low : x >= low) && (is_high_open ? x < high : x <= high); }
  /// "> 0, <= 180", or "" if all numbers are in it.
  std::string describe() const;
};

struct Choice {
  std::string name;
  bool is_available = true;
};

struct Items;

struct Key {
  std::string name;
  KeyKind kind = KeyKind::number;
  std::string unit;  ///< "" if it has none
  Range range;       ///< of a number, or of each of a vector's three
  std::string help;  ///< one line
  bool is_required = false;
  bool is_nonzero = false;          ///< a vector that must have a direction
  std::string default_note;         ///< where the default is no value: what it is
  std::vector<std::string> shapes;  ///< the shapes that have it; empty: all
  std::vector<Choice> choices;
  std::vector<Key> keys;                              ///< of a section
  std::shared_ptr<const Items> items;                 ///< of a list
  std::function<Json(const void* owner)> get;         ///< as the file says it; null: nothing to write
  std::function<void(void* owner, const Json&)> set;  ///< from a value that was checked

  bool applies_to(const std::string& shape) const;
  /// What belongs here in a few words: "cm, > 0", "one of none, local", "true or false", ...
  std::string describe() const;
};

/// What the objects of a list are. Each has the shape that its key "shape" names, or, without that
/// key, the shape whose name is itself one of its keys.
struct Items {
  std::string noun;                 ///< "solid"
  std::vector<std::string> shapes;  ///< empty: there is just one kind
  std::vector<Key> keys;
  std::function<void*(void* owner)> append;  ///< a new item of defaults
  std::function<std::vector<const void*>(const void* owner)> all;
  std::shared_ptr<const void> defaults;                                        ///< an item of defaults
  std::function<void(void* item, const std::set<std::string>& given)> finish;  ///< defaults that depend on other keys
  std::function<std::string(const void* item)> shape_of;
};

const Key* find_key(const std::vector<Key>& keys, const std::string& name);

/// The keys of a scene; they own Scene objects.
const std::vector<Key>& scene_keys();

}  // namespace meniscus::scene_detail
