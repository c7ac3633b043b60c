// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/mesh_data.h"

#include <array>
#include <string>
#include <vector>

namespace meniscus {

/// A frame's values as USD text, one of each attribute; empty for those that the mesh lacks.
using UsdaValues = std::array<std::string, 7>;

/// One mesh as USD text, without times: points (cm, z up; float32), faces, velocities (cm/s), primvars drop and
/// contact. Throws GeometryError if a point or velocity is not finite.
std::string usda_still(const MeshData& data);

/// Frames as one mesh /drops/liquid whose points, faces, velocities and primvars are sampled in time. Time code k
/// is frame k where frames are evenly spaced: there are timeCodesPerSecond = 1/spacing of them in a second.
class UsdaSequence {
 public:
  /// Adds the next frame, at `time` (s), later than the last. Throws as usda_still does.
  void add(const MeshData& data, double time);
  /// The file. No frames give a mesh without points.
  std::string text() const;

 private:
  double codes_per_second() const;

  std::vector<double> times_;
  std::vector<UsdaValues> frames_;
};

}  // namespace meniscus
