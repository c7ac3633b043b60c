// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/scene/scene_schema.h"

#include "scene_table.h"

#include <cmath>

namespace meniscus {
namespace {

using namespace scene_detail;

Json object_schema(const std::vector<Key>& keys, const void* defaults, const std::string& shape = {});

void add_range(Json& schema, const Range& range) {
  if (std::isfinite(range.low)) schema[range.is_low_open ? "exclusiveMinimum" : "minimum"] = range.low;
  if (std::isfinite(range.high)) schema[range.is_high_open ? "exclusiveMaximum" : "maximum"] = range.high;
}

// One schema a shape, of which an item must match one.
Json items_schema(const Items& items) {
  if (items.shapes.empty()) return object_schema(items.keys, items.defaults.get());
  Json variants = Json::array();
  for (const std::string& shape : items.shapes) {
    Json variant = object_schema(items.keys, items.defaults.get(), shape);
    if (variant["properties"].contains("shape")) {
      variant["properties"]["shape"].erase("enum");
      variant["properties"]["shape"]["const"] = shape;
    }
    variants.push_back({{"title", shape + " " + items.noun}});
    variants.back().update(variant);
  }
  return {{"oneOf", std::move(variants)}};
}

Json key_schema(const Key& key, const void* defaults) {
  Json schema = Json::object();
  switch (key.kind) {
    case KeyKind::number:
    case KeyKind::integer:
      schema["type"] = key.kind == KeyKind::number ? "number" : "integer";
      add_range(schema, key.range);
      break;
    case KeyKind::boolean:
      schema["type"] = "boolean";
      break;
    case KeyKind::text:
    case KeyKind::file:
      schema["type"] = "string";
      schema["minLength"] = 1;
      break;
    case KeyKind::choice:
      schema["enum"] = Json::array();
      for (const Choice& choice : key.choices) {
        if (choice.is_available) schema["enum"].push_back(choice.name);
      }
      break;
    case KeyKind::vector:
      schema = {{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 3}, {"maxItems", 3}};
      add_range(schema["items"], key.range);
      break;
    case KeyKind::section:
      schema = object_schema(key.keys, defaults);
      break;
    case KeyKind::list:
      schema["type"] = "array";
      schema["items"] = items_schema(*key.items);
      if (key.is_required) schema["minItems"] = 1;
      break;
    case KeyKind::ignored:
    case KeyKind::unavailable:
      break;
  }
  schema["description"] = key.unit.empty() ? key.help : key.help + " (" + key.unit + ")";
  if (key.get && !key.is_required && key.default_note.empty()) {
    const Json value = key.get(defaults);
    if (!value.is_null()) schema["default"] = value;
  }
  return schema;
}

Json object_schema(const std::vector<Key>& keys, const void* defaults, const std::string& shape) {
  Json properties = Json::object();
  Json required = Json::array();
  for (const Key& key : keys) {
    if (!key.applies_to(shape) || key.kind == KeyKind::unavailable) continue;
    properties[key.name] = key_schema(key, defaults);
    if (key.is_required) required.push_back(key.name);
  }
  Json schema = {{"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
  if (!required.empty()) schema["required"] = std::move(required);
  return schema;
}

}  // namespace

std::string scene_schema() {
  Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                 {"title", "meniscus scene"},
                 {"description", "Drops of liquid and the solids that they meet; cm, g, s. Comments are allowed."}};
  const Scene defaults = default_scene();
  schema.update(object_schema(scene_keys(), &defaults));
  schema["anyOf"] = {{{"required", {"drops"}}}, {{"required", {"sources"}}}};
  return schema.dump(2) + "\n";
}

}  // namespace meniscus
