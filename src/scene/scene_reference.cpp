// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/scene/scene_schema.h"
#include "scene_table.h"

#include <fmt/format.h>

#include <cctype>

namespace meniscus {
namespace {

using namespace scene_detail;

std::string default_text(const Key& key, const void* defaults) {
  if (key.is_required) return "required";
  if (!key.default_note.empty()) return key.default_note;
  const Json value = key.get ? key.get(defaults) : Json();
  return value.is_null() ? "" : fmt::format("`{}`", value.dump());
}

std::string row(const Key& key, const void* defaults, bool has_shapes) {
  const std::string shapes = key.shapes.empty() ? "all" : fmt::format("{}", fmt::join(key.shapes, ", "));
  return fmt::format("| `{}` |{} {} | {} | {} |\n", key.name, has_shapes ? " " + shapes + " |" : "",
                     (key.kind == KeyKind::number && key.describe() != "a number" ? "number, " : "") + key.describe(),
                     default_text(key, defaults), key.help);
}

std::string sentence(std::string help) {
  help.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(help.front())));
  return help + ".";
}

bool is_row(const Key& key) {
  return key.kind != KeyKind::section && key.kind != KeyKind::list && key.kind != KeyKind::unavailable &&
         key.kind != KeyKind::ignored;
}

std::string table(const std::vector<Key>& keys, const void* defaults, bool has_shapes = false) {
  std::string text = has_shapes ? "| key | of | value | default | meaning |\n|---|---|---|---|---|\n"
                                : "| key | value | default | meaning |\n|---|---|---|---|\n";
  for (const Key& key : keys) {
    if (is_row(key)) text += row(key, defaults, has_shapes);
  }
  return text + "\n";
}

std::string list_reference(const Key& key, const std::string& path) {
  const Items& items = *key.items;
  std::string text = fmt::format("### `{}`\n\n{} A list of objects.\n\n", path, sentence(key.help));
  text += table(items.keys, items.defaults.get(), !items.shapes.empty());
  for (const Key& inner : items.keys) {
    if (inner.kind == KeyKind::list) text += list_reference(inner, path + "[]." + inner.name);
  }
  return text;
}

// Keys and words that are known but not available yet.
void collect_planned(const std::vector<Key>& keys, const std::string& path, std::string& text) {
  for (const Key& key : keys) {
    const std::string name = path + key.name;
    if (key.kind == KeyKind::unavailable) text += fmt::format("- `{}`: {}\n", name, key.help);
    for (const Choice& choice : key.choices) {
      if (!choice.is_available) text += fmt::format("- `{}`: `\"{}\"`\n", name, choice.name);
    }
    collect_planned(key.keys, name + ".", text);
    if (key.items) collect_planned(key.items->keys, name + "[].", text);
  }
}

}  // namespace

std::string scene_reference_markdown() {
  const Scene defaults = default_scene();
  std::string text = "### Top level\n\n" + table(scene_keys(), &defaults);
  for (const Key& key : scene_keys()) {
    if (key.kind == KeyKind::section) {
      text += fmt::format("### `{}`\n\n{}\n\n", key.name, sentence(key.help)) + table(key.keys, &defaults);
    }
    if (key.kind == KeyKind::list) text += list_reference(key, key.name);
  }
  text += "### Not available in this version\n\n";
  collect_planned(scene_keys(), "", text);
  return text;
}

}  // namespace meniscus
