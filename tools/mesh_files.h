// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "command.h"
#include "meniscus/core/error.h"
#include "meniscus/core/mesh_data.h"
#include "meniscus/io/write_mesh.h"
#include "meniscus/state/drop.h"

#include <string>

/// Meshes in and out of the program, and between files and drops.
namespace meniscus::tools {

/// The name of "-" in messages and reports.
std::string shown_name(const std::string& file);

/// Reads a mesh from a file, or from stdin if it is "-" (then common.format must say which format).
/// Says on stderr if polygons were cut into triangles.
MeshData read_input(const std::string& file, const CommonOptions& common);

/// Writes a mesh to a file, or to stdout if it is "-". Says on stderr what the format cannot hold.
void write_output(const std::string& file, const MeshData& data, const CommonOptions& common,
                  const WriteOptions& options = {});

/// Throws UsageError now if write_output to `file` would fail for lack of a format, or if the data and
/// the report would both go to stdout; so that it is known before the work is done.
void check_output(const std::string& file, const CommonOptions& common);

/// The mesh as one drop, whatever number of pieces it has: vx, vy, vz and contact become the drop's
/// own, other attributes ride along. Row v is vertex v. Throws GeometryError, naming the file.
Drop to_drop(const MeshData& data, const std::string& file);

/// A drop's mesh with the attributes that `like` has, and its comments; of those on target volumes
/// only with `keep_targets`.
MeshData to_output(const Mesh& mesh, const MeshData& like, bool keep_targets);

/// Throws GeometryError with "file: " before its message.
template <class Function>
auto naming(const std::string& file, Function function) {
  try {
    return function();
  } catch (const GeometryError& error) {
    throw GeometryError(shown_name(file) + ": " + error.what(), error.faces(), error.vertices());
  }
}

}  // namespace meniscus::tools
