// SPDX-License-Identifier: GPL-3.0-or-later
#include "source.h"

#include "meniscus/core/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace meniscus::io {

void fail(const Source& source, Place place, std::string_view what) {
  throw FileError(place.kind == Place::Kind::line ? fmt::format("{}:{}: {}", source.name, place.number, what)
                                                  : fmt::format("{}: byte {}: {}", source.name, place.number, what));
}

void refuse_nul_bytes(const Source& source) {
  const auto nul = source.bytes.find('\0');
  if (nul == std::string_view::npos) return;
  const auto line = std::count(source.bytes.begin(), source.bytes.begin() + static_cast<std::ptrdiff_t>(nul), '\n') + 1;
  fail(source, {Place::Kind::line, static_cast<std::size_t>(line)},
       "holds a NUL byte, so this is no text; the file is damaged or of another format");
}

std::size_t take_room(const Source& source, Place place, std::string_view element, std::int64_t count,
                      std::size_t least_bytes, std::size_t room) {
  if (count < 0) fail(source, place, fmt::format("{} is no number of elements {}; correct the count", count, element));
  const auto n = static_cast<std::uint64_t>(count);
  if (least_bytes > 0 && n > room / least_bytes)
    fail(source, place,
         fmt::format("{} elements {} cannot fit into the {} bytes left; the count is wrong or the file is truncated",
                     count, element, room));
  if (n >= UINT32_MAX)
    fail(source, place,
         fmt::format("{} elements {} are more than 32-bit indices allow; split the mesh", count, element));
  return room - n * least_bytes;
}

std::string quote(std::string_view word) {
  constexpr std::size_t kLongest = 40;
  std::string text(word.substr(0, kLongest));
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return '"' + text + (word.size() > kLongest ? "...\"" : "\"");
}

void check_list_length(const Source& source, Place place, std::int64_t length) {
  if (length < 0) fail(source, place, fmt::format("a list cannot have {} entries; the file is damaged", length));
  if (length > kMaxListLength)
    fail(source, place,
         fmt::format("a list of {} entries is longer than {}; the file is damaged, or cut the face up", length,
                     kMaxListLength));
}

}  // namespace meniscus::io
