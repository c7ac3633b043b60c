// SPDX-License-Identifier: GPL-3.0-or-later
#include "tool_test.h"

namespace meniscus {
namespace {

class Bench : public ToolTest {
 protected:
  /// Whether the benchmarks were built beside the program.
  bool is_built() const { return has(tool("bench").out, "charts\n"); }
};

TEST_F(Bench, ListsWhatThereIs) {
  const Outcome bench = tool("bench");
  EXPECT_EQ(bench.code, 0);
  EXPECT_EQ(bench.err, "");
  EXPECT_TRUE(has(bench.out, is_built() ? "stability\n" : "MENISCUS_BENCH")) << bench.out;
}

TEST_F(Bench, AnswersAMistypedNameWithTheNearestOne) {
  const Outcome bench = tool("bench chart");
  EXPECT_EQ(bench.code, 2);
  EXPECT_TRUE(has(bench.err, is_built() ? "did you mean \"charts\"?" : "not built")) << bench.err;
}

TEST_F(Bench, HandsOptionsAndExitCodeOn) {
  if (!is_built()) GTEST_SKIP() << "no benchmarks beside the program";
  const Outcome bench = tool("bench charts --only nothing --quick");
  EXPECT_EQ(bench.code, 2);
  EXPECT_TRUE(has(bench.err, "there is no chart \"nothing\"")) << bench.err;
}

}  // namespace
}  // namespace meniscus
