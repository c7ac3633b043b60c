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

}  // namespace meniscus::bench
