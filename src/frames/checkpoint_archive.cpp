// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/frames/checkpoint_archive.h"

#include "meniscus/core/error.h"
#include "meniscus/core/mesh_arrays.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

namespace meniscus {
namespace {

using checkpoint::State;
using Indices = std::vector<std::uint32_t>;

/// Every type that a vertex map may have, by the name that stands for it in a checkpoint.
template <class Visit>
bool for_map_types(Visit visit) {
  return visit(double{}, "float64") || visit(float{}, "float32") || visit(Vector(), "vector") ||
         visit(Point(), "point") || visit(Contact{}, "contact") || visit(std::int8_t{}, "int8") ||
         visit(std::uint8_t{}, "uint8") || visit(std::int16_t{}, "int16") || visit(std::uint16_t{}, "uint16") ||
         visit(std::int32_t{}, "int32") || visit(std::uint32_t{}, "uint32") || visit(std::int64_t{}, "int64") ||
         visit(std::uint64_t{}, "uint64");
}

/// CGAL's own maps, which MeshArrays holds.
bool is_connectivity(const std::string& name) {
  return name.size() > 2 && (name.substr(2) == "connectivity" || name.substr(2) == "removed");
}

State map_state(const Mesh& mesh, const std::string& name) {
  State state;
  const bool known = for_map_types([&](auto example, const char* type) {
    using T = decltype(example);
    const auto [map, found] = mesh.property_map<VertexIndex, T>(name);
    if (!found) return false;
    const std::size_t size = mesh.num_vertices() * sizeof(T);
    state = {{"name", name},
             {"type", type},
             {"values", checkpoint::bytes_of(size == 0 ? nullptr : &map[VertexIndex(0)], size)}};
    return true;
  });
  if (!known)
    throw std::logic_error(fmt::format("vertex map {}: a checkpoint does not know its type; add it in {}", name,
                                       "src/frames/checkpoint_archive.cpp"));
  return state;
}

/// Other elements carry nothing of their own: what lies there would be lost.
template <class Index>
void check_nothing_else(const Mesh& mesh) {
  for (const std::string& name : mesh.properties<Index>())
    if (!is_connectivity(name)) throw std::logic_error(name + ": a checkpoint holds maps of vertices only");
}

void restore_map(const State& state, const std::string& where, Mesh& mesh) {
  std::string name, type;
  CheckpointReader read(state, where);
  read("name", name);
  read("type", type);
  const bool known = for_map_types([&](auto example, const char* known_type) {
    using T = decltype(example);
    if (type != known_type) return false;
    const auto& bytes = checkpoint::bytes_in(checkpoint::member(state, where, "values"), where, sizeof(T));
    if (bytes.size() != mesh.num_vertices() * sizeof(T)) checkpoint::fail(where, "does not fit the mesh");
    const auto [map, is_new] = mesh.add_property_map<VertexIndex, T>(name);
    if (!is_new && !mesh.property_map<VertexIndex, T>(name).second) checkpoint::fail(where, "is of another type");
    if (!bytes.empty()) std::memcpy(static_cast<void*>(&map[VertexIndex(0)]), bytes.data(), bytes.size());
    return true;
  });
  if (!known || is_connectivity(name)) checkpoint::fail(where, "is of a type that is not known");
}

template <class T>
State list_state(const std::vector<T>& list) {
  return checkpoint::bytes_of(list.data(), list.size() * sizeof(T));
}

/// Where the rings start, one a row.
Indices ring_starts(const Connectivity& connectivity) {
  Indices starts(connectivity.num_rows(), 0);
  for (std::uint32_t v = 0; v < starts.size(); ++v)
    if (connectivity.degree(v) > 0) starts[v] = connectivity.ring(v).neighbour[0];
  return starts;
}

/// The contact states are an enum: any other byte would be undefined.
void check_contact(const Drop& drop, const std::string& where) {
  for (std::size_t v = 0; v < drop.num_rows(); ++v)
    if (static_cast<int>(drop.contact()[v]) > 2) checkpoint::fail(where, "a contact state is none");
}

}  // namespace

namespace checkpoint {

void fail(const std::string& where, const std::string& what) {
  throw FileError(fmt::format("{}: {}; the checkpoint is not one of this version", where, what));
}

const State& member(const State& state, const std::string& where, const char* name) {
  const auto found = state.is_object() ? state.find(name) : state.end();
  if (found == state.end()) fail(where + "/" + name, "is missing");
  return *found;
}

State bytes_of(const void* data, std::size_t size) {
  const auto* const bytes = static_cast<const std::uint8_t*>(data);
  return State::binary(std::vector<std::uint8_t>(bytes, bytes + size));
}

const std::vector<std::uint8_t>& bytes_in(const State& state, const std::string& where, std::size_t element) {
  if (!state.is_binary() || state.get_binary().size() % element != 0) fail(where, "is no list of numbers");
  return state.get_binary();
}

void copy_bytes(const std::vector<std::uint8_t>& bytes, void* to) {
  if (!bytes.empty()) std::memcpy(to, bytes.data(), bytes.size());
}

std::int64_t integer_in(const State& state, const std::string& where, std::int64_t least, std::int64_t most) {
  const bool too_large =
      state.is_number_unsigned() &&
      state.get<std::uint64_t>() > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  if (!state.is_number_integer() || too_large || state.get<std::int64_t>() < least || state.get<std::int64_t>() > most)
    fail(where, "is no whole number in range");
  return state.get<std::int64_t>();
}

State drop_state(const Drop& drop) {
  const Mesh& mesh = drop.mesh();
  check_nothing_else<HalfedgeIndex>(mesh);
  check_nothing_else<EdgeIndex>(mesh);
  check_nothing_else<FaceIndex>(mesh);
  const MeshArrays arrays = mesh_arrays(mesh);
  CheckpointWriter writer;
  Drop::visit(drop, writer);
  State state = writer.state();
  state["vertex_halfedge"] = list_state(arrays.vertex_halfedge);
  state["halfedges"] = list_state(arrays.halfedges);
  state["face_halfedge"] = list_state(arrays.face_halfedge);
  state["removed_vertices"] = list_state(arrays.removed_vertices);
  state["removed_edges"] = list_state(arrays.removed_edges);
  state["removed_faces"] = list_state(arrays.removed_faces);
  state["ring_starts"] = list_state(ring_starts(drop.connectivity()));
  State maps = State::array();
  for (const std::string& name : mesh.properties<VertexIndex>())
    if (!is_connectivity(name)) maps.push_back(map_state(mesh, name));
  state["maps"] = std::move(maps);
  return state;
}

Drop restored_drop(const State& state, const std::string& where) {
  CheckpointReader read(state, where);
  MeshArrays arrays;
  Indices starts, halfedges;
  read("vertex_halfedge", arrays.vertex_halfedge);
  read("halfedges", halfedges);
  read("face_halfedge", arrays.face_halfedge);
  read("removed_vertices", arrays.removed_vertices);
  read("removed_edges", arrays.removed_edges);
  read("removed_faces", arrays.removed_faces);
  read("ring_starts", starts);
  if (halfedges.size() % 3 != 0) fail(where, "its halfedges are not whole");
  for (std::size_t h = 0; h < halfedges.size(); h += 3)
    arrays.halfedges.push_back({halfedges[h], halfedges[h + 1], halfedges[h + 2]});
  try {
    Mesh mesh = to_mesh(arrays);
    const State& maps = member(state, where, "maps");
    if (!maps.is_array()) fail(where, "its maps are no list");
    for (std::size_t k = 0; k < maps.size(); ++k) restore_map(maps[k], fmt::format("{}/maps/{}", where, k), mesh);
    Drop drop = Drop::restored(std::move(mesh), starts);
    check_contact(drop, where);
    Drop::visit(drop, read);
    if (!(drop.target_volume() > 0 && std::isfinite(drop.target_volume()))) fail(where, "its target volume is none");
    return drop;
  } catch (const GeometryError& error) {
    throw FileError(fmt::format("{}: {}; the checkpoint is damaged", where, error.what()));
  }
}

}  // namespace checkpoint
}  // namespace meniscus
