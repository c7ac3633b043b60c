// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/topology/boolean.h"

#include <optional>

/// Booleans of meshes as files hold them, with their attributes.
namespace meniscus {

struct MeshMergeReport {
  std::size_t joins = 0;                                ///< Booleans of two meshes that were done
  std::size_t crossings = 0;                            ///< of those, between surfaces that met
  int retries = 0;                                      ///< ladder steps that failed, all in all
  double shift = 0;                                     ///< the farthest that a mesh was moved, cm
  BooleanOutcome outcome = BooleanOutcome::refused;     ///< of the last join
  BooleanStep step = BooleanStep::apart;                ///< the last in the ladder that a join needed
  double volume_sum = 0;                                ///< of the inputs, cm^3
  BooleanRefusal refusal = BooleanRefusal::none;        ///< why there is no result
  std::string message;                                  ///< which input, what is wrong, which faces
  std::size_t first = 0, second = 0;                    ///< of a refusal: the first inputs of the two groups
  std::optional<std::pair<MeshData, MeshData>> failed;  ///< of a refusal: the pair
};

/// The union or intersection of all meshes, joined in pairs, pairs of pairs and so on in the order
/// given; or the first less the union of the others. Nothing if a join is refused; the report says
/// why. One mesh comes back as it is.
///
/// The result has every attribute that a mesh has (0 where it had none). On the seam, values are the
/// mean of both meshes', linear in their triangles, and integers come from the nearest corner on the
/// first of them. "drop" becomes one number a component, the smallest. Comments are the first mesh's.
/// Inputs are checked once, the result at the end. Throws UsageError for no meshes, GeometryError as
/// require_sound does.
std::optional<MeshData> merge_meshes(const std::vector<MeshData>& meshes, BooleanOperation operation,
                                     const BooleanOptions& options, MeshMergeReport& report);

/// Two closed parts of a mesh, inside and outside a cutter. Attributes inside the cut come from the
/// nearest vertex on its rim. Nothing if refused. Throws as require_sound does.
std::optional<std::pair<MeshData, MeshData>> divide(const MeshData& mesh, const MeshData& cutter,
                                                    const BooleanOptions& options, MeshMergeReport& report);

/// A box that holds all of a mesh with normal.x <= offset, and one of its faces in that plane: a cutter.
/// Throws UsageError unless the normal is finite and not zero; the offset goes with its length.
MeshData half_space(const MeshData& mesh, const Eigen::Vector3d& normal, double offset);

/// Throws GeometryError with the first defect unless the mesh is sound.
void require_sound(const MeshData& mesh);

/// The soup with equal points welded, faces of fewer than three points and repeated faces removed,
/// faces oriented, non-manifold edges and vertices parted, degenerate faces removed, holes filled,
/// and components that overlap united. Points stay where they are, with their attributes. Throws
/// GeometryError with what is left that is not sound.
MeshData repair_soup(const MeshData& soup);

}  // namespace meniscus
