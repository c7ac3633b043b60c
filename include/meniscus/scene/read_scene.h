// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/error.h"
#include "meniscus/scene/scene.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace meniscus {

/// Everything that is wrong with a scene, in the order of the file, then of the settings. Each
/// message is "name:line:column /json/pointer: what", or "--set path=value: what". Lines and
/// columns count from 1, columns in characters. what() is all of them, one a line.
class SceneError : public UsageError {
 public:
  explicit SceneError(std::vector<std::string> messages);
  const std::vector<std::string>& messages() const { return messages_; }

 private:
  std::vector<std::string> messages_;
};

/// Reads a scene file: JSON, with // and /* */ comments. Relative file names in it are relative to
/// its directory. Each setting is "path=value": the path as in liquid.viscosity, drops.0.radius or
/// /drops/0/radius, the value as JSON or else taken as text; settings are applied in turn before
/// the scene is checked, and add keys or (at the index just past the end) items that are not there.
/// Throws FileError if the file cannot be read (or is larger than 16 MB), SceneError for the rest.
Scene read_scene(const std::filesystem::path& path, const std::vector<std::string>& settings = {});

/// Whether the files that a scene names have to be there when it is read.
enum class SceneFiles { are_there, not_looked_for };

/// The same for a scene in memory, called `name` in messages.
Scene parse_scene(std::string_view text, const std::string& name, const std::filesystem::path& directory,
                  const std::vector<std::string>& settings = {}, SceneFiles files = SceneFiles::are_there);

}  // namespace meniscus
