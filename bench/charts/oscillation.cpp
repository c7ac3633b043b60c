// SPDX-License-Identifier: GPL-3.0-or-later
// A ball of water of R = 0.2 cm swings in mode 2 at 5 %: error of the frequency and amplitude kept a period against
// processor seconds a period, for each level, mesh and time step. Beside gerris (volume of fluid), axisymmetric and 3D,
// with water's viscosity, of which the exact decay is taken out of what it kept.
#include "charts.h"
#include "references/waves.h"
#include "support/levels.h"
#include "support/modes.h"
#include "support/process.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

namespace meniscus::bench {
namespace {

constexpr double radius = 0.2, pi = 3.14159265358979323846, nan = std::numeric_limits<double>::quiet_NaN();

/// Zero crossings and swings of the quadrupole moment, "q time: t first: ... sum: q" a line.
struct Signal {
  double frequency = nan, kept_per_period = nan, end = 0;
};

Signal read_signal(const std::filesystem::path& file) {
  std::ifstream stream(file);
  Signal signal;
  double t_before = 0, q_before = 0, first = nan, last = nan, swing = 0;
  std::vector<double> swings;
  for (std::string line; std::getline(stream, line);) {
    const std::size_t time_at = line.find("time: "), sum_at = line.find("sum: ");
    if (time_at == std::string::npos || sum_at == std::string::npos) continue;
    const double t = std::stod(line.substr(time_at + 6)), q = std::stod(line.substr(sum_at + 5));
    if (q_before * q < 0) {
      last = t_before + (t - t_before) * q_before / (q_before - q);
      if (swings.empty()) first = last;
      swings.push_back(swing);
      swing = 0;
    }
    swing = std::max(swing, std::abs(q));
    t_before = signal.end = t;
    q_before = q;
  }
  if (swings.size() > 1) signal.frequency = pi * static_cast<double>(swings.size() - 1) / (last - first);
  if (swings.size() > 2) signal.kept_per_period = swings[2] / swings[0];
  return signal;
}

void add_gerris(ChartTable& table, const char* program, const char* name, int level, const std::string& file,
                double end) {
  if (!is_installed(program) || !is_installed("m4")) {
    fmt::print("{}: skipped, {} is not installed\n", name, program);
    return;
  }
  const TemporaryDirectory directory;
  const Liquid water;
  const double exact = references::rayleigh_frequency(2, radius, water), period = 2 * pi / exact;
  const Finished run =
      run_program({program, "-m", "-D", fmt::format("LEVEL={}", level), "-D", fmt::format("LM1={}", level), "-D",
                   fmt::format("LM2={}", level - 1), "-D", "RATIO=1000.", "-D", fmt::format("TEND={}", end),
                   MENISCUS_SOURCE_DIR "/bench/peers/" + file},
                  directory.path(), {}, 900);
  const Signal signal = read_signal(directory.path() / "q.out");
  if (run.code != 0 || std::isnan(signal.frequency)) {
    fmt::print("{}: skipped, it ended with code {} ({})\n", name, run.code, run.output.substr(0, 200));
    return;
  }
  const double decay = std::exp(-references::lamb_decay(2, radius, water) * period);
  table.add({std::string(name), std::pow(2.0, level) * (file.find("3d") != std::string::npos ? 0.25 : 0.5), nan,
             signal.frequency / exact - 1, signal.kept_per_period / decay, run.cpu_seconds * period / signal.end});
}

/// A row of the chart.
struct Point {
  explicit Point(const std::vector<Cell>& row)
      : method(std::get<std::string>(row[0])),
        size(std::get<double>(row[1])),
        time_step(std::get<double>(row[2])),
        error(std::abs(std::get<double>(row[3]))),
        kept(std::get<double>(row[4])),
        seconds(std::get<double>(row[5])) {}
  bool is_peer() const { return std::isnan(time_step); }

  std::string method;
  double size, time_step, error, kept, seconds;
};

/// How many times more a peer costs than the cheapest of ours that is no further off and keeps so much of its
/// amplitude a period.
void note_ratio(ChartTable& table, const Point& peer, double least_kept) {
  const Point* best = nullptr;
  std::vector<Point> points;
  for (const auto& row : table.rows()) points.emplace_back(row);
  for (const Point& point : points)
    if (!point.is_peer() && point.error <= peer.error && (least_kept == 0 || point.kept >= least_kept) &&
        (!best || point.seconds < best->seconds))
      best = &point;
  const std::string those = least_kept > 0 ? fmt::format(" that keeps {} of its amplitude a period", least_kept) : "";
  if (!best)
    table.note(fmt::format("{}, {} cells a radius: none of ours{} is as near", peer.method, peer.size, those));
  else
    table.note(
        fmt::format("{}, {} cells a radius, is {:.2f} % off in {:.3g} s a period; the cheapest of ours{} that "
                    "is no further off: {}, {} vertices, 1/{:.0f} s, {:.2f} % in {:.3g} s: {:.0f} times less",
                    peer.method, peer.size, 100 * peer.error, peer.seconds, those, best->method, best->size,
                    1 / best->time_step, 100 * best->error, best->seconds, peer.seconds / best->seconds));
}

}  // namespace

ChartTable oscillation_chart(bool quick) {
  ChartTable table("oscillation",
                   "Mode 2 of a ball of water, R = 0.2 cm, 5 %, beside "
                   "Rayleigh; size is vertices, or cells a radius",
                   {"method", "size", "time_step", "frequency_error", "kept_per_period", "cpu_seconds_per_period"});
  for (const NamedLevel& level : levels)
    for (const int frequency : {8, 16, 32})
      for (const double rate : {240.0, 480.0, 960.0, 1920.0, 3840.0, 7680.0}) {
        if (quick && (frequency > 8 || rate > 1000)) continue;
        const ModeRun run = run_mode(2, frequency, 1 / rate, 2.5, inviscid_water(level.level));
        table.add({std::string(level.name), 10.0 * frequency * frequency + 2, 1 / rate, run.frequency_error,
                   run.kept_per_period, run.cpu_per_period});
      }
  if (quick) return table;
  add_gerris(table, "gerris2D", "gerris axisymmetric", 4, "gerris_drop_axisymmetric.gfs", 0.0469);
  add_gerris(table, "gerris2D", "gerris axisymmetric", 5, "gerris_drop_axisymmetric.gfs", 0.0469);
  add_gerris(table, "gerris3D", "gerris 3D", 5, "gerris_drop_3d.gfs", 0.0195);
  std::vector<Point> peers;
  for (const auto& row : table.rows())
    if (const Point point(row); point.is_peer()) peers.push_back(point);
  for (const Point& peer : peers)
    for (const double least_kept : {0.0, 0.95}) note_ratio(table, peer, least_kept);
  return table;
}

}  // namespace meniscus::bench
