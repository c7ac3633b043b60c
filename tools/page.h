// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "command.h"
#include "page_scene.h"

#include <filesystem>
#include <string>
#include <vector>

namespace meniscus::tools {

/// What the page plays.
struct PageInput {
  std::string title;
  std::vector<std::filesystem::path> frames;  ///< meshes, one a frame
  bool timed = false;                         ///< their comments tell the time; else frame k is at k s
  PageScene scene;
};

struct PageReport {
  std::size_t frames = 0, max_triangles = 0, topologies = 0;
};

/// The page as one HTML file. `pieces` are the page without its data (tools/viewer/build.mjs): the list of frames
/// and solids goes behind the first piece, the blocks of bytes behind the second.
/// Throws FileError or GeometryError, naming the file, for a frame that cannot be read or shown.
std::string make_page(const PageInput& input, const std::vector<std::string>& pieces, PageReport& report);

}  // namespace meniscus::tools
