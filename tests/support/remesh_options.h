// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/topology/remesh.h"

namespace meniscus {

inline RemeshOptions band(double edge_min, double edge_max, int passes = 5, double smoothing = 0) {
  RemeshOptions options;
  options.band = {edge_min, edge_max, 0.5};
  options.max_passes = passes;
  options.smoothing = smoothing;
  return options;
}

}  // namespace meniscus
