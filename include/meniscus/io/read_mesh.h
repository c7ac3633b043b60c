// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/mesh_data.h"
#include "meniscus/io/mesh_format.h"
#include "meniscus/io/read_file.h"

#include <filesystem>
#include <iosfwd>
#include <string>

namespace meniscus {

/// The mesh in a file, as it stands there: nothing is repaired, oriented or dropped.
///
/// - PLY: ascii and binary of either byte order; scalar vertex properties other than x, y, z become
///   attributes of the same type, comments are kept; other elements and lists are skipped.
/// - OFF: ascii, with or without C, N, ST extras, which are skipped. OBJ: v and f lines only.
/// - STL: ascii and binary; corners with equal coordinates become one vertex (-0 equals 0).
/// - Polygons are cut into triangles without overlap where the polygon is simple; source_face then
///   says which face each triangle came from. One that crosses itself gives triangles that do too.
/// - Coordinates may be nan or infinite: whoever uses the mesh has to look.
///
/// Throws UsageError if the extension names no format, else FileError, as `name:line: what; remedy`
/// in text and `name: byte offset: what; remedy` in binary data. Faces and vertices are counted as the
/// file's format does (from 1 in OBJ for vertices, from 0 for all else).
MeshData read_mesh(const std::filesystem::path& path);

/// The same from a stream that `name` stands for in messages, read to its end first.
MeshData read_mesh(std::istream& in, MeshFormat format, const std::string& name,
                   std::size_t max_bytes = kMaxStreamBytes);

}  // namespace meniscus
