// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/drop.h"

namespace meniscus {

/// A vertex that is there and may move along its normal: not on a solid.
inline bool is_off_solids(const Drop& drop, std::uint32_t i) {
  return drop.connectivity().degree(i) > 0 && !is_colliding(drop.contact()[i]);
}

struct VolumeOffset {
  double error_before = 0;  ///< V - V_wanted as found, cm^3
  double error = 0;         ///< as left
  double offset = 0;        ///< d, cm
  bool limited = false;     ///< d was cut to its bounds
};

/// How fast the volume grows when vertices off solids move along the normals of `geometry`: dV/dd, cm^2.
double free_area(const Drop& drop, const SurfaceGeometry& geometry);

/// Offsets the surface off solids along the normals of `geometry` by d = (V_wanted - V)/A, by secants, until the
/// volume fits to 1e-12; d stays within [least, most] (cm). `area` is the first A: free_area. Vertices `held` (one a
/// row, or empty: none) stay. Global volume correction, Section 4.4 of the paper. Writes positions only. Does nothing
/// if the area is not positive.
VolumeOffset offset_to_volume(Drop& drop, const SurfaceGeometry& geometry, double area, double volume, double least,
                              double most, const std::vector<std::uint8_t>& held = {});

}  // namespace meniscus
