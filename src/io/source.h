// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace meniscus::io {

/// A file's bytes and the name that stands for it in messages.
struct Source {
  std::string name;
  std::string_view bytes;
};

/// Where something stands in a source: a line of text (from 1) or an offset into binary data (from 0).
struct Place {
  enum class Kind { line, byte } kind;
  std::size_t number;
};

/// Throws FileError "name:line: what" or "name: byte offset: what".
[[noreturn]] void fail(const Source& source, Place place, std::string_view what);

/// Throws if the source holds a NUL byte, which no text does.
void refuse_nul_bytes(const Source& source);

/// Throws if `count` elements of at least `least_bytes` each cannot fit into `room` bytes or have
/// indices of 32 bits; else returns the room that is left.
std::size_t take_room(const Source& source, Place place, std::string_view element, std::int64_t count,
                      std::size_t least_bytes, std::size_t room);

/// A word of a file in quotes: cut short, unprintable characters replaced.
std::string quote(std::string_view word);

/// The most corners or list entries that we believe a file to mean.
inline constexpr std::int64_t kMaxListLength = 1000000;

/// Throws unless 0 <= length <= kMaxListLength.
void check_list_length(const Source& source, Place place, std::int64_t length);

}  // namespace meniscus::io
