// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh_files.h"

#include "meniscus/io/read_mesh.h"

#include <algorithm>
#include <cmath>
#include <iostream>

namespace meniscus::tools {
namespace {

MeshFormat stream_format(const CommonOptions& common) {
  if (!common.format) throw UsageError("-: say which format it has with --format ply, off, obj or stl");
  return *common.format;
}

void say_polygons(const std::string& file, const MeshData& data, const Console& console) {
  if (data.source_face.empty()) return;
  std::size_t polygons = 0, triangles = 0;
  for (std::size_t t = 0; t < data.source_face.size();) {
    std::size_t end = t + 1;
    while (end < data.source_face.size() && data.source_face[end] == data.source_face[t]) ++end;
    if (end - t > 1) {
      ++polygons;
      triangles += end - t;
    }
    t = end;
  }
  if (polygons > 0)
    console.say(fmt::format("{}: {} {} cut into {} triangles", shown_name(file), polygons,
                            polygons == 1 ? "polygon" : "polygons", triangles));
}

void say_lost(const std::string& file, MeshFormat format, const MeshData& data, const Console& console) {
  if (format == MeshFormat::ply || data.attributes.empty()) return;
  std::string names;
  for (const auto& attribute : data.attributes) names += " " + attribute.name;
  console.say(fmt::format("{}: {} holds no attributes, so these are left out:{}", shown_name(file), format_name(format),
                          names));
}

bool is_drops_own(const VertexAttribute& attribute) {
  return attribute.name == "vx" || attribute.name == "vy" || attribute.name == "vz" || attribute.name == "contact";
}

void read_own(const MeshData& data, Drop& drop) {
  const char* const names[] = {"vx", "vy", "vz"};
  for (int k = 0; k < 3; ++k)
    if (const VertexAttribute* component = data.attribute(names[k]))
      for (std::size_t v = 0; v < component->values.size(); ++v) {
        if (!std::isfinite(component->values[v]))
          throw GeometryError(fmt::format("vertex {}: its {} is not a finite number", v, names[k]), {}, {v});
        drop.velocities()(k, static_cast<Eigen::Index>(v)) = component->values[v];
      }
  if (const VertexAttribute* contact = data.attribute("contact"))
    for (std::size_t v = 0; v < contact->values.size(); ++v)
      drop.contact()[v] = contact->values[v] == 1   ? Contact::wetted
                          : contact->values[v] == 2 ? Contact::line
                                                    : Contact::free;
}

void write_velocity(const Mesh& mesh, int axis, std::vector<double>& values) {
  const auto [velocity, found] = mesh.property_map<VertexIndex, Vector>("v:velocity");
  if (!found) return;
  std::size_t row = 0;
  for (const auto v : mesh.vertices()) values[row++] = velocity[v][axis];
}

void write_contact(const Mesh& mesh, std::vector<double>& values) {
  const auto [contact, found] = mesh.property_map<VertexIndex, Contact>("v:contact_state");
  if (!found) return;
  std::size_t row = 0;
  for (const auto v : mesh.vertices()) values[row++] = static_cast<double>(contact[v]);
}

void write_own(const Mesh& mesh, VertexAttribute& attribute) {
  if (!is_drops_own(attribute)) {
    if (is_integer(attribute.type))
      for (double& value : attribute.values) value = std::round(value);
  } else if (attribute.name == "contact") {
    write_contact(mesh, attribute.values);
  } else {
    write_velocity(mesh, attribute.name[1] - 'x', attribute.values);
  }
}

bool is_target(const std::string& comment) {
  return comment.rfind("drop ", 0) == 0 && comment.find(" target_volume ") != std::string::npos;
}

}  // namespace

std::string shown_name(const std::string& file) { return file == "-" ? "<stdin>" : file; }

MeshData read_input(const std::string& file, const CommonOptions& common) {
  MeshData data = file == "-" ? read_mesh(std::cin, stream_format(common), "<stdin>") : read_mesh(file);
  say_polygons(file, data, common.console());
  return data;
}

void write_output(const std::string& file, const MeshData& data, const CommonOptions& common,
                  const WriteOptions& options) {
  const MeshFormat format = file == "-" ? stream_format(common) : format_of(file);
  say_lost(file == "-" ? "<stdout>" : file, format, data, common.console());
  file == "-" ? write_mesh(std::cout, format, data, options) : write_mesh(file, data, options);
}

void check_output(const std::string& file, const CommonOptions& common) {
  if (file == "-" && common.json == "-")
    throw UsageError("the mesh and the report cannot both go to stdout; write one of them to a file");
  file == "-" ? stream_format(common) : format_of(file);
}

Drop to_drop(const MeshData& data, const std::string& file) {
  return naming(file, [&] {
    MeshData bare = data;
    bare.attributes.erase(std::remove_if(bare.attributes.begin(), bare.attributes.end(), is_drops_own),
                          bare.attributes.end());
    Drop drop(to_mesh(bare));
    read_own(data, drop);
    return drop;
  });
}

MeshData to_output(const Mesh& mesh, const MeshData& like, bool keep_targets) {
  MeshData data = to_mesh_data(mesh, like.attributes);
  std::vector<VertexAttribute> all;
  for (const auto& attribute : like.attributes) {
    const VertexAttribute* carried = data.attribute(attribute.name);
    all.push_back(carried ? *carried : VertexAttribute{attribute.name, attribute.type, {}});
    all.back().values.resize(data.points.size());
    write_own(mesh, all.back());
  }
  data.attributes = std::move(all);
  for (const std::string& comment : like.comments)
    if (keep_targets || !is_target(comment)) data.comments.push_back(comment);
  return data;
}

}  // namespace meniscus::tools
