// SPDX-License-Identifier: GPL-3.0-or-later
#include "glb.h"

#include "frame_attributes.h"
#include "meniscus/core/error.h"
#include "meniscus/core/version.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace meniscus {
namespace {

constexpr std::size_t max_bytes = (std::size_t{1} << 32) - (std::size_t{1} << 24);  // lengths in GLB have 32 bits

tinygltf::Value property(const char* name, double value) {
  return tinygltf::Value(tinygltf::Value::Object{{name, tinygltf::Value(value)}});
}

/// A glTF model that grows; its one buffer becomes the binary chunk.
class GlbBuilder {
 public:
  GlbBuilder() {
    model_.asset.version = "2.0";
    model_.asset.generator = "meniscus " + version();
    model_.buffers.emplace_back();
    model_.scenes.emplace_back();
    model_.scenes[0].nodes = {0};
    model_.defaultScene = 0;
    tinygltf::Node root;
    root.name = "drops";
    root.scale = {0.01, 0.01, 0.01};                          // cm to m
    root.rotation = {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)};  // z up to y up
    model_.nodes.push_back(root);
    add_water();
  }

  /// Adds a mesh on a node of its own below the root; nothing (-1) for a mesh without triangles.
  int add_frame(const MeshData& data, const std::string& name, bool with_attributes) {
    if (data.triangles.empty()) return -1;
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.material = 0;
    primitive.indices = add_triangles(data);
    primitive.attributes["POSITION"] = add_positions(data);
    primitive.attributes["NORMAL"] = add_vectors(vertex_normals(data));
    if (with_attributes) add_attributes(data, primitive);
    tinygltf::Mesh mesh;
    mesh.name = name;
    mesh.primitives.push_back(primitive);
    model_.meshes.push_back(mesh);
    tinygltf::Node node;
    node.name = name;
    node.mesh = static_cast<int>(model_.meshes.size()) - 1;
    model_.nodes.push_back(node);
    const int index = static_cast<int>(model_.nodes.size()) - 1;
    model_.nodes[0].children.push_back(index);
    return index;
  }

  /// Shows a node from `begin` to `end` (s) only; the last one (end < begin) stays.
  void show_between(int node, double begin, double end, bool is_first) {
    if (model_.animations.empty()) model_.animations.emplace_back();
    tinygltf::Animation& animation = model_.animations[0];
    animation.name = "frames";
    std::vector<float> times;
    std::vector<std::array<float, 3>> scales;
    const auto key = [&](double time, float scale) {
      times.push_back(static_cast<float>(time));
      scales.push_back({scale, scale, scale});
    };
    if (begin > 0) key(0, 0);
    key(begin, 1);
    if (end > begin) key(end, 0);
    tinygltf::AnimationSampler sampler;
    sampler.interpolation = "STEP";
    sampler.input = add_scalars(times, true);
    sampler.output = add_vectors(scales, 0);
    animation.samplers.push_back(sampler);
    tinygltf::AnimationChannel channel;
    channel.sampler = static_cast<int>(animation.samplers.size()) - 1;
    channel.target_node = node;
    channel.target_path = "scale";
    animation.channels.push_back(channel);
    if (!is_first) model_.nodes[static_cast<std::size_t>(node)].scale = {0, 0, 0};  // where nothing is animated
  }

  std::size_t size() const { return model_.buffers[0].data.size(); }

  std::string bytes() {
    std::ostringstream out;
    if (size() == 0) {  // without drops: what is empty or unused may not be
      model_.buffers.clear();
      model_.materials.clear();
      model_.extensionsUsed.clear();
    }
    tinygltf::TinyGLTF().WriteGltfSceneToStream(&model_, out, false, true);
    return out.str();
  }

 private:
  void add_water() {
    tinygltf::Material water;
    water.name = "water";
    water.pbrMetallicRoughness.metallicFactor = 0;
    water.pbrMetallicRoughness.roughnessFactor = 0.02;
    water.extensions["KHR_materials_transmission"] = property("transmissionFactor", 1);
    water.extensions["KHR_materials_ior"] = property("ior", 1.333);
    model_.materials.push_back(water);
    model_.extensionsUsed = {"KHR_materials_ior", "KHR_materials_transmission"};
  }

  int add_accessor(const void* bytes, std::size_t size, std::size_t count, int component, int type, int target) {
    std::vector<unsigned char>& buffer = model_.buffers[0].data;
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = buffer.size();
    view.byteLength = size;
    view.target = target;
    const auto* begin = static_cast<const unsigned char*>(bytes);
    buffer.insert(buffer.end(), begin, begin + size);
    model_.bufferViews.push_back(view);
    tinygltf::Accessor accessor;
    accessor.bufferView = static_cast<int>(model_.bufferViews.size()) - 1;
    accessor.componentType = component;
    accessor.type = type;
    accessor.count = count;
    model_.accessors.push_back(accessor);
    return static_cast<int>(model_.accessors.size()) - 1;
  }

  int add_vectors(const std::vector<std::array<float, 3>>& vectors, int target = TINYGLTF_TARGET_ARRAY_BUFFER) {
    return add_accessor(vectors.data(), 12 * vectors.size(), vectors.size(), TINYGLTF_COMPONENT_TYPE_FLOAT,
                        TINYGLTF_TYPE_VEC3, target);
  }

  int add_scalars(const std::vector<float>& scalars, bool are_times = false) {
    const int index = add_accessor(scalars.data(), 4 * scalars.size(), scalars.size(), TINYGLTF_COMPONENT_TYPE_FLOAT,
                                   TINYGLTF_TYPE_SCALAR, are_times ? 0 : TINYGLTF_TARGET_ARRAY_BUFFER);
    if (are_times) set_bounds(index, {scalars.front()}, {scalars.back()});
    return index;
  }

  int add_positions(const MeshData& data) {
    std::vector<std::array<float, 3>> points;
    for (const auto& [x, y, z] : data.points)
      points.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
    std::vector<double> low(points[0].begin(), points[0].end()), high = low;
    for (const auto& point : points)
      for (std::size_t k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], double{point[k]});
        high[k] = std::max(high[k], double{point[k]});
      }
    const int index = add_vectors(points);
    set_bounds(index, low, high);
    return index;
  }

  void set_bounds(int accessor, std::vector<double> low, std::vector<double> high) {
    model_.accessors[static_cast<std::size_t>(accessor)].minValues = std::move(low);
    model_.accessors[static_cast<std::size_t>(accessor)].maxValues = std::move(high);
  }

  int add_triangles(const MeshData& data) {
    if (triangles_accessor_ >= 0 && triangles_ == data.triangles) return triangles_accessor_;
    triangles_ = data.triangles;
    triangles_accessor_ =
        add_accessor(data.triangles.data(), 12 * data.triangles.size(), 3 * data.triangles.size(),
                     TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    return triangles_accessor_;
  }

  void add_attributes(const MeshData& data, tinygltf::Primitive& primitive) {
    const std::vector<double> velocity = velocities(data);
    std::vector<std::array<float, 3>> vectors(velocity.size() / 3);
    for (std::size_t k = 0; k < velocity.size(); ++k) vectors[k / 3][k % 3] = static_cast<float>(velocity[k]);
    if (!vectors.empty()) primitive.attributes["_VELOCITY"] = add_vectors(vectors);
    for (const auto& [ours, theirs] : {std::pair("drop", "_DROP"), std::pair("contact", "_CONTACT")})
      if (const VertexAttribute* attribute = data.attribute(ours))
        primitive.attributes[theirs] =
            add_scalars(std::vector<float>(attribute->values.begin(), attribute->values.end()));
  }

  tinygltf::Model model_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  int triangles_accessor_ = -1;
};

}  // namespace

std::string glb_still(const MeshData& data) {
  check_finite(data);
  GlbBuilder builder;
  builder.add_frame(data, "frame", true);
  return builder.bytes();
}

std::string glb_flipbook(const std::vector<double>& times, const std::function<MeshData(std::size_t)>& read,
                         const std::string& name) {
  GlbBuilder builder;
  const double start = times.empty() ? 0 : times.front();
  for (std::size_t k = 0; k < times.size(); ++k) {
    const MeshData data = read(k);
    check_finite(data);
    const int node = builder.add_frame(data, fmt::format("frame_{:04}", k), false);
    if (builder.size() > max_bytes)
      throw FileError(fmt::format("{}: would be 4 GiB or more, which GLB cannot be; take fewer frames or usda", name));
    const double end = k + 1 < times.size() ? times[k + 1] - start : -1;
    if (node >= 0 && times.size() > 1) builder.show_between(node, times[k] - start, end, k == 0);
  }
  return builder.bytes();
}

}  // namespace meniscus
