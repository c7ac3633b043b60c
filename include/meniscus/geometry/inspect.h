// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/mesh_data.h"
#include "meniscus/geometry/measure.h"

#include <optional>

namespace meniscus {

enum class DefectKind {
  empty_mesh,
  non_finite_coordinate,
  index_out_of_range,
  repeated_vertex_in_face,
  degenerate_face,           ///< its three vertices lie on a line, exactly
  duplicate_face,            ///< the same three vertices as an earlier face, turned either way
  boundary_edge,             ///< one defect a hole; `vertices` along no particular order
  non_manifold_edge,         ///< more than two faces; `vertices` in pairs
  inconsistent_orientation,  ///< two faces run along their edge in the same direction; `faces` in pairs
  pinched_vertex,            ///< its faces form more than one fan
  isolated_vertex,           ///< in no face
  coincident_vertices,       ///< at equal positions but not joined; never the only defect
  inside_out_component,      ///< wrong way round for its depth, or without volume; its first face
  self_intersection          ///< `faces` in pairs, touching ones included
};

/// "boundary_edge" and so on, as reports spell it.
const char* name(DefectKind kind);

/// One kind of defect, or one hole. Faces as the file counts them, vertices as the soup does; at
/// most the first 20 of them (10 pairs), the message says how many there are.
struct Defect {
  DefectKind kind;
  std::string message;
  std::vector<std::size_t> faces, vertices;
};

/// What `meniscus check` says of a mesh.
struct Inspection {
  std::size_t vertices = 0, faces = 0;
  std::size_t components = 0;         ///< of faces joined by edges
  std::optional<std::int64_t> genus;  ///< the components' sum; only if closed, manifold and orientable as it is
  bool closed = false;                ///< has faces, all of sound indices, and each edge has at least two
  bool manifold = false;              ///< sound indices, each edge has at most two faces, each vertex one fan
  bool outward = false;  ///< closed, consistent, and every component not inside another has positive volume
  bool self_intersecting = false;
  bool bounds_volume = false;   ///< closed, manifold, outward, not self-intersecting; cavities face inward,
                                ///< drops in cavities outward and so on
  bool sound = false;           ///< all of the above as they should be, and no defect
  double volume = 0, area = 0;  ///< cm^3, cm^2; infinite if beyond doubles
  EdgeLengths edge_length;      ///< cm
  Angles angle;                 ///< radians; share_below is not used
  std::vector<Defect> defects;  ///< by kind, in the order above
};

/// Inspects any soup, whatever it holds; throws nothing of its own. Connectivity is judged by
/// indices, so vertices that only lie at the same place are not joined. O(n log^2 n), but for pairs
/// of faces with overlapping boxes and for components within the box of another.
Inspection inspect(const MeshData& data);

}  // namespace meniscus
