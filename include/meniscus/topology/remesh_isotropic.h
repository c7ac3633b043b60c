// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/types.h"

#include <optional>

namespace meniscus {

/// CGAL's isotropic_remeshing to edges near `target_edge` (cm), beside the band method. It knows
/// nothing of attributes, so every vertex map of numbers or vectors is carried over by projection:
/// linear in the face of the old mesh that is nearest; integers and contact states from the corner
/// of greatest weight. Edges whose faces' normals differ by more than `feature_angle` (radians) are kept.
/// Throws UsageError for a target or iterations that are not positive, or a target that needs more
/// than 50 million faces; GeometryError if the mesh has no faces or is not triangular.
void remesh_isotropic(Mesh& mesh, double target_edge, int iterations,
                      std::optional<double> feature_angle = std::nullopt);

/// Faces of an equilateral mesh of that edge and area; for checks against the 50 million limit.
double estimated_faces(double area, double edge);

}  // namespace meniscus
