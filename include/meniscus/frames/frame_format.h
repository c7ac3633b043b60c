// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/mesh_data.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace meniscus {

/// What frames can be written as. A usda is one file of all frames; of the others each frame has its own.
enum class FrameFormat { ply, off, obj, vtp, glb, usda };

/// "ply", "off", ...
std::string_view format_name(FrameFormat format);

/// The format of that name, in lower case; nothing if there is none.
std::optional<FrameFormat> find_frame_format(std::string_view name);

/// The formats of a list like "ply,off,vtp", PLY always first (the others are made from it or say less),
/// each once. Throws UsageError for a name that is no format of frames.
std::vector<FrameFormat> parse_frame_formats(std::string_view list);

/// "frame_0042.ply"; more than four digits from frame 10000 on.
std::string frame_name(int frame, FrameFormat format);

/// Whether a file's name is one that frame_name gives.
bool is_frame_name(std::string_view name);

/// Writes a mesh as one file of any of these formats, whole or not at all. `time` (s) goes into VTP.
/// Throws FileError as write_mesh does, GeometryError if a point or velocity is not finite.
void write_frame(const std::filesystem::path& path, FrameFormat format, const MeshData& data, double time = 0);

}  // namespace meniscus
