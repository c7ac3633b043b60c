// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.h"
#include "meniscus/core/error.h"
#include "report.h"

namespace meniscus::tools {
namespace {

struct LaterOptions {
  CommonOptions common;
  std::vector<std::string> arguments;
};

}  // namespace

void add_bench(CLI::App& app, Run& run) {
  const auto options = std::make_shared<LaterOptions>();
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

void add_later_verbs(CLI::App& app, Run& run) {
  const VerbText verbs[] = {{"view",
                             "One page that plays frames offline (comes in a later version).",
                             {"meniscus view out --html out.html", ""}}};
  for (const VerbText& text : verbs) {
    const auto options = std::make_shared<LaterOptions>();
    CLI::App* verb = add_verb(app, text, options->common);
    verb->prefix_command();  // takes whatever follows
    verb->callback([name = text.name, options, &run] {
      run = [name, options]() -> int { throw UsageError(name + ": comes in a later version"); };
    });
  }
}

}  // namespace meniscus::tools
