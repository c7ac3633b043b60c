// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/simulation/merge_touching.h"

#include "step_parts.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace meniscus {
namespace {

using Pairs = std::vector<std::array<std::uint32_t, 2>>;

/// Pairs of drops of which one encloses the other or whose surfaces meet.
Pairs meeting_pairs(const std::vector<Drop>& drops, const std::vector<Eigen::AlignedBox3d>& boxes,
                    const Pairs& candidates) {
  std::vector<std::uint8_t> meet(candidates.size(), 0);
  tbb::parallel_for(std::size_t{0}, candidates.size(), [&](std::size_t k) {
    const auto& [i, j] = candidates[k];
    meet[k] = boxes[i].contains(boxes[j]) || boxes[j].contains(boxes[i]) ||
              surfaces_meet(view_of(drops[i]), view_of(drops[j]));
  });
  Pairs meeting;
  for (std::size_t k = 0; k < candidates.size(); ++k)
    if (meet[k] != 0) meeting.push_back(candidates[k]);
  return meeting;
}

bool boxes_meet(const Drop& a, const Drop& b) { return bounding_box(a).intersects(bounding_box(b)); }

/// The drops move apart, as the pieces of a neck that has just pinched off: by means over their vertices, for the
/// liquid's momentum tells little on a solid. Where solids hold both, speeds do not tell.
bool are_parting(const Drop& a, const Drop& b) {
  if (touches_solid(a) && touches_solid(b)) return false;
  const Eigen::Vector3d apart = mean_over_vertices(a, a.positions()) - mean_over_vertices(b, b.positions());
  const Eigen::Vector3d speed = mean_over_vertices(a, a.velocities()) - mean_over_vertices(b, b.velocities());
  return apart.dot(speed) > 0.01 * apart.norm() * std::max(top_speed(a), top_speed(b));
}

/// Unites what can be united among the drops of a group, the first pair first.
void merge_group(std::vector<Drop>& group, const MergeOptions& options, Remesher& remesher, MergeReport& report) {
  std::vector<Drop> cut_off;  // not tried again in this step: it was part of the drop just now
  for (std::size_t i = 0; i < group.size(); ++i)
    for (std::size_t j = i + 1; j < group.size();) {
      if (!boxes_meet(group[i], group[j]) || are_parting(group[i], group[j])) {
        ++j;
        continue;
      }
      auto united = merge_drops(group[i], group[j], options, remesher, report);
      if (!united) {
        ++j;
        continue;
      }
      group.erase(group.begin() + static_cast<std::ptrdiff_t>(j));
      if (united->empty()) {  // nothing was left to go on
        group.erase(group.begin() + static_cast<std::ptrdiff_t>(i));
      } else {
        group[i] = std::move(united->front());
        std::move(united->begin() + 1, united->end(), std::back_inserter(cut_off));
      }
      j = i + 1;  // it may meet those that its first part did not
    }
  for (Drop& drop : cut_off) drop.set_id(no_id);
  std::move(cut_off.begin(), cut_off.end(), std::back_inserter(group));
}

}  // namespace

MergeReport merge_touching_drops(std::vector<Drop>& drops, BroadPhase& broad_phase, const MergeOptions& options,
                                 Remeshers& remeshers) {
  MergeReport report;
  if (drops.size() < 2) return report;
  const Pairs& near = broad_phase.find_pairs(drops);
  if (near.empty()) return report;
  const Pairs meeting = meeting_pairs(drops, broad_phase.boxes(), near);
  if (meeting.empty()) return report;

  const auto groups = groups_of(drops.size(), meeting);
  std::vector<std::vector<Drop>> results(groups.size());
  std::vector<MergeReport> reports(groups.size());
  tbb::parallel_for(std::size_t{0}, groups.size(), [&](std::size_t g) {
    for (const std::uint32_t i : groups[g]) results[g].push_back(std::move(drops[i]));
    if (groups[g].size() > 1) merge_group(results[g], options, remeshers.local(), reports[g]);
  });
  drops.clear();
  for (std::size_t g = 0; g < groups.size(); ++g) {
    report += reports[g];
    std::move(results[g].begin(), results[g].end(), std::back_inserter(drops));
  }
  return report;
}

}  // namespace meniscus
