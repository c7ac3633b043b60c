// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace meniscus {

/// The JSON Schema (draft 2020-12) of scene files, as JSON text. It knows names, types, ranges and
/// words; what ties several keys together (say, receding <= advancing) only the reader checks.
std::string scene_schema();

/// The reference of all keys in Markdown, from the same table: the body of docs/SCENE.md.
std::string scene_reference_markdown();

}  // namespace meniscus
