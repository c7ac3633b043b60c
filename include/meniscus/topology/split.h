// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/drop.h"

#include <cstddef>
#include <vector>

namespace meniscus {

/// What split_components did. Volumes in cm^3; target volume of the drop = sum of the pieces'
/// target volumes, unless no piece was left.
struct SplitReport {
  std::size_t pieces = 0;
  std::size_t deleted = 0;        ///< components too small or too knotted to go on, see below
  std::size_t deleted_empty = 0;  ///< components that enclosed no positive volume
  double volume_deleted = 0;      ///< what the tetrahedra enclosed
  double volume_shared = 0;       ///< old target volume less what the pieces enclose; shared among them
};

/// The volume of the ball whose diameter is the shortest edge (cm^3): a piece with less has no room for edges.
inline double least_volume(double edge_min) { return 3.14159265358979323846 / 6 * edge_min * edge_min * edge_min; }

/// Each connected component becomes a drop of its own, in the order of smallest old vertex index,
/// with velocities, contact state and every other vertex map of numbers or vectors. A component of
/// one tetrahedron, or of no positive volume, or of at most 16 faces that meet each other, is deleted; so is one of
/// less than `least_volume` (cm^3), too small for its edges to have a shape, if there is another that can take its
/// volume.
///
/// The lost volume (target less what the pieces enclose) is shared evenly (Section 5.2), but by at
/// most 5 % of a piece's own volume; what is above goes to the others in proportion to volume (to
/// all, if none may take more). Pieces keep the drop's id. One sound component comes back as it was.
std::vector<Drop> split_components(Drop drop, SplitReport& report, double least_volume = 0);

/// The connected components as meshes, in the order of smallest vertex index, with their vertex maps.
std::vector<Mesh> connected_components(const Mesh& mesh);

/// What cut_necks did.
struct CutReport {
  std::size_t cuts = 0;
  std::size_t refused = 0;  ///< places thin enough whose section could not be cut and capped soundly
};

/// Cuts the drop where liquid necks are thinner than `diameter` (cm), whatever the edges' lengths, and
/// caps both sides; split_components then takes the pieces apart. A neck is where the section's
/// perimeter is below pi times the diameter and grows by a quarter to both sides before the surface
/// closes: the end of a thread is none, nor is a small drop. Each is cut at its narrowest place, by
/// a plane across it. Throws UsageError unless the diameter is finite and positive.
CutReport cut_necks(Drop& drop, double diameter);

}  // namespace meniscus
