// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string_view>

namespace meniscus {

/// The mesh files that we read and write. Only PLY holds vertex attributes and comments.
enum class MeshFormat { ply, off, obj, stl };

/// The format that the file's extension names, in either case.
/// Throws UsageError, listing the formats, if it names none.
MeshFormat format_of(const std::filesystem::path& path);

/// The format called "ply", "off", "obj" or "stl", in either case. Throws UsageError otherwise.
MeshFormat parse_format(std::string_view name);

/// "ply", "off", "obj" or "stl".
std::string_view format_name(MeshFormat format);

}  // namespace meniscus
