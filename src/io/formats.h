// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/mesh_data.h"
#include "source.h"

#include <string>

/// One reader and one writer a format. Readers throw FileError; writers return the file's bytes and
/// may rely on check_writable.
namespace meniscus::io {

MeshData read_ply(const Source& source);
MeshData read_off(const Source& source);
MeshData read_obj(const Source& source);
MeshData read_stl(const Source& source);

/// Throws FileError, naming `name`, if a triangle names a vertex that is not there.
void check_writable(const MeshData& data, const std::string& name);

std::string write_ply(const MeshData& data, bool binary, const std::string& name);
std::string write_off(const MeshData& data);
std::string write_obj(const MeshData& data);
std::string write_stl(const MeshData& data, bool binary, const std::string& name);

}  // namespace meniscus::io
