// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/scene/scene.h"

#include <string>

namespace meniscus {

/// The scene as JSON text with every default filled in. parse_scene with the same directory reads
/// it back to the same values, bit for bit, if the scene was valid. File names stay as written.
std::string resolved_scene(const Scene& scene);

}  // namespace meniscus
