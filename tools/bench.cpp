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

}  // namespace

void add_bench(CLI::App& app, Run& run) {
  const auto options = std::make_shared<BenchOptions>();
  CLI::App* verb =
      add_verb(app,
               {"bench",
                "Run one of the project's benchmarks: speed, accuracy, stability. Without a name, list them.",
                {"meniscus bench charts", "meniscus bench stability --quick"}},
               options->common);
  verb->prefix_command();  // what follows is the benchmark's own
  verb->callback([=, &run] {
    run = [=]() -> int {
      const std::vector<std::string> words = verb->remaining();
      if (!words.empty()) become_bench(words.front(), {words.begin() + 1, words.end()});
      const std::vector<std::string> names = bench_names();
      if (names.empty())
        write_stdout("There are no benchmarks beside this program: build the tree with -DMENISCUS_BENCH=ON.\n");
      else
        write_stdout(fmt::format("{}\nCONTRIBUTING.md says what each measures.\n", fmt::join(names, "\n")));
      return done;
    };
  });
}

}  // namespace meniscus::tools
