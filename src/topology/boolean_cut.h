// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "boolean_seam.h"

namespace meniscus::boolean_parts {

enum class Place : std::uint8_t { unknown, inside, outside };

/// The parts that are kept of one mesh's cut faces.
struct CutFaces {
  std::uint32_t first_crossing = 0;  ///< corners below are the mesh's vertices, others crossings
  std::vector<Triangle> triangles;   ///< facing as the face that they are part of
  std::vector<std::uint32_t> faces;  ///< the faces that were cut, ascending
  std::vector<Place> place;          ///< of the mesh's vertices, where cut faces tell it, to the other mesh
};

/// Cuts the faces of A (or of B) along the seam and keeps what lies inside (or outside) the other
/// mesh. Nothing if rounded crossings make a part that is no simple polygon.
std::optional<CutFaces> cut_faces(const MeshView& a, const MeshView& b, const Seam& seam, bool of_a, Place keep);

}  // namespace meniscus::boolean_parts
