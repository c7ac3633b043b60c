// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <iosfwd>
#include <string>

namespace meniscus {

/// As much as we take from a pipe or stdin, whose length nobody knows beforehand: 2 GiB.
inline constexpr std::size_t kMaxStreamBytes = std::size_t{1} << 31;

/// A file's bytes. Throws FileError, naming the file, if it is missing, a directory, unreadable, or
/// a pipe or device that gives more than kMaxStreamBytes.
std::string read_file(const std::filesystem::path& path);

/// A stream's bytes to its end. Throws FileError, naming `name`, if there are more than `max_bytes`.
std::string read_stream(std::istream& in, const std::string& name, std::size_t max_bytes = kMaxStreamBytes);

}  // namespace meniscus
