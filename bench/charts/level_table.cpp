// SPDX-License-Identifier: GPL-3.0-or-later
#include "level_table.h"

#include "meniscus/core/error.h"
#include "references/waves.h"
#include "support/levels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <vector>

namespace meniscus::bench {
namespace {

using Row = std::map<std::string, std::string>;

std::vector<Row> read_rows(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) throw FileError(file.string() + ": cannot be read; run `meniscus bench charts` first");
  std::vector<std::string> names;
  std::vector<Row> rows;
  for (std::string line; std::getline(stream, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::vector<std::string> cells;
    std::stringstream words(line);
    for (std::string cell; std::getline(words, cell, ',');) cells.push_back(cell);
    if (names.empty()) {
      names = cells;
      continue;
    }
    Row& row = rows.emplace_back();
    for (std::size_t k = 0; k < std::min(names.size(), cells.size()); ++k) row[names[k]] = cells[k];
  }
  return rows;
}

double number(const Row& row, const char* name) { return std::stod(row.at(name)); }

/// Mode 2 on 2,562 vertices, R = 0.2 cm of water.
std::string motions(const std::vector<Row>& rows) {
  const double frequency = references::rayleigh_frequency(2, 0.2, Liquid());
  std::string text;
  for (const NamedLevel& level : levels)
    for (const Row& row : rows) {
      if (row.at("method") != level.name || number(row, "size") != 2562) continue;
      const double error = std::abs(number(row, "frequency_error")), kept = number(row, "kept_per_period");
      if (!std::isfinite(error) || !std::isfinite(kept)) continue;
      text += fmt::format("    {{Level::{}, {:.4g}, {:.3g}, {:.3g}, {:.3g}}},\n", level.name,
                          frequency * number(row, "time_step"), error, kept, number(row, "cpu_seconds_per_period"));
    }
  return text;
}

/// The worst of height and contact radius over 60, 90 and 120 degrees, R = 0.2
/// cm of water; seconds of processor to rest, the mean. A level that came to
/// rest at one of them nowhere counts as infinitely wrong.
std::string shapes(const std::vector<Row>& rows) {
  std::string text;
  for (const NamedLevel& level : levels)
    for (const double share : {0.2, 0.1, 0.067, 0.05}) {
      double worst = 0, cost = 0;
      int count = 0;
      for (const Row& row : rows) {
        const double angle = number(row, "angle");
        if (row.at("method") != level.name || number(row, "radius") != 0.2 || angle < 60 || angle > 120) continue;
        if (std::abs(number(row, "edge_over_radius") / share - 1) > 0.01) continue;
        for (const char* name : {"height_error", "contact_radius_error"}) {
          const double error = std::abs(number(row, name));
          worst = std::isfinite(error) ? std::max(worst, error) : HUGE_VAL;
        }
        cost += number(row, "cpu_seconds");
        ++count;
      }
      if (count == 0) continue;
      text += fmt::format("    {{Level::{}, {:.3g}, {}, {:.3g}}},\n", level.name, share,
                          std::isinf(worst) ? std::string("HUGE_VAL") : fmt::format("{:.3g}", worst), cost / count);
    }
  return text;
}

}  // namespace

std::string level_table(const std::filesystem::path& directory) {
  std::string names;
  for (const NamedLevel& level : levels) names += fmt::format("{}Level::{}", names.empty() ? "" : ", ", level.name);
  return fmt::format(
      R"(// SPDX-License-Identifier: GPL-3.0-or-later
// Made by `meniscus bench charts --table` from docs/charts/oscillation.csv and sessile.csv: do not edit.
#pragma once

#include "meniscus/state/parameters.h"

#include <cmath>

namespace meniscus {{

/// Mode 2 of a ball on 2,562 vertices.
struct MeasuredMotion {{
  Level level;
  double phase;            ///< omega dt, radians
  double error;            ///< of the frequency, relative
  double kept_per_period;  ///< of the amplitude
  double cost;             ///< processor seconds a period
}};
inline constexpr MeasuredMotion measured_motions[] = {{
{}}};

/// Drops at rest on a plane at 60, 90 and 120 degrees, R = 0.2 cm.
struct MeasuredShape {{
  Level level;
  double edge_over_radius;  ///< edge_min over the ball's radius
  double error;             ///< the worst of height and contact radius, relative
  double cost;              ///< processor seconds to rest
}};
inline constexpr MeasuredShape measured_shapes[] = {{
{}}};

inline constexpr Level measured_levels[] = {{{}}};

}}  // namespace meniscus
)",
      motions(read_rows(directory / "oscillation.csv")), shapes(read_rows(directory / "sessile.csv")), names);
}

}  // namespace meniscus::bench
