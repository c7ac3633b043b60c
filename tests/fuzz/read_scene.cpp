// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/scene/read_scene.h"
#include "fuzz.h"
#include "meniscus/scene/write_scene.h"

/// The scene reader: a text, or settings (lines "path=value") behind a NUL and after a text.
void meniscus::fuzz::run(std::string_view input) {
  const std::size_t nul = input.find('\0');
  std::vector<std::string> settings;
  if (nul != std::string_view::npos && nul + 1 < input.size()) settings.emplace_back(input.substr(nul + 1));
  Scene scene;
  try {
    scene = parse_scene(input.substr(0, nul), "fuzz", "/nowhere", settings);
  } catch (const SceneError& error) {
    require(!error.messages().empty());
    return;
  }
  const std::string resolved = resolved_scene(scene);
  require(resolved_scene(parse_scene(resolved, "resolved", "/nowhere")) == resolved);
}
