// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench_program.h"
#include "command.h"
#include "meniscus/core/error.h"
#include "report.h"

namespace meniscus::tools {
namespace {

struct BenchOptions {
  CommonOptions common;
};

struct LaterOptions {
  CommonOptions common;
  std::vector<std::string> arguments;
};

}  // namespace

void add_bench(CLI::App& app, Run& run) {
  const auto options = std::make_shared<BenchOptions>();
  CLI::App* verb =
      add_verb(app,
               {"bench",
                "Run one of the project's benchmarks: speed, accuracy, stability. Without a name, list them.",
                {"meniscus bench charts", "meniscus bench stability --stress 1000"}},
               options->common);
  verb->prefix_command();  // what follows is the benchmark's own
  verb->callback([=, &run] {
    run = [=]() -> int {
      const std::vector<std::string> words = verb->remaining();
      if (!words.empty()) become_bench(words.front(), {words.begin() + 1, words.end()});
      write_stdout(
          fmt::format("{}\nEach is a program of the source tree, bench/ (CONTRIBUTING.md says what it measures).\n",
                      fmt::join(bench_names(), "\n")));
      return done;
    };
  });
}

void add_later_verbs(CLI::App& app, Run& run) {
  const VerbText verbs[] = {{"merge",
                             "Boolean union of closed meshes (comes in a later version).",
                             {"meniscus merge a.ply b.ply -o c.ply", ""}},
                            {"view",
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
