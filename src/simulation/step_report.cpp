// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/simulation/step.h"

#include "meniscus/topology/merge.h"

#include <algorithm>

namespace meniscus {

const char* stage_name(Stage stage) {
  constexpr const char* names[num_stages] = {"external_forces", "geometry",      "damping",
                                             "curvature_flow",  "contact_angle", "volume_correction",
                                             "remesh",          "split",         "merge"};
  return names[static_cast<std::size_t>(stage)];
}

StepReport& StepReport::operator+=(const StepReport& other) {
  for (std::size_t k = 0; k < num_stages; ++k) stage_seconds[k] += other.stage_seconds[k];
  triangles += other.triangles;
  edge_operations += other.edge_operations;
  cuts += other.cuts;
  deleted += other.deleted;
  limited_volume += other.limited_volume;
  merges += other.merges;
  folds += other.folds;
  refused += other.refused;
  taken_back += other.taken_back;
  retries += other.retries;
  overlap += other.overlap;
  rejected += other.rejected;
  recoveries += other.recoveries;
  rounded += other.rounded;
  asleep += other.asleep;
  asleep_triangles += other.asleep_triangles;
  volume_added += other.volume_added;
  for (std::size_t k = 0; k < num_stages; ++k) skipped[k] += other.skipped[k];
  substeps = std::max(substeps, other.substeps);
  solver_iterations = std::max(solver_iterations, other.solver_iterations);
  worst_volume_error = std::max(worst_volume_error, other.worst_volume_error);
  return *this;
}

StepReport& StepReport::operator+=(const MergeReport& merge) {
  merges += merge.merges;
  folds += merge.folds;
  refused += merge.refused;
  taken_back += merge.taken_back;
  retries += merge.retries;
  cuts += merge.cuts;
  deleted += merge.deleted;
  overlap += merge.overlap;
  return *this;
}

}  // namespace meniscus
