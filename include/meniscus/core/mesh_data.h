// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/types.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace meniscus {

/// The scalar types of a PLY property; other formats hold positions only.
enum class ScalarType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

inline bool is_integer(ScalarType type) { return type != ScalarType::float32 && type != ScalarType::float64; }

/// A named scalar a vertex. Every PLY scalar type fits a double exactly.
struct VertexAttribute {
  std::string name;
  ScalarType type = ScalarType::float64;
  std::vector<double> values;  ///< one a vertex
};

/// A mesh as a file holds it: any triangle soup, sound or not, with its attributes and comments.
struct MeshData {
  std::vector<std::array<double, 3>> points;            ///< cm
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into points, counterclockwise seen from outside
  std::vector<VertexAttribute> attributes;              ///< without x, y, z
  std::vector<std::string> comments;                    ///< without the format's comment mark
  std::vector<std::uint32_t> source_face;               ///< the file's face of each triangle; empty if none was cut up

  /// The file's face that triangle `t` came from.
  std::size_t face_in_file(std::size_t t) const { return source_face.empty() ? t : source_face[t]; }
  /// The attribute called `name`, or nullptr.
  const VertexAttribute* attribute(const std::string& name) const;
};

/// The property map "v:<attribute name>" of doubles that carries an attribute on a Mesh.
std::string attribute_map_name(const std::string& attribute_name);

/// The soup as a Surface_mesh: vertex i is point i (isolated ones too), face t is triangle t, and
/// each attribute becomes a property map of doubles named by attribute_map_name.
/// Throws GeometryError, naming faces (as the file counts them), if an edge has more than two faces
/// or two faces that disagree on its direction, if a face names a vertex twice or one that is not
/// there, or if a vertex is pinched (its faces form more than one fan). Open meshes pass.
Mesh to_mesh(const MeshData& data);

/// A mesh as a soup, without removed elements, in index order. `attributes` says which of the
/// mesh's scalar maps to take along, by name and type; their values are ignored.
MeshData to_mesh_data(const Mesh& mesh, const std::vector<VertexAttribute>& attributes = {});

}  // namespace meniscus
