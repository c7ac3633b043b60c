// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/scene/read_scene.h"
#include "scene_table.h"
#include "scene_tree.h"

#include <string>
#include <vector>

/// The two passes over a parsed scene.
namespace meniscus::scene_detail {

/// First pass: every key by itself, as the table says, into `scene` (whose directory is set).
void read_keys(const Node& root, Scene& scene, SceneFiles files, std::vector<Problem>& problems);

/// Second pass: what ties keys together. Looks at no value that already has a problem.
void check_scene(const Node& root, const Scene& scene, std::vector<Problem>& problems);

}  // namespace meniscus::scene_detail
