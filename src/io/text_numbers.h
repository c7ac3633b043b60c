// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <charconv>
#include <string>

namespace meniscus::io {

/// Appends the shortest decimal that reads back to the same bits.
template <class Number>
void append_text(std::string& out, Number value) {
  std::array<char, 32> text;
  out.append(text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr);
}

/// Appends the numbers with spaces between them.
template <class Numbers>
void append_line(std::string& out, const Numbers& numbers) {
  const char* separator = "";
  for (const auto number : numbers) {
    out += separator;
    append_text(out, number);
    separator = " ";
  }
  out += '\n';
}

}  // namespace meniscus::io
