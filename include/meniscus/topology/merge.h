// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/topology/boolean.h"
#include "meniscus/topology/remesh.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace meniscus {

struct MergeOptions {
  RemeshOptions remesh;     ///< of the seam; all other edges are in the band
  bool keep_air = false;    ///< air that the liquid shuts in stays as a cavity, from least_volume on; else it is filled
  bool self_merge = false;  ///< drops that fold onto themselves fuse there; else only next to a fresh seam
};

/// What merging did, summed over pairs. Volumes in cm^3.
struct MergeReport {
  std::size_t merges = 0;      ///< pairs that became one
  std::size_t folds = 0;       ///< drops that fused with themselves
  std::size_t refused = 0;     ///< pairs that met and could not be united: they go on as they were
  std::size_t taken_back = 0;  ///< vertices that went back so that the surface does not meet itself
  std::size_t retries = 0;     ///< ladder steps of boolean() that failed
  std::size_t cuts = 0;        ///< necks that remeshing the seam cut
  std::size_t deleted = 0;     ///< pieces too small to go on as drops
  double overlap = 0;          ///< volume that both drops claimed: lost in the union, given back by an offset

  MergeReport& operator+=(const MergeReport& other);
};

/// Unites two drops that meet (Section 5.1 of the paper): the Boolean union of their volumes, with the
/// velocities, contact states and every other vertex map carried over and the seam remeshed. The target
/// volumes add up, and so do the ledgers (see ledger.h): the overlap is given back by an offset of the
/// surface, for a drop off solids linear momentum is kept to rounding. Where both drops wet the same plane, the seam
/// ends in a common contact line.
///
/// The result has a's id. It is one drop, more if remeshing the seam cut a neck, none if nothing was
/// left to go on. Nothing (std::nullopt) if the drops do not meet, or if the union was refused, which
/// `report` counts; both are then best left alone and tried again when they have moved.
std::optional<std::vector<Drop>> merge_drops(const Drop& a, const Drop& b, const MergeOptions& options,
                                             Remesher& remesher, MergeReport& report);

/// Moves the free vertices along their normals until the drop encloses `volume` (cm^3) again, after operations on edges
/// of at most edge_max (cm); where faces near a watched vertex or a solid would then meet, vertices stay.
void restore_volume(Drop& drop, double volume, double edge_max);

/// Watches (Drop::seam_watch) the vertices of marked faces: one entry a face, or none at all; find_face_changes marks
/// violent ones.
void watch_faces(Drop& drop, const std::vector<std::uint8_t>& marked);

/// Watches the vertices of faces under which a solid bends: between such a face and the solid there is room for the
/// surface beside the contact line. On any solid that is not flat, also those of wetted faces and others that meet.
void watch_bends(Drop& drop);

/// Watches where a drop that is no ball has air on both sides and is thin: its two sides may pass through each other
/// with nothing violent in it. All free vertices if it is thinner than edge_max in the mean, else those of faces with
/// less than edge_min of liquid between them. `area`: that of the surface (cm^2).
void watch_thin_sheets(Drop& drop, double area, const EdgeBand& band);

/// Whether mend_folds has anything to look at: watched vertices, or a drop at all with options.self_merge.
bool may_fold(const Drop& drop, const MergeOptions& options);

/// Where a drop's vertices were when it was last sound, and what the solid that holds it has done since.
struct LastSound {
  ConstColumns positions;                                    ///< 3 x rows, cm
  Eigen::Vector3d solid_moved = Eigen::Vector3d::Zero();     ///< cm
  Eigen::Vector3d solid_velocity = Eigen::Vector3d::Zero();  ///< cm/s
};

/// Unites a drop with itself where it has folded over: everywhere with options.self_merge, else near watched
/// vertices: those of violent faces, and those at the seam of a recent merge. There the two sheets beside the seam
/// still move towards each other, and the liquid goes on to fuse in the steps after the first touch. A seam is watched
/// for 30 calls.
///
/// Like merge_drops: volume, momentum and attributes are kept, and the result may be several drops. Nothing
/// if there is no fold. Nothing, too, if the fold cannot be united, as one between neighbouring faces:
/// vertices that make the surface meet itself go back to where they were when the drop was last sound (`before`),
/// carried along by its rigid motion and with its velocity; more around them if that is not enough. Then they are
/// smoothed as far as nothing meets, so that the next step does not end the same way. A drop on a solid is carried
/// along by that, and vertices that go back to more than edge_min above it are free again; of one off solids the centre
/// of mass stays, and momenta but for what was taken back: that was stopped, and its momentum is given to nobody.
std::optional<std::vector<Drop>> mend_folds(Drop& drop, const LastSound& before, const MergeOptions& options,
                                            Remesher& remesher, MergeReport& report);

}  // namespace meniscus
