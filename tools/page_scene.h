// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "console.h"
#include "meniscus/core/mesh_data.h"
#include "report.h"

#include <filesystem>
#include <optional>
#include <vector>

namespace meniscus::tools {

/// A solid as the page shows it.
struct PageSolid {
  Json keys;                     ///< as the resolved scene gives it
  std::optional<MeshData> mesh;  ///< of a solid of this shape: placed, cm
};

/// What the page shows of a scene beside the drops.
struct PageScene {
  std::vector<PageSolid> solids;
  Json sources = Json::array();  ///< as the resolved scene gives them
};

/// The scene that DIR/run.json tells of; an empty one if there is no such file. A solid whose mesh cannot be found is
/// left out, and a warning says so: its name is tried from the scene's directory, as seen from here, then from DIR.
/// Throws FileError, naming the file, if run.json is not what evolve writes or a mesh cannot be read.
PageScene read_run_scene(const std::filesystem::path& directory, const Console& console);

}  // namespace meniscus::tools
