// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>

namespace meniscus::scene_detail {
namespace {

constexpr std::size_t deepest_nesting = 32;
// Beyond these no scene was written by anyone, and looking for duplicates would take hours.
constexpr std::size_t most_keys = 1000, most_items = 100000;
constexpr std::size_t most_overflows = 20;

// Tells how far the parser has read: the SAX events come without positions.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(std::string_view text, std::size_t at, std::size_t* consumed)
      : text_(text), at_(at), consumed_(consumed) {}
  reference operator*() const { return text_[at_]; }
  CountingIterator& operator++() {
    *consumed_ = ++at_;
    return *this;
  }
  bool operator==(const CountingIterator& other) const { return at_ == other.at_; }
  bool operator!=(const CountingIterator& other) const { return at_ != other.at_; }

 private:
  std::string_view text_;
  std::size_t at_;
  std::size_t* consumed_;
};

// Where tokens start, given where the parser stands just after it read them.
class TokenFinder {
 public:
  explicit TokenFinder(std::string_view text) : text_(text) {
    line_starts_.push_back(text.substr(0, 3) == "\xEF\xBB\xBF" ? 3 : 0);
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (text[i] == '\n') line_starts_.push_back(i + 1);
    }
  }

  // The parser has read one character past a number, unless the text ended.
  std::size_t number_start(std::size_t consumed) const {
    const auto in_number = [&](std::size_t i) {
      return std::string_view("0123456789+-.eE").find(text_[i]) != std::string_view::npos;
    };
    std::size_t start = consumed;
    if (start > 0 && !in_number(start - 1)) --start;
    while (start > 0 && in_number(start - 1)) --start;
    return start;
  }

  // Back from the closing quote to one with an even number of backslashes before it.
  std::size_t string_start(std::size_t consumed) const {
    std::size_t start = consumed - 1;
    while (start > 0) {
      --start;
      if (text_[start] != '"') continue;
      std::size_t slash = start;
      while (slash > 0 && text_[slash - 1] == '\\') --slash;
      if ((start - slash) % 2 == 0) break;
    }
    return start;
  }

  Place place(std::size_t offset) const {
    offset = std::min(offset, text_.size());
    const auto next = std::upper_bound(line_starts_.begin(), line_starts_.end(), offset);
    const auto line = next == line_starts_.begin() ? next : std::prev(next);
    Place place;
    place.line = static_cast<std::size_t>(line - line_starts_.begin()) + 1;
    // Tokens come in order: counting goes on where it ended, or a scene of one long line would take hours.
    if (*line > counted_to_ || offset < counted_to_) {
      counted_to_ = *line;
      column_ = 1;
    }
    for (; counted_to_ < offset; ++counted_to_) {
      if ((static_cast<unsigned char>(text_[counted_to_]) & 0xC0u) != 0x80u) ++column_;  // characters, not bytes
    }
    place.column = column_;
    return place;
  }

 private:
  std::string_view text_;
  std::vector<std::size_t> line_starts_;
  mutable std::size_t counted_to_ = 0, column_ = 1;  // the column of the character at counted_to_
};

// What nlohmann-json found wrong, in our words.
std::string syntax_message(const std::string& what) {
  const std::size_t dash = what.find(" - ");
  std::string message = dash == std::string::npos ? what : what.substr(dash + 3);
  const std::size_t read = message.find("; last read: '");
  if (read != std::string::npos) {
    const std::size_t quote = message.rfind('\'', message.rfind("; expected") - 1);
    message.erase(read, (quote == std::string::npos || quote < read + 14 ? message.size() : quote + 1) - read);
  }
  const auto has = [&](const char* part) { return message.find(part) != std::string::npos; };
  std::string hint;
  if (has("unexpected string literal; expected '}'")) hint = " (is a comma missing before it?)";
  if (has("unexpected '}'; expected string literal")) hint = " (is there a comma too many before it?)";
  return "syntax error: " + message + hint;
}

// Builds the tree from the SAX events.
class TreeBuilder : public nlohmann::json_sax<nlohmann::json> {
 public:
  TreeBuilder(const TokenFinder& finder, const std::size_t& consumed, const std::vector<std::size_t>& overflows)
      : finder_(finder), consumed_(consumed), overflows_(overflows) {}

  bool null() override { return add(nullptr, consumed_ - 4); }
  bool boolean(bool value) override { return add(value, consumed_ - (value ? 4 : 5)); }
  bool number_integer(std::int64_t value) override { return add(value, finder_.number_start(consumed_)); }
  bool number_unsigned(std::uint64_t value) override { return add(value, finder_.number_start(consumed_)); }
  bool number_float(double value, const std::string&) override { return add(value, finder_.number_start(consumed_)); }
  bool string(std::string& value) override { return add(value, finder_.string_start(consumed_)); }
  bool binary(nlohmann::json::binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(Node::Kind::object); }
  bool start_array(std::size_t) override { return open(Node::Kind::list); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(std::string& name) override {
    key_ = name;
    key_place_ = finder_.place(finder_.string_start(consumed_));
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception& error) override {
    if (error.id == 406) {  // a number beyond the doubles
      overflow_ = finder_.number_start(consumed_);
      overflow_pointer_ = container();
      if (!open_.empty()) {
        overflow_pointer_ = open_.back()->is_object() ? child_pointer(overflow_pointer_, key_)
                                                      : child_pointer(overflow_pointer_, open_.back()->children.size());
      }
      has_overflow_ = true;
      return false;
    }
    fail(error_start(error.what()), syntax_message(error.what()));
    return false;
  }

  Node take_root() { return std::move(root_); }
  bool has_overflow() const { return has_overflow_; }
  std::size_t overflow() const { return overflow_; }
  const std::string& overflow_pointer() const { return overflow_pointer_; }
  const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::size_t error_start(const std::string& what) const {
    const auto has = [&](const char* part) { return what.find(part) != std::string::npos; };
    if (has("unexpected end of input") || consumed_ == 0) return consumed_;
    if (has("unexpected string literal")) return finder_.string_start(consumed_);
    if (has("unexpected number literal")) return finder_.number_start(consumed_);
    if (has("unexpected true literal") || has("unexpected null literal")) return consumed_ - 4;
    if (has("unexpected false literal")) return consumed_ - 5;
    return consumed_ - 1;
  }

  // The pointer of the innermost open list or object.
  std::string container() const {
    std::string pointer;
    for (std::size_t i = 1; i < open_.size(); ++i) {
      pointer = open_[i - 1]->is_object() ? child_pointer(pointer, open_[i]->key)
                                          : child_pointer(pointer, open_[i - 1]->children.size() - 1);
    }
    return pointer;
  }

  void fail(std::size_t offset, std::string message) {
    problems_.push_back({finder_.place(offset), container(), std::move(message)});
  }

  // Whether the innermost list or object may grow further; reports it if not.
  bool has_room(std::size_t start) {
    if (open_.empty()) return true;
    const Node& parent = *open_.back();
    if (parent.children.size() < (parent.is_object() ? most_keys : most_items)) return true;
    fail(start, parent.is_object() ? fmt::format("an object of more than {} keys", most_keys)
                                   : fmt::format("a list of more than {} items", most_items));
    return false;
  }

  Node& append(std::size_t start) {
    Node* node = &root_;
    if (!open_.empty()) {
      node = &open_.back()->children.emplace_back();
      node->key = key_;
      node->key_place = key_place_;
    }
    node->place = finder_.place(start);
    node->is_bad = std::binary_search(overflows_.begin(), overflows_.end(), start);
    return *node;
  }

  template <class T>
  bool add(T&& value, std::size_t start) {
    if (!has_room(start)) return false;
    append(start).scalar = std::forward<T>(value);
    return true;
  }

  bool open(Node::Kind kind) {
    if (open_.size() == deepest_nesting) {
      fail(consumed_ - 1, fmt::format("nested deeper than {} levels", deepest_nesting));
      return false;
    }
    if (!has_room(consumed_ - 1)) return false;
    Node& node = append(consumed_ - 1);
    node.kind = kind;
    open_.push_back(&node);
    return true;
  }

  bool close() {
    open_.pop_back();
    return true;
  }

  const TokenFinder& finder_;
  const std::size_t& consumed_;
  const std::vector<std::size_t>& overflows_;  // sorted
  Node root_;
  std::vector<Node*> open_;  // from the root to the innermost; only the innermost gains children
  std::string key_;
  Place key_place_;
  std::vector<Problem> problems_;
  std::size_t overflow_ = 0;
  std::string overflow_pointer_;
  bool has_overflow_ = false;
};

}  // namespace

const Node* Node::find(std::string_view name) const {
  if (!is_object()) return nullptr;
  const auto it = std::find_if(children.begin(), children.end(), [&](const Node& n) { return n.key == name; });
  return it == children.end() ? nullptr : &*it;
}

Node* Node::find(std::string_view name) { return const_cast<Node*>(std::as_const(*this).find(name)); }

std::string Node::describe() const {
  if (is_object()) return "an object";
  if (is_list()) return fmt::format("a list of {}", children.size());
  if (scalar.is_string()) return "a string";
  if (scalar.is_number()) return "a number";
  if (scalar.is_boolean()) return scalar.get<bool>() ? "true" : "false";
  return "null";
}

std::string child_pointer(const std::string& pointer, const std::string& key) {
  std::string escaped;
  for (const char c : key) {
    if (c == '~')
      escaped += "~0";
    else if (c == '/')
      escaped += "~1";
    else
      escaped += c;
  }
  return pointer + "/" + escaped;
}

std::string child_pointer(const std::string& pointer, std::size_t index) {
  return pointer + "/" + std::to_string(index);
}

const Node& deepest(const Node& root, const std::string& pointer) {
  const Node* node = &root;
  std::vector<std::string> words;
  for (nlohmann::json::json_pointer rest(pointer); !rest.empty(); rest.pop_back()) words.push_back(rest.back());
  for (auto word = words.rbegin(); word != words.rend(); ++word) {
    const Node* child = node->find(*word);
    if (node->is_list()) {
      std::size_t index = 0;
      const auto [end, error] = std::from_chars(word->data(), word->data() + word->size(), index);
      const bool is_index = error == std::errc() && end == word->data() + word->size();
      child = is_index && index < node->children.size() ? &node->children[index] : nullptr;
    }
    if (!child) break;
    node = child;
  }
  return *node;
}

Node parse_tree(std::string_view text, std::vector<Problem>& problems) {
  const TokenFinder finder(text);
  const std::size_t nul = text.find('\0');
  if (nul != std::string_view::npos) {  // the parser would take it for the end
    problems.push_back({finder.place(nul), "", "syntax error: a NUL character"});
    Node bad;
    bad.is_bad = true;
    return bad;
  }
  std::string working(text);
  std::vector<std::size_t> overflows;
  for (;;) {
    std::size_t consumed = 0;
    TreeBuilder builder(finder, consumed, overflows);
    const bool is_read = nlohmann::json::sax_parse(CountingIterator(working, 0, &consumed),
                                                   CountingIterator(working, working.size(), &consumed), &builder,
                                                   nlohmann::json::input_format_t::json, true, true);
    if (builder.has_overflow() && overflows.size() < most_overflows) {
      // The parser stops at such a number. Report it, put a harmless one there, and read on.
      const std::size_t start = builder.overflow();
      const std::size_t end = std::min(working.find_first_not_of("0123456789+-.eE", start), working.size());
      problems.push_back(
          {finder.place(start), builder.overflow_pointer(),
           fmt::format("the number {} is too large",
                       end - start > 24 ? working.substr(start, 20) + "..." : working.substr(start, end - start))});
      working[start] = '0';
      std::fill(working.begin() + static_cast<std::ptrdiff_t>(start) + 1,
                working.begin() + static_cast<std::ptrdiff_t>(end), ' ');
      overflows.push_back(start);  // found from front to back, so sorted
      continue;
    }
    problems.insert(problems.end(), builder.problems().begin(), builder.problems().end());
    if (is_read) return builder.take_root();
    Node bad;
    bad.is_bad = true;
    return bad;
  }
}

}  // namespace meniscus::scene_detail
