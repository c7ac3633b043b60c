// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/state/offset_to_volume.h"

#include "meniscus/core/chunks.h"

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

/// Secants need two rounds for a step's change of volume; more are for the first after a merge or a split.
constexpr int max_rounds = 6;
constexpr double volume_tolerance = 1e-12;

}  // namespace

double free_area(const Drop& drop, const SurfaceGeometry& geometry) {
  return sum_over_chunks(drop.num_rows(), 0.0, [&](std::size_t begin, std::size_t end) {
    double part = 0;
    for (auto i = static_cast<std::uint32_t>(begin); i < end; ++i)
      if (is_off_solids(drop, i)) part += geometry.area_vector(i).dot(geometry.normal(i)) / 3;
    return part;
  });
}

VolumeOffset offset_to_volume(Drop& drop, const SurfaceGeometry& geometry, double area, double volume, double least,
                              double most, const std::vector<std::uint8_t>& held) {
  Columns x = drop.positions();
  const auto n = static_cast<std::uint32_t>(drop.num_rows());
  VolumeOffset report;
  report.error = report.error_before = drop.volume() - volume;
  if (!(area > 0)) return report;
  for (int round = 0; round < max_rounds && std::abs(report.error) > volume_tolerance * volume && !report.limited;
       ++round) {
    const double wanted = report.offset - report.error / area;
    const double total = std::clamp(wanted, least, most);
    report.limited = total != wanted;
    const double d = total - report.offset;
    report.offset = total;
    for_each_chunk(n, [&](std::size_t begin, std::size_t end) {
      for (auto i = static_cast<std::uint32_t>(begin); i < end; ++i)
        if (is_off_solids(drop, i) && (held.empty() || held[i] == 0)) x.col(i) += d * geometry.normal(i);
    });
    const double error_old = report.error;
    report.error = drop.volume() - volume;
    if (report.error != error_old) area = (report.error - error_old) / d;  // the normals are the start's
  }
  return report;
}

}  // namespace meniscus
