// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace meniscus::tools {

/// The benchmarks that were built beside this program: ../bench/bench_<name>, sorted.
std::vector<std::string> bench_names();

/// Becomes the benchmark of that name with these arguments; returns only by
/// throwing UsageError, which names the nearest one or says that the benchmarks
/// were not built.
[[noreturn]] void become_bench(const std::string& name, const std::vector<std::string>& arguments);

}  // namespace meniscus::tools
