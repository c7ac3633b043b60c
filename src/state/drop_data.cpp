// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/core/error.h"
#include "meniscus/core/index_sets.h"
#include "meniscus/state/drop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

namespace meniscus {
namespace {

/// Attributes that to_mesh_data(drops) writes and to_drops reads into the drop's own maps.
constexpr const char* own_attributes[] = {"vx", "vy", "vz", "drop", "contact"};

bool is_own(const std::string& name) {
  return std::any_of(std::begin(own_attributes), std::end(own_attributes),
                     [&](const char* own) { return name == own; });
}

/// A label a vertex: the attribute "drop", or else the connected component by smallest vertex.
std::vector<std::int64_t> drop_labels(const MeshData& data) {
  std::vector<std::int64_t> label(data.points.size());
  if (const VertexAttribute* drop = data.attribute("drop")) {
    std::transform(drop->values.begin(), drop->values.end(), label.begin(),
                   [](double value) { return std::llround(value); });
    return label;
  }
  IndexSets sets(label.size());
  for (const auto& [a, b, c] : data.triangles) {
    sets.unite(a, b);
    sets.unite(b, c);
  }
  std::map<std::uint32_t, std::int64_t> number;  // by the first vertex of each component
  for (std::uint32_t v = 0; v < label.size(); ++v)
    label[v] = number.emplace(sets.find(v), static_cast<std::int64_t>(number.size())).first->second;
  return label;
}

/// The target volumes that comments "drop <id> target_volume <cm^3>" give.
std::map<std::int64_t, double> target_volumes(const MeshData& data) {
  std::map<std::int64_t, double> volumes;
  for (const std::string& comment : data.comments) {
    std::istringstream words(comment);
    std::string drop, key;
    std::int64_t id = 0;
    double volume = 0;
    if (!(words >> drop >> id >> key) || drop != "drop" || key != "target_volume") continue;
    if (!(words >> volume) || !(volume > 0) || !std::isfinite(volume))
      throw GeometryError(
          fmt::format("the comment \"{}\" gives no volume greater than zero; correct or remove it", comment));
    volumes[id] = volume;
  }
  return volumes;
}

/// The part of the soup with one label, with its attributes; `face_in_file` keeps its meaning.
MeshData part_of(const MeshData& data, const std::vector<std::int64_t>& label, std::int64_t wanted) {
  MeshData part;
  std::vector<std::uint32_t> row(data.points.size(), 0);
  for (const auto& attribute : data.attributes) part.attributes.push_back({attribute.name, attribute.type, {}});
  for (std::size_t v = 0; v < label.size(); ++v) {
    if (label[v] != wanted) continue;
    row[v] = static_cast<std::uint32_t>(part.points.size());
    part.points.push_back(data.points[v]);
    for (std::size_t a = 0; a < data.attributes.size(); ++a)
      part.attributes[a].values.push_back(data.attributes[a].values[v]);
  }
  for (std::size_t t = 0; t < data.triangles.size(); ++t) {
    const auto& [a, b, c] = data.triangles[t];
    if (label[a] != wanted && label[b] != wanted && label[c] != wanted) continue;
    if (label[a] != label[b] || label[b] != label[c])
      throw GeometryError(
          fmt::format("face {} joins vertices of different drops; mend the attribute \"drop\"", data.face_in_file(t)),
          {data.face_in_file(t)});
    part.triangles.push_back({row[a], row[b], row[c]});
    part.source_face.push_back(static_cast<std::uint32_t>(data.face_in_file(t)));
  }
  return part;
}

void read_velocities(const MeshData& part, Drop& drop) {
  const char* const names[] = {"vx", "vy", "vz"};
  for (int k = 0; k < 3; ++k) {
    const VertexAttribute* component = part.attribute(names[k]);
    if (!component) continue;
    for (std::size_t v = 0; v < component->values.size(); ++v) {
      if (!std::isfinite(component->values[v]))
        throw GeometryError(
            fmt::format("drop {}: velocity {} of its vertex {} is not a finite number", drop.id(), names[k], v), {},
            {v});
      drop.velocities()(k, static_cast<Eigen::Index>(v)) = component->values[v];
    }
  }
}

void read_contact(const MeshData& part, Drop& drop) {
  const VertexAttribute* contact = part.attribute("contact");
  if (!contact) return;
  for (std::size_t v = 0; v < contact->values.size(); ++v)
    drop.contact()[v] = contact->values[v] == 1   ? Contact::wetted
                        : contact->values[v] == 2 ? Contact::line
                                                  : Contact::free;
}

}  // namespace

std::vector<Drop> to_drops(const MeshData& data) {
  if (data.triangles.empty()) throw GeometryError("the mesh is empty: a drop needs at least four faces");
  for (std::size_t t = 0; t < data.triangles.size(); ++t)
    for (const std::uint32_t v : data.triangles[t])
      if (v >= data.points.size())
        throw GeometryError(fmt::format("face {} names vertex {}, but there are only {} vertices", data.face_in_file(t),
                                        v, data.points.size()),
                            {data.face_in_file(t)});
  const std::vector<std::int64_t> label = drop_labels(data);
  std::vector<std::int64_t> ids = label;
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  const std::map<std::int64_t, double> volumes = target_volumes(data);
  std::vector<Drop> drops;
  for (const std::int64_t id : ids) {
    MeshData part = part_of(data, label, id);
    if (part.triangles.empty()) {
      const auto lonely = static_cast<std::size_t>(std::find(label.begin(), label.end(), id) - label.begin());
      throw GeometryError(fmt::format("vertex {} belongs to no face; remove it", lonely), {}, {lonely});
    }
    std::vector<VertexAttribute> own;
    for (auto& attribute : part.attributes)
      if (is_own(attribute.name)) own.push_back(attribute);
    part.attributes.erase(std::remove_if(part.attributes.begin(), part.attributes.end(),
                                         [](const auto& attribute) { return is_own(attribute.name); }),
                          part.attributes.end());
    Drop drop(to_mesh(part));
    drop.set_id(static_cast<int>(id));
    part.attributes = std::move(own);
    read_velocities(part, drop);
    read_contact(part, drop);
    if (const auto volume = volumes.find(id); volume != volumes.end()) drop.set_target_volume(volume->second);
    drops.push_back(std::move(drop));
  }
  return drops;
}

MeshData to_mesh_data(const std::vector<Drop>& drops) {
  MeshData data;
  VertexAttribute velocity[3] = {
      {"vx", ScalarType::float64, {}}, {"vy", ScalarType::float64, {}}, {"vz", ScalarType::float64, {}}};
  VertexAttribute id{"drop", ScalarType::int32, {}}, contact{"contact", ScalarType::uint8, {}};
  for (const Drop& drop : drops) {
    std::vector<std::uint32_t> row(drop.num_rows(), 0);
    for (const auto v : drop.mesh().vertices()) {
      row[v] = static_cast<std::uint32_t>(data.points.size());
      const Point& p = drop.mesh().point(v);
      data.points.push_back({p.x(), p.y(), p.z()});
      for (int k = 0; k < 3; ++k) velocity[k].values.push_back(drop.velocities()(k, static_cast<Eigen::Index>(v)));
      id.values.push_back(drop.id());
      contact.values.push_back(static_cast<double>(drop.contact()[v]));
    }
    for (const auto& [a, b, c] : drop.connectivity().triangles())
      if (a != Connectivity::removed) data.triangles.push_back({row[a], row[b], row[c]});
    data.comments.push_back(fmt::format("drop {} target_volume {}", drop.id(), drop.target_volume()));
  }
  for (auto& component : velocity) data.attributes.push_back(std::move(component));
  data.attributes.push_back(std::move(id));
  data.attributes.push_back(std::move(contact));
  return data;
}

}  // namespace meniscus
