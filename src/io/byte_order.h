// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

/// Numbers in binary files; we run on little-endian machines.
namespace meniscus::io {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "binary files are written in the machine's byte order");

template <class Number>
Number load(const char* bytes, bool is_big_endian = false) {
  std::array<char, sizeof(Number)> copy;
  std::memcpy(copy.data(), bytes, sizeof(Number));
  if (is_big_endian) std::reverse(copy.begin(), copy.end());
  Number value;
  std::memcpy(&value, copy.data(), sizeof(Number));
  return value;
}

template <class Number>
void append_binary(std::string& out, Number value) {
  std::array<char, sizeof(Number)> bytes;
  std::memcpy(bytes.data(), &value, sizeof(Number));
  out.append(bytes.data(), bytes.size());
}

}  // namespace meniscus::io
