// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/mesh_data.h"
#include "meniscus/io/mesh_format.h"

#include <filesystem>
#include <iosfwd>

namespace meniscus {

struct WriteOptions {
  bool binary = true;  ///< PLY (little-endian) and STL in binary; else, like OFF and OBJ always, as text
};

/// Writes a mesh in the format that the extension names, whole or not at all (write_file_atomically).
///
/// - PLY holds everything: float64 x y z, then the attributes with their types, and the comments
///   (control characters become spaces). OFF and OBJ hold points and triangles.
/// - STL holds triangles: isolated vertices are lost and coincident ones will be joined when it is read.
///   Binary STL rounds to float32, and is refused if that would join points that were apart.
/// - Text is the shortest that reads back to the same bits. An attribute of type float32 is rounded.
///
/// Throws UsageError if the extension names no format; FileError if the file cannot be written, if
/// an attribute's values do not fit its type or its name is not one word used once, or if a triangle
/// names a vertex that is not there.
void write_mesh(const std::filesystem::path& path, const MeshData& data, const WriteOptions& options = {});

/// The same to a stream; "output" stands for it in messages.
void write_mesh(std::ostream& out, MeshFormat format, const MeshData& data, const WriteOptions& options = {});

}  // namespace meniscus
