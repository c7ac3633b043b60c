// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/types.h"

#include <vector>

namespace meniscus {

/// What cut_along_cycle made.
struct CycleCut {
  std::vector<VertexIndex> copies;  ///< the right side's copy of each vertex of the cycle
  VertexIndex left_center = Mesh::null_vertex(), right_center = Mesh::null_vertex();  ///< caps of more than one face
};

/// Is the closed walk of halfedges (target of one is source of the next) a cycle that a cut may
/// follow: no vertex twice, and at least two faces on either side around each vertex, so that no
/// cap doubles a face?
bool is_cuttable(const Mesh& mesh, const std::vector<HalfedgeIndex>& cycle);

/// Cuts a closed mesh along a cycle and caps both sides, by one face if the cycle has three edges,
/// else by a fan about a new vertex. The vertices of the cycle stay with the left side (that of the
/// cycle's own faces); the right side gets copies, at the same points. Attributes of new vertices
/// are not set. Precondition: is_cuttable.
CycleCut cut_along_cycle(Mesh& mesh, const std::vector<HalfedgeIndex>& cycle);

}  // namespace meniscus
