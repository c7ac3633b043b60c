// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "boolean_parts.h"
#include "face_grid.h"

#include <vector>

/// Where two surfaces in general position cross: no vertex of one lies on a face of the other, no
/// edge meets an edge. Then edges pierce faces, and two faces that meet do so in one segment.
namespace meniscus::boolean_parts {

/// An edge of one surface, low < high, pierces a face of the other.
struct Crossing {
  std::uint32_t low, high;  ///< the edge's vertices
  std::uint32_t face;       ///< of the other surface
  bool edge_of_a;           ///< else the edge is B's and the face A's
  bool low_is_inside;       ///< the edge's lower end lies behind the face
  double t = 0;             ///< where: low + t (high - low)
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
};

/// Two faces meet in the segment between two crossings. It runs so that, seen from outside A, the
/// part of A's face inside B is on its left; for B's face it is the other way round.
struct SeamSegment {
  std::uint32_t face_a, face_b;
  std::uint32_t from, to;  ///< crossings
};

struct Seam {
  std::vector<Crossing> crossings;    ///< A's edges' after B's; sorted by edge, and along it
  std::vector<SeamSegment> segments;  ///< sorted by face_a, face_b
};

/// Every crossing of the given faces; nothing if they are not in general position, or if a surface
/// is open there.
std::optional<Seam> find_seam(const MeshView& a, const std::vector<FaceBox>& faces_a, const MeshView& b,
                              const std::vector<FaceBox>& faces_b);

/// The same for one surface of which the given pairs of faces meet elsewhere than in what they share: every crossing is
/// there twice, as an edge of A and as an edge of B, and so is every segment. Nothing, too, if some of them share a
/// vertex.
std::optional<Seam> find_self_seam(const MeshView& mesh, const std::vector<FacePair>& meeting);

}  // namespace meniscus::boolean_parts
