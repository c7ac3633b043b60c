// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/drop.h"

#include <array>
#include <cstdint>
#include <tuple>
#include <vector>

namespace meniscus {

/// Every vertex map of numbers, vectors or contact states of a mesh except its points, so that a new
/// or moved vertex can take over its attributes. Void once the mesh is assigned to or destroyed.
class AttributeMaps {
 public:
  void bind(Mesh& mesh);
  void clear();
  bool is_bound() const { return bound_; }

  /// Attributes at `into` = (1 - t) a + t b; integers and contact states from the nearer end, a in the
  /// middle. Constants stay the same bits. `into` may be a or b.
  void interpolate(VertexIndex into, VertexIndex a, VertexIndex b, double t);
  /// Attributes at `into` += s (a - into) + t (b - into); integers and contact states stay.
  void shift(VertexIndex into, VertexIndex a, double s, VertexIndex b, double t);
  void copy(VertexIndex into, VertexIndex from);

 private:
  template <class T>
  using Maps = std::vector<Mesh::Property_map<VertexIndex, T>>;

  std::tuple<Maps<double>, Maps<float>, Maps<Vector>> continuous_;
  std::tuple<Maps<std::int8_t>, Maps<std::uint8_t>, Maps<std::int16_t>, Maps<std::uint16_t>, Maps<std::int32_t>,
             Maps<std::uint32_t>, Maps<std::int64_t>, Maps<std::uint64_t>, Maps<Contact>>
      discrete_;
  bool bound_ = false;
};

/// Where an attribute comes from: a point of a triangle of another mesh, weights summing to 1.
struct AttributeSource {
  std::array<VertexIndex, 3> corners;
  std::array<double, 3> weights;
};
inline AttributeSource same_as(VertexIndex v) { return {{v, v, v}, {1, 0, 0}}; }

/// Gives `to` every map that AttributeMaps knows of `from`: vertex first_row + i takes sources[i];
/// integers and contact states from the corner of greatest weight.
void gather_attributes(const Mesh& from, Mesh& to, const std::vector<AttributeSource>& sources,
                       std::size_t first_row = 0);

/// The same for vertices that have attributes already: numbers and vectors become the mean of both,
/// integers and contact states stay.
void blend_attributes(const Mesh& from, Mesh& to, const std::vector<AttributeSource>& sources, std::size_t first_row);

}  // namespace meniscus
