// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "source.h"

#include <charconv>
#include <cstring>
#include <string_view>
#include <type_traits>

namespace meniscus::io {

struct TextSyntax {
  char comment = '\0';     ///< begins a comment that ends with the line; NUL: there are none
  bool continues = false;  ///< a backslash at the end of a line joins the next one to it
};

/// Reads text line by line, and each line word by word, without copying. Line ends may be LF or
/// CRLF; a UTF-8 byte order mark at the start is skipped.
class TextScanner {
 public:
  explicit TextScanner(const Source& source, TextSyntax syntax = {});

  /// Goes to the next line that holds a word; false at the end of the text.
  bool next_line();
  /// The next word of the line; empty at its end.
  std::string_view word();
  /// Whether the line has no further word.
  bool at_line_end();
  /// What is left of the line, from the character after the last word, without its end.
  std::string_view rest_of_line() const;
  /// The next word as a number of the given type; throws, saying `what` it should be, if it is none.
  template <class Number>
  Number number(const char* what);
  /// Throws if the line has a further word.
  void expect_line_end(const char* after);
  /// Throws if the rest of the line is not numbers.
  void skip_numbers();

  Place place() const { return {Place::Kind::line, line_}; }
  /// The offset of the next line, and the bytes from there on.
  std::size_t offset() const { return static_cast<std::size_t>(next_ - source_.bytes.data()); }
  std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - next_); }
  /// Begins anew at an offset that is the start of line `line`.
  void jump(std::size_t offset, std::size_t line);

  [[noreturn]] void fail(std::string_view what) const { io::fail(source_, place(), what); }

 private:
  static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
  bool is_joint(const char* at) const;
  void skip_space();
  [[noreturn]] void fail_number(std::string_view word, const char* what, bool is_integer, std::errc error) const;

  const Source& source_;
  TextSyntax syntax_;
  const char* next_;      ///< where the next line begins
  const char* end_;       ///< of the text
  const char* at_;        ///< in the line
  const char* line_end_;  ///< the line's LF, or the end of the text
  std::size_t line_ = 1, next_line_number_ = 1;
};

/// Whether a backslash here joins the next line to this one.
inline bool TextScanner::is_joint(const char* at) const {
  if (*at != '\\' || !syntax_.continues) return false;
  const char* after = at + 1;
  if (after != line_end_ && *after == '\r') ++after;
  return after == line_end_ || *after == '\n';
}

inline void TextScanner::skip_space() {
  while (at_ != line_end_ && (is_space(*at_) || is_joint(at_))) ++at_;
  if (at_ != line_end_ && syntax_.comment != '\0' && *at_ == syntax_.comment) at_ = line_end_;
}

inline std::string_view TextScanner::word() {
  skip_space();
  const char* begin = at_;
  while (at_ != line_end_ && !is_space(*at_) && (*at_ != syntax_.comment || *at_ == '\0') && !is_joint(at_)) ++at_;
  return {begin, static_cast<std::size_t>(at_ - begin)};
}

template <class Number>
Number TextScanner::number(const char* what) {
  const std::string_view text = word();
  const char *begin = text.data(), *end = begin + text.size();
  if (text.size() > 1 && *begin == '+' && begin[1] != '-') ++begin;
  Number value{};
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (error != std::errc{} || stop != end) fail_number(text, what, std::is_integral_v<Number>, error);
  return value;
}

}  // namespace meniscus::io
