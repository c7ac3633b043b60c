// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

namespace meniscus::bench {

/// The main function of a benchmark: --help alone prints the usage. Returns what `run` returns; 2 after a UsageError,
/// 5 after any other exception, whose messages go to stderr.
int run_bench(int argc, char** argv, const char* usage, const std::function<int()>& run);

}  // namespace meniscus::bench
