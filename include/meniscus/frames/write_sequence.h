// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/frames/frame_format.h"

#include <filesystem>
#include <vector>

namespace meniscus {

/// Writes frames, one mesh file each, as one file that plays them, whole or not at all: usda (points, faces and
/// velocities sampled in time) or glb (a flipbook: a node a frame, shown in its time; without velocities). The times
/// are those that the frames tell (frame_time), or 1/24 s apart if one tells none.
/// Throws UsageError for another format; what read_mesh throws; GeometryError, naming the file, if a point or
/// velocity is not finite; FileError if it cannot be written or a glb would be 4 GiB or more.
void write_sequence(const std::filesystem::path& output, FrameFormat format,
                    const std::vector<std::filesystem::path>& frames);

}  // namespace meniscus
