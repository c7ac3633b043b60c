// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/solid.h"

namespace meniscus {

/// The signed distance to a closed mesh: an AABB tree for the nearest triangle, or, near the surface, lists of the few
/// that can be; angle-weighted normals of its corner, side or face for the sign. Queries share all structures.
class TriangleMeshDistance {
 public:
  /// Throws GeometryError unless the mesh bounds a volume.
  explicit TriangleMeshDistance(const MeshData& data);
  ~TriangleMeshDistance();

  SolidContact query(const Eigen::Vector3d& x) const;
  /// False only if x is outside and further from the surface than the margin (cm).
  bool is_near(const Eigen::Vector3d& x, double margin) const;
  const Eigen::AlignedBox3d& bounds() const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

}  // namespace meniscus
