// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <optional>

namespace meniscus::bench {

/// The main function of a benchmark: --help alone prints the usage. Returns what `run` returns; 2 after a UsageError,
/// 5 after any other exception, whose messages go to stderr.
int run_bench(int argc, char** argv, const char* usage, const std::function<int()>& run);

/// What a benchmark that writes charts was asked for.
struct ChartArguments {
  bool quick = false;
  std::filesystem::path out;

  /// Where to write: --out, else docs/charts; with --quick alone nowhere.
  std::optional<std::filesystem::path> directory() const;
};

/// Reads [--quick] [--out DIRECTORY]. Throws UsageError.
ChartArguments chart_arguments(int argc, char** argv, const char* usage);

}  // namespace meniscus::bench
