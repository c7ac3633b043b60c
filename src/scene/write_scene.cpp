// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/scene/write_scene.h"

#include "scene_table.h"

namespace meniscus {
namespace {

using namespace scene_detail;

Json to_json(const std::vector<Key>& keys, const void* owner, const std::string& shape = {});

Json to_json(const Items& items, const void* owner) {
  Json list = Json::array();
  for (const void* item : items.all(owner)) {
    list.push_back(to_json(items.keys, item, items.shape_of ? items.shape_of(item) : ""));
  }
  return list;
}

Json to_json(const std::vector<Key>& keys, const void* owner, const std::string& shape) {
  Json object = Json::object();
  for (const Key& key : keys) {
    if (!key.applies_to(shape)) continue;
    Json value;
    if (key.kind == KeyKind::section)
      value = to_json(key.keys, owner);
    else if (key.kind == KeyKind::list)
      value = to_json(*key.items, owner);
    else if (key.get)
      value = key.get(owner);
    if (!value.is_null()) object[key.name] = std::move(value);
  }
  return object;
}

}  // namespace

std::string resolved_scene(const Scene& scene) {
  return to_json(scene_keys(), &scene).dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace meniscus
