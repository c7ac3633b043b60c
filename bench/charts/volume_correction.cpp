// SPDX-License-Identifier: GPL-3.0-or-later
// Volume correction: none, local, global and both. A ball of water of R = 0.2 cm swings in mode n = 2 to 6 at 5 % with
// each: amplitude kept a period, largest error of the volume, processor seconds a period.
#include "charts.h"
#include "support/levels.h"
#include "support/modes.h"

namespace meniscus::bench {

ChartTable volume_correction_chart(bool quick) {
  const struct {
    const char* name;
    VolumeCorrectionMethod method;
  } corrections[] = {{"none", VolumeCorrectionMethod::none},
                     {"local", VolumeCorrectionMethod::local},
                     {"global", VolumeCorrectionMethod::global},
                     {"both", VolumeCorrectionMethod::local_then_global}};
  ChartTable table(
      "volume_correction",
      "Modes n of a ball of water, 2,562 vertices, dt = 1/4000 s, "
      "over 2.5 of Rayleigh's periods",
      {"level", "correction", "mode", "kept_per_period", "frequency_error", "volume_error", "cpu_seconds_per_period"});
  for (const NamedLevel& level : levels)
    for (const auto& correction : corrections)
      for (int mode = 2; mode <= (quick ? 2 : 6); ++mode) {
        if (level.level == Level::pressure && correction.method != VolumeCorrectionMethod::global)
          continue;  // its solve keeps the volume, whatever the scene says
        StepOptions options = inviscid_water(level.level);
        options.volume_correction = correction.method;
        const ModeRun run = run_mode(mode, quick ? 8 : 16, 1.0 / 4000, quick ? 1 : 2.5, options);
        const char* const name = level.level == Level::pressure ? "own" : correction.name;
        table.add({std::string(level.name), std::string(name), double(mode), run.kept_per_period, run.frequency_error,
                   run.worst_volume_error, run.cpu_per_period});
      }
  return table;
}

}  // namespace meniscus::bench
