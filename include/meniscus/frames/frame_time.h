// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/mesh_data.h"

#include <filesystem>
#include <optional>
#include <vector>

namespace meniscus {

/// The time (s) that a frame's comment "time <s>" tells; nothing if there is none or it is not a finite number.
std::optional<double> frame_time(const MeshData& data);

/// The PLY frames in a directory (see is_frame_name), in the order of their numbers; gaps are allowed.
/// Throws FileError if it cannot be listed.
std::vector<std::filesystem::path> find_frames(const std::filesystem::path& directory);

}  // namespace meniscus
