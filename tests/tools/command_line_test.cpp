// SPDX-License-Identifier: GPL-3.0-or-later
#include "tool_test.h"

#include "meniscus/core/version.h"

namespace meniscus {
namespace {

using CommandLine = ToolTest;

const std::vector<std::string> verbs{"check", "convert", "remesh", "split", "flow", "evolve", "schema", "bench"};

TEST_F(CommandLine, VersionIsTheLibrarys) {
  const Outcome outcome = tool("--version");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.out, "meniscus " + version() + "\n");
}

TEST_F(CommandLine, HelpListsTheVerbs) {
  const Outcome outcome = tool("--help");
  EXPECT_EQ(outcome.code, 0);
  for (const std::string& verb : verbs) EXPECT_TRUE(has(outcome.out, verb)) << verb;
}

TEST_F(CommandLine, HelpOfEachVerbOpensWithTwoExamples) {
  for (const std::string& verb : verbs) {
    const Outcome outcome = tool(verb + " --help");
    EXPECT_EQ(outcome.code, 0) << verb;
    EXPECT_EQ(outcome.out.rfind("Examples:\n  ", 0), 0u) << verb;
    const std::string examples = outcome.out.substr(0, outcome.out.find("\n\n"));
    EXPECT_EQ(std::count(examples.begin(), examples.end(), '\n'), 2) << verb;
    for (const char* option : {"--json", "--threads", "--quiet", "--verbose"})
      EXPECT_TRUE(has(outcome.out, option)) << verb;
  }
}

TEST_F(CommandLine, UnknownVerbIsAnsweredWithTheNearest) {
  const std::pair<const char*, const char*> cases[] = {
      {"chekc", "check"}, {"evlove", "evolve"}, {"remsh", "remesh"}, {"spilt", "split"}, {"mrege", "merge"}};
  for (const auto& [wrong, right] : cases) {
    const Outcome outcome = tool(std::string(wrong) + " a.ply");
    EXPECT_EQ(outcome.code, 2) << wrong;
    EXPECT_TRUE(has(outcome.err, "did you mean \"" + std::string(right) + "\"")) << outcome.err;
    EXPECT_EQ(outcome.out, "");
  }
}

TEST_F(CommandLine, UnknownFlagIsAnsweredWithTheNearest) {
  const std::pair<const char*, const char*> cases[] = {
      {"remesh a.ply -o b.ply --egde-min 1", "--edge-min"}, {"remesh a.ply --ouput b.ply --edge 1", "--output"},
      {"flow a.ply -o b.ply --gama 1 --dt 1", "--gamma"},   {"check --jsn - a.ply", "--json"},
      {"evolve a.json -o out --dryrun", "--dry-run"},       {"split a.ply -o 'b_{}.ply' --nek=2", "--neck"}};
  for (const auto& [arguments, right] : cases) {
    const Outcome outcome = tool(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_TRUE(has(outcome.err, "did you mean \"" + std::string(right) + "\"")) << arguments << "\n" << outcome.err;
  }
}

TEST_F(CommandLine, WhatIsMissingOrTooMuchIsAUsageError) {
  write("a.ply", sphere());
  for (const char* arguments :
       {"", "check", "convert a.ply", "remesh a.ply", "remesh a.ply -o b.ply", "remesh a.ply -o b.ply --edge-min 1",
        "remesh a.ply -o b.ply --edge 0.1 --edge-max 1", "flow a.ply -o b.ply --gamma 1", "evolve -o out",
        "evolve a.ply", "split a.ply", "split a.ply -o b.ply", "convert a.ply b.ply c.ply", "check --threads 0 a.ply",
        "check --threads x a.ply", "remesh a.ply -o b.ply --edge 0.1 --method best", "--wrong"}) {
    const Outcome outcome = tool(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments << "\n" << outcome.err;
    EXPECT_EQ(outcome.err.rfind("error: ", 0), 0u) << arguments << "\n" << outcome.err;
  }
  EXPECT_EQ(names(), (std::vector<std::string>{"a.ply"}));
}

TEST_F(CommandLine, NumbersMustBeFiniteAndPositive) {
  write("a.ply", sphere());
  for (const char* number : {"0", "-1", "nan", "inf", "1e999", "x", "0.1cm", "''"}) {
    const Outcome outcome = tool(std::string("remesh a.ply -o b.ply --edge ") + number);
    EXPECT_EQ(outcome.code, 2) << number;
    EXPECT_TRUE(has(outcome.err, "--edge")) << outcome.err;
  }
}

TEST_F(CommandLine, SchemaIsJson) {
  const Outcome schema = tool("schema");
  EXPECT_EQ(schema.code, 0);
  EXPECT_TRUE(json::parse(schema.out).contains("properties"));
}

TEST_F(CommandLine, AReportReplacesNoOtherFile) {
  write("a.off", sphere());
  const std::string before = text("a.off");
  for (const char* arguments :
       {"check a.off --json a.off", "convert a.off b.off --json b.off", "merge a.off a.off -o b.off --json ./a.off",
        "view a.off --html a.off", "remesh a.off -o b.off --edge 0.1 --json b.off"}) {
    const Outcome outcome = tool(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_TRUE(has(outcome.err, "choose another name")) << outcome.err;
    EXPECT_EQ(text("a.off"), before) << arguments;
    EXPECT_FALSE(fs::exists(path("b.off"))) << arguments;
  }
}

TEST_F(CommandLine, APageReplacesNoFrameThatItShows) {
  fs::create_directory(path("run"));
  write("run/frame_0000.ply", sphere());
  const std::string before = text("run/frame_0000.ply");
  for (const char* option : {"--html ", "--html b.html --json "}) {
    EXPECT_EQ(tool(std::string("view run ") + option + "run/frame_0000.ply").code, 2) << option;
    EXPECT_EQ(text("run/frame_0000.ply"), before) << option;
  }
}

TEST_F(CommandLine, NamesThatTheSystemRefusesAreFileErrors) {
  fs::create_symlink("loop.off", path("loop.off"));
  write("a.json", R"({ "frames": 0, "drops": [ { "shape": "sphere", "radius": 0.2 } ] })");
  write("b.json", R"({ "frames": 0, "drops": [ { "mesh": "loop.off" } ] })");
  const std::string long_name(300, 'a');
  for (const std::string& arguments :
       {std::string("check loop.off"), std::string("convert loop.off b.off"),
        std::string("view loop.off --html b.html"), std::string("evolve loop.off -o out"),
        std::string("evolve a.json -o loop.off"), "evolve a.json -o " + long_name}) {
    const Outcome outcome = tool(arguments);
    EXPECT_EQ(outcome.code, 3) << arguments << ": " << outcome.err;
    EXPECT_FALSE(has(outcome.err, "internal")) << outcome.err;
  }
  const Outcome scene = tool("evolve b.json -o out");
  EXPECT_EQ(scene.code, 2);
  EXPECT_TRUE(has(scene.err, "cannot be read")) << scene.err;
}

TEST_F(CommandLine, BrokenPipeIsQuiet) {
  write("big.ply", make_icosphere({0, 0, 0}, 1, 40));
  const Outcome outcome = shell("\"$MENISCUS\" convert big.ply - --format off | head -c 1 > logs/head");
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(outcome.code, 0);
}

TEST_F(CommandLine, FullDiskIsAFileErrorThatNamesTheFile) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  write("a.ply", sphere());
  const Outcome outcome = shell("\"$MENISCUS\" schema > /dev/full");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_TRUE(has(outcome.err, "stdout")) << outcome.err;
}

}  // namespace
}  // namespace meniscus
