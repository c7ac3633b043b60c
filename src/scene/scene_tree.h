// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>
#include <vector>

/// A JSON text as a tree that remembers where everything stood. Duplicate keys are kept.
namespace meniscus::scene_detail {

/// Where something was written: in the text (from 1), or in a setting.
struct Place {
  std::size_t line = 0;
  std::size_t column = 0;
  std::string setting;          ///< "path=value" if it came from there
  std::string setting_pointer;  ///< the JSON pointer of that path
};

struct Problem {
  Place place;
  std::string pointer;
  std::string message;
};

/// Looking for more stops here: a file with as many is no scene, and each is compared with each key.
inline constexpr std::size_t most_problems = 1000;

struct Node {
  enum class Kind { scalar, list, object };

  std::string key;  ///< as a member of an object
  Place key_place;
  Place place;
  Kind kind = Kind::scalar;
  bool is_bad = false;  ///< already reported: not to be looked at
  nlohmann::json scalar;
  std::vector<Node> children;  ///< of a list or an object, in order

  bool is_object() const { return kind == Kind::object; }
  bool is_list() const { return kind == Kind::list; }
  Node* find(std::string_view name);
  const Node* find(std::string_view name) const;
  /// "a string", "a list of 2", ...
  std::string describe() const;
};

/// `pointer` extended by a key (escaped as RFC 6901 says) or an index.
std::string child_pointer(const std::string& pointer, const std::string& key);
std::string child_pointer(const std::string& pointer, std::size_t index);

/// Parses a JSON text with comments. Problems (syntax; numbers too large for a double; nesting
/// deeper than 32) are appended; after a syntax error the tree is one bad node of no place (line 0).
Node parse_tree(std::string_view text, std::vector<Problem>& problems);

/// Applies "path=value" to the tree.
void apply_setting(Node& root, const std::string& setting, std::vector<Problem>& problems);

/// The node at a pointer, or the deepest one on the way to it.
const Node& deepest(const Node& root, const std::string& pointer);

}  // namespace meniscus::scene_detail
