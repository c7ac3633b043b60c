// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/run_bench.h"

#include "meniscus/core/error.h"

#include <fmt/format.h>

#include <string>

namespace meniscus::bench {

int run_bench(int argc, char** argv, const char* usage, const std::function<int()>& run) {
  if (argc == 2 && std::string(argv[1]) == "--help") {
    fmt::print("{}\n", usage);
    return 0;
  }
  try {
    return run();
  } catch (const UsageError& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 5;
  }
}

std::optional<std::filesystem::path> ChartArguments::directory() const {
  if (!out.empty()) return out;
  return quick ? std::nullopt : std::make_optional<std::filesystem::path>(MENISCUS_SOURCE_DIR "/docs/charts");
}

ChartArguments chart_arguments(int argc, char** argv, const char* usage) {
  ChartArguments arguments;
  for (int k = 1; k < argc; ++k) {
    const std::string word = argv[k];
    if (word == "--quick")
      arguments.quick = true;
    else if (word == "--out" && k + 1 < argc)
      arguments.out = argv[++k];
    else
      throw UsageError(usage);
  }
  return arguments;
}

}  // namespace meniscus::bench
