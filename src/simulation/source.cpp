// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/simulation/source.h"

#include "meniscus/geometry/shapes.h"
#include "meniscus/operators/external_forces.h"
#include "meniscus/simulation/simulation.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace meniscus {
namespace {

constexpr double flattest_seed = pi / 3, roundest_seed = 2 * pi / 3;

/// The volume of a spherical cap on a disc of radius 1, by its contact angle.
double cap_volume(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return pi / 3 * (2 - 3 * c + c * c * c) / (s * s * s);
}

/// The angle of the cap on a disc of radius 1 that holds `volume`, between the bounds above.
double cap_angle(double volume) {
  double low = flattest_seed, high = roundest_seed;
  for (int k = 0; k < 40; ++k) {
    const double middle = 0.5 * (low + high);
    (cap_volume(middle) < volume ? low : high) = middle;
  }
  return low;
}

/// A cap on the source's disc at a time, of at most `volume` and moving with the liquid; nothing if that is too little.
std::optional<Drop> make_seed(const std::vector<Solid>& solids, std::size_t s, double time, double volume,
                              const EdgeBand& band) {
  const Solid& source = solids[s];
  const double radius = source.inflow->radius, relative = volume / (radius * radius * radius);
  if (relative < cap_volume(flattest_seed)) return std::nullopt;
  const SolidContact middle = source.query(source.inflow->center + source.offset(time), time);
  Drop seed(make_cap(middle.point, middle.normal, radius, cap_angle(relative), 0.5 * (band.edge_min + band.edge_max)));
  find_contact(seed, solids, time, contact_tolerance);
  seed.velocities().colwise() += source.velocity(time) + source.inflow->speed * middle.normal;
  return seed;
}

}  // namespace

FeedReport SourceFeed::feed(std::vector<Drop>& drops, const std::vector<Solid>& solids, double from, double to,
                            const EdgeBand& band, int& next_id) {
  FeedReport report;
  if (std::none_of(solids.begin(), solids.end(), [](const Solid& solid) { return solid.inflow.has_value(); }))
    return report;
  waiting_.resize(solids.size(), 0);
  for (Drop& drop : drops) drop.set_inflow(0);
  for (std::size_t s = 0; s < solids.size(); ++s) {
    if (!solids[s].inflow) continue;
    const Inflow& inflow = *solids[s].inflow;
    waiting_[s] += inflow.speed * pi * inflow.radius * inflow.radius * inflow.seconds_between(from, to);
    if (waiting_[s] == 0) continue;
    const auto hangs = [&](const Drop& drop) { return hangs_from(drop, static_cast<std::int32_t>(s)); };
    auto fed = std::find_if(drops.begin(), drops.end(), hangs);
    if (fed == drops.end()) {
      std::optional<Drop> seed = make_seed(solids, s, from, waiting_[s], band);
      if (!seed || seed->target_volume() > waiting_[s]) continue;
      seed->set_id(next_id++);
      report.volume_added += seed->target_volume();
      waiting_[s] -= seed->target_volume();
      drops.push_back(std::move(*seed));
      fed = drops.end() - 1;
      ++report.new_drops;
    }
    fed->set_inflow(fed->inflow() + waiting_[s] / (to - from));
    fed->set_rest_time(0);
    report.volume_added += waiting_[s];
    waiting_[s] = 0;
  }
  return report;
}

double SourceFeed::waiting() const { return std::accumulate(waiting_.begin(), waiting_.end(), 0.0); }

}  // namespace meniscus
