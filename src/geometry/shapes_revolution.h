// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/mesh_data.h"
#include "meniscus/geometry/shapes.h"

namespace meniscus {

/// Throws UsageError unless 0 < value < infinity.
void check_size(const char* name, double value);

/// Throws UsageError if a shape would have more than 50 million faces.
void check_face_count(double faces);

/// make_surface_of_revolution as a soup.
MeshData revolve(const std::vector<ProfilePiece>& meridian, double edge_length);

}  // namespace meniscus
