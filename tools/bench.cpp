// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.h"
#include "meniscus/core/error.h"
#include "report.h"

namespace meniscus::tools {
namespace {

struct BenchOptions {
  CommonOptions common;
  std::vector<std::string> arguments;
};

}  // namespace

void add_bench(CLI::App& app, Run& run) {
  const auto options = std::make_shared<BenchOptions>();
  CLI::App* verb = add_verb(
      app,
      {"bench", "Where the project's benchmarks are.", {"meniscus bench", "build/release/bench/bench_<name> --help"}},
      options->common);
  verb->add_option("NAME", options->arguments, "A benchmark");
  verb->callback([=, &run] {
    run = [=]() -> int {
      if (!options->arguments.empty())
        throw UsageError(fmt::format("bench {}: comes in a later version; run build/release/bench/bench_{} instead",
                                     options->arguments.front(), options->arguments.front()));
      write_stdout(
          "Benchmarks are programs of the source tree for now: bench/<name>.cpp is built as\n"
          "build/<preset>/bench/bench_<name>; each tells with --help what it measures.\n");
      return done;
    };
  });
}

}  // namespace meniscus::tools
