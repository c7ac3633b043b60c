// SPDX-License-Identifier: GPL-3.0-or-later
#include "text_scanner.h"

#include <fmt/format.h>

namespace meniscus::io {

TextScanner::TextScanner(const Source& source, TextSyntax syntax)
    : source_(source),
      syntax_(syntax),
      next_(source.bytes.data()),
      end_(next_ + source.bytes.size()),
      at_(next_),
      line_end_(next_) {
  if (source.bytes.substr(0, 3) == "\xEF\xBB\xBF") jump(3, 1);
}

void TextScanner::jump(std::size_t offset, std::size_t line) {
  next_ = at_ = line_end_ = source_.bytes.data() + offset;
  line_ = next_line_number_ = line;
}

bool TextScanner::next_line() {
  while (next_ != end_) {
    at_ = next_;
    line_ = next_line_number_;
    bool joins_next = true;
    while (joins_next && next_ != end_) {
      const void* feed = std::memchr(next_, '\n', static_cast<std::size_t>(end_ - next_));
      line_end_ = feed != nullptr ? static_cast<const char*>(feed) : end_;
      next_ = feed != nullptr ? line_end_ + 1 : end_;
      ++next_line_number_;
      const char* last = line_end_ - (line_end_ != at_ && line_end_[-1] == '\r' ? 1 : 0);
      joins_next = syntax_.continues && *at_ != syntax_.comment && last != at_ && is_joint(last - 1);
    }
    skip_space();
    if (at_ != line_end_) return true;
  }
  at_ = line_end_ = end_;
  return false;
}

bool TextScanner::at_line_end() {
  skip_space();
  return at_ == line_end_;
}

std::string_view TextScanner::rest_of_line() const {
  std::string_view rest(at_, static_cast<std::size_t>(line_end_ - at_));
  if (!rest.empty() && rest.back() == '\r') rest.remove_suffix(1);
  return rest;
}

void TextScanner::expect_line_end(const char* after) {
  if (const auto extra = word(); !extra.empty())
    fail(fmt::format("{} follows {}; remove it or correct the header", quote(extra), after));
}

void TextScanner::skip_numbers() {
  while (!at_line_end()) number<double>("an extra value");
}

void TextScanner::fail_number(std::string_view word, const char* what, bool is_integer, std::errc error) const {
  if (word.empty()) fail(fmt::format("the line ends before {}; complete it", what));
  if (error == std::errc::result_out_of_range)
    fail(fmt::format("{} is out of range for {}; write a number that fits", quote(word), what));
  fail(fmt::format("{} is not {}, but {} should stand here; correct it", quote(word),
                   is_integer ? "an integer" : "a number", what));
}

}  // namespace meniscus::io
