// SPDX-License-Identifier: GPL-3.0-or-later
#include "tool_test.h"

#include <csignal>
#include <sstream>

namespace meniscus {
namespace {

/// A drop that falls onto a plate within a few steps.
constexpr const char* splash = R"({
  // a comment
  "time_step": 0.001, "frames": 3, "steps_per_frame": 4,
  "mesh": { "edge_min": 0.04, "edge_max": 0.12 },
  "solids": [ { "name": "plate", "shape": "plane", "point": [0,0,0], "normal": [0,0,1],
                "advancing_angle_deg": 70, "receding_angle_deg": 50 } ],
  "drops": [ { "shape": "sphere", "center": [0,0,0.21], "radius": 0.2, "velocity": [0,0,-20] },
             { "shape": "sphere", "center": [2,0,0.5], "radius": 0.1 } ]
})";

class Evolve : public ToolTest {
 protected:
  void SetUp() override {
    ToolTest::SetUp();
    write("splash.json", splash);
  }
};

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

void expect_run_fields(const json& r) {
  for (const char* field :
       {"scene", "steps", "frames", "simulated_seconds", "wall_seconds", "cpu_seconds", "threads", "triangles",
        "triangle_steps_per_second", "step_ms", "stage_ms", "counts", "volume", "drops"})
    EXPECT_TRUE(r.contains(field)) << field;
  for (const char* field : {"mean", "max"}) EXPECT_TRUE(r["triangles"][field].is_number()) << field;
  for (const char* field : {"p50", "p99", "max"}) EXPECT_TRUE(r["step_ms"][field].is_number()) << field;
  for (const char* field : {"merges", "splits", "deleted", "retries", "refused"})
    EXPECT_TRUE(r["counts"][field].is_number()) << field;
  for (const char* field : {"initial", "added", "final", "worst_relative_error"})
    EXPECT_TRUE(r["volume"][field].is_number()) << field;
  for (const char* field : {"external_forces", "damping", "curvature_flow", "volume_correction", "remesh"})
    EXPECT_TRUE(r["stage_ms"][field].is_number()) << field;
}

TEST_F(Evolve, SceneGivesFramesMeasuresAndASummary) {
  const Outcome outcome = tool("evolve splash.json -o out --json report.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(names("out"), (std::vector<std::string>{"frame_0000.ply", "frame_0001.ply", "frame_0002.ply",
                                                    "frame_0003.ply", "measures.csv", "run.json"}));
  EXPECT_EQ(lines_of(text("out/measures.csv")).size(), 1u + 4 * 2);
  const json r = report("report.json"), run = report("out/run.json");
  expect_run_fields(r);
  expect_run_fields(run);
  EXPECT_EQ(r["steps"], 12);
  EXPECT_EQ(r["frames"], 4);
  EXPECT_EQ(r["drops"], 2);
  EXPECT_NEAR(r["simulated_seconds"].get<double>(), 0.012, 1e-15);
  EXPECT_LT(r["volume"]["worst_relative_error"].get<double>(), 0.02);
  EXPECT_GT(r["step_ms"]["max"].get<double>(), 0);
  EXPECT_TRUE(run.contains("version"));
  EXPECT_EQ(run["resolved_scene"]["liquid"]["surface_tension"], 72);
  const MeshData last = mesh("out/frame_0003.ply");
  for (const char* name : {"vx", "vy", "vz", "drop", "contact"}) ASSERT_NE(last.attribute(name), nullptr) << name;
  EXPECT_EQ(last.comments[0].rfind("time 0.012", 0), 0u) << last.comments[0];
  const auto& contact = last.attribute("contact")->values;
  EXPECT_GT(std::count(contact.begin(), contact.end(), 2), 0) << "the drop has touched the plate";
  EXPECT_EQ(tool("check out/frame_0000.ply out/frame_0003.ply").code, 0);
}

TEST_F(Evolve, TheModelAutoIsSaidAndReported) {
  const std::string settings = " --set model=auto --set accuracy=motion --set solver.tolerance=1e-5 ";
  const Outcome dry = tool("evolve splash.json --dry-run -o out --json dry.json" + settings);
  ASSERT_EQ(dry.code, 0) << dry.err;
  EXPECT_TRUE(has(dry.err, "auto, motion: pressure in ")) << dry.err;
  const Outcome outcome = tool("evolve splash.json -o out --json report.json" + settings);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(has(outcome.err, "auto, motion: pressure in ")) << outcome.err;
  const json chosen = report("dry.json")["auto"];
  EXPECT_EQ(chosen["accuracy"], "motion");
  EXPECT_EQ(chosen["model"], "pressure");
  EXPECT_EQ(chosen["volume_correction"], "global");
  EXPECT_EQ(chosen["solver"]["method"], "auto");
  EXPECT_EQ(chosen["solver"]["tolerance"], 1e-5) << "the scene's own";
  EXPECT_GE(chosen["substeps"].get<int>(), 3);
  EXPECT_TRUE(chosen["is_met"].is_boolean());
  EXPECT_FALSE(chosen["why"].get<std::string>().empty());
  EXPECT_EQ(report("report.json")["auto"], chosen);
  const json run = report("out/run.json");
  EXPECT_EQ(run["auto"], chosen);
  EXPECT_EQ(run["steps"], 12) << "steps are the scene's, not the model's";
  EXPECT_EQ(run["resolved_scene"]["model"], "auto");
  EXPECT_FALSE(run["resolved_scene"].contains("substeps")) << "the scene has not said it";
  write("said.json", run["resolved_scene"].dump());
  ASSERT_EQ(tool("evolve said.json -o again").code, 0);
  EXPECT_EQ(text("again/frame_0003.ply"), text("out/frame_0003.ply"));
  ASSERT_EQ(tool("evolve splash.json -o plain").code, 0);
  EXPECT_FALSE(report("plain/run.json").contains("auto"));
}

TEST_F(Evolve, VolumeThatGoesAmissIsSaidOnce) {
  const Outcome outcome = tool("evolve splash.json -o out --frames 30 --set volume_correction=none");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::size_t first = outcome.err.find("than they ought to");
  ASSERT_NE(first, std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("than they ought to", first + 10), std::string::npos) << outcome.err;
  EXPECT_GT(report("out/run.json")["volume"]["worst_relative_error"].get<double>(), 0.05);
  EXPECT_FALSE(has(tool("evolve splash.json -o kept").err, "than they ought to"));
}

/// Whatever ends the run. (What the judge of frames says is tested in check_frame_test.)
TEST_F(Evolve, OutsideOfTheSafeRegionNoUnsoundFrameIsWritten) {
  const Outcome outcome =
      tool("evolve '" MENISCUS_DATA_DIR "/regressions/paper_meets_itself.json' -o out --set time_step=0.5");
  EXPECT_EQ(outcome.code, 5);
  EXPECT_TRUE(has(outcome.err, "outside of the region")) << outcome.err;
  EXPECT_EQ(report("out/run.json")["status"], "failed");
  std::string frames;
  for (const std::string& name : names("out"))
    if (name.rfind("frame_", 0) == 0) frames += "out/" + name + " ";
  const Outcome check = tool("check " + frames);
  EXPECT_EQ(check.code, 0) << check.out;
}

TEST_F(Evolve, FramesAreTheSameOnOneThreadAndTwo) {
  ASSERT_EQ(tool("evolve splash.json -o one --threads 1").code, 0);
  ASSERT_EQ(tool("evolve splash.json -o two --threads 2").code, 0);
  EXPECT_EQ(report("one/run.json")["threads"], 1);
  for (const std::string& name : names("one")) {
    if (name == "run.json") continue;  // it tells of seconds
    EXPECT_EQ(text("one/" + name), text("two/" + name)) << name;
  }
}

TEST_F(Evolve, StepsFramesAndSettingsOverrideTheScene) {
  ASSERT_EQ(tool("evolve splash.json -o a --steps 6").code, 0);
  EXPECT_EQ(report("a/run.json")["steps"], 6);
  EXPECT_EQ(report("a/run.json")["frames"], 3) << "0, 4 and the last";
  EXPECT_EQ(tool("evolve splash.json -o b --frames 1 --set steps_per_frame=2 --set liquid.density=1.5").code, 0);
  EXPECT_EQ(report("b/run.json")["steps"], 2);
  EXPECT_EQ(report("b/run.json")["resolved_scene"]["liquid"]["density"], 1.5);
  EXPECT_EQ(tool("evolve splash.json -o c --frames 1 --steps 1").code, 2);
  ASSERT_EQ(tool("evolve splash.json -o d --steps 0 --no-frames").code, 0);
  EXPECT_EQ(names("d"), (std::vector<std::string>{"measures.csv", "run.json"}));
}

TEST_F(Evolve, NegativeGravityIsNoFlag) {
  write("a.ply", sphere());
  ASSERT_EQ(tool("evolve a.ply -o out --steps 1 --gravity -981,0,0 --time-step 0.001").code, 0);
  const json g = report("out/run.json")["resolved_scene"]["gravity"];
  EXPECT_EQ(g, json({-981, 0, 0}));
  for (const char* bad : {"1,2", "1,2,3,4", "a,b,c", "1,,2", "nan,0,0"})
    EXPECT_EQ(tool(std::string("evolve a.ply -o out --gravity ") + bad).code, 2) << bad;
}

TEST_F(Evolve, DryRunWritesNothing) {
  const Outcome outcome = tool("evolve splash.json -o out --dry-run");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_TRUE(has(outcome.out, "12 steps")) << outcome.out;
  EXPECT_EQ(names(), (std::vector<std::string>{"splash.json"}));
}

TEST_F(Evolve, MeshesFallFreelyFromFileToFile) {
  write("a.ply", make_sphere({0, 0, 1}, 0.2, 0.08));
  write("b.off", make_sphere({1, 0, 1}, 0.1, 0.04));
  ASSERT_EQ(tool("evolve a.ply b.off -o one --steps 4 --time-step 0.001").code, 0);
  ASSERT_EQ(tool("evolve one/frame_0001.ply -o two --steps 4 --time-step 0.001").code, 0);
  EXPECT_EQ(report("two/run.json")["drops"], 2);
  const std::vector<std::string> rows = lines_of(text("two/measures.csv"));
  ASSERT_EQ(rows.size(), 5u);
  std::vector<double> fields;
  std::istringstream row(rows[3]);
  for (std::string field; std::getline(row, field, ',');) fields.push_back(field.empty() ? 0 : std::stod(field));
  EXPECT_NEAR(fields[8], 1 - 8 * 9 / 2 * 981 * 1e-6, 1e-4) << "centroid_z = z0 - n (n + 1)/2 g dt^2";
}

TEST_F(Evolve, FramesAsOtherFormatsLieBesideThePly) {
  ASSERT_EQ(tool("evolve splash.json -o out --frames 1 --frames-as off,obj").code, 0);
  EXPECT_EQ(names("out"),
            (std::vector<std::string>{"frame_0000.obj", "frame_0000.off", "frame_0000.ply", "frame_0001.obj",
                                      "frame_0001.off", "frame_0001.ply", "measures.csv", "run.json"}));
  EXPECT_EQ(mesh("out/frame_0001.off").points, mesh("out/frame_0001.ply").points);
}

TEST_F(Evolve, AnOlderRunsFramesGoAndWhatARunStartsFromStays) {
  ASSERT_EQ(tool("evolve splash.json -o out --frames 3").code, 0);
  ASSERT_EQ(tool("evolve splash.json -o out --frames 1").code, 0);
  EXPECT_FALSE(fs::exists(path("out/frame_0002.ply")));
  const Outcome outcome = tool("evolve out/frame_0001.ply -o out --steps 1");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_TRUE(has(outcome.err, "frame_0001.ply")) << outcome.err;
  EXPECT_TRUE(fs::exists(path("out/frame_0001.ply")));
}

TEST_F(Evolve, WhatARunReadsItDoesNotReplace) {
  fs::create_directory(path("out"));
  write("out/frame_0001.off", make_box({0, 0, -1}, {1, 1, 0.2}, 0.2));
  const std::string solid = R"({ "frames": 1, "solids": [ { "shape": "mesh", "file": "out/frame_0001.off" } ],
    "drops": [ { "shape": "sphere", "radius": 0.2 } ] })";
  write("solid.json", solid);
  write("out/run.json", R"({ "frames": 1, "drops": [ { "shape": "sphere", "radius": 0.2 } ] })");
  for (const char* arguments :
       {"solid.json -o out", "out/run.json -o out", "solid.json -o new --json new/frame_0000.ply",
        "solid.json -o new --json new/run.json", "solid.json -o new --json solid.json"}) {
    const auto before = names("out");
    const Outcome outcome = tool(std::string("evolve ") + arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_EQ(names("out"), before) << arguments;
    EXPECT_EQ(text("solid.json"), solid) << arguments;
  }
}

TEST_F(Evolve, MeshesThatAreNoDropsAreRefused) {
  write("empty.off", "OFF\n0 0 0\n");
  write("lonely.off", "OFF\n5 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n5 5 5\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n");
  write("far.off", "OFF\n4 4 0\n0 0 0\n1e10 0 0\n0 1e10 0\n0 0 1e10\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n");
  write("ball.off", sphere());
  write("small.json", R"({ "frames": 1, "drops": [ { "mesh": "ball.off", "scale": 0.01 } ] })");
  write("spoilt.ply",
        "ply\nformat ascii 1.0\ncomment drop 0 target_volume nan\nelement vertex 4\nproperty double x\n"
        "property double y\nproperty double z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n");
  write("thin.json", R"({ "frames": 1, "drops": [ { "shape": "box", "size": [1, 1, 1e-7] } ] })");
  const std::pair<const char*, const char*> cases[] = {{"empty.off", "empty"},     {"lonely.off", "vertex 4"},
                                                       {"far.off", "1e+09"},       {"spoilt.ply", "target_volume nan"},
                                                       {"small.json", "edge_min"}, {"thin.json", "edge_min"}};
  for (const auto& [file, part] : cases) {
    const Outcome outcome = tool(std::string("evolve -o out --frames 1 ") + file);
    EXPECT_EQ(outcome.code, 4) << file;
    EXPECT_TRUE(has(outcome.err, part)) << outcome.err;
    EXPECT_FALSE(fs::exists(path("out/frame_0000.ply"))) << file;
  }
}

TEST_F(Evolve, ADropThatIsTooFastForTheTimeStepIsSaid) {
  write("fast.json", R"({ "frames": 1, "solids": [ { "shape": "plane" } ],
    "drops": [ { "shape": "sphere", "center": [0, 0, 1], "radius": 0.2, "velocity": [0, 0, -1e7] } ] })");
  const Outcome outcome = tool("evolve fast.json -o out --dry-run --json report.json");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_NEAR(report("report.json")["safe_time_step"].get<double>(), 128 * 0.2 / 1e7, 1e-7)
      << "180 triangles hold less than the ball";
}

TEST_F(Evolve, MeshOnStdinIsADrop) {
  write("a.stl", make_sphere({0, 0, 1}, 0.2, 0.08));
  const Outcome outcome = shell("cat a.stl | \"$MENISCUS\" evolve - --format stl -o out --steps 1");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(report("out/run.json")["drops"], 1);
}

TEST_F(Evolve, AllThatIsWrongWithASceneIsSaidAtOnce) {
  write("bad.json",
        "{\n  \"time_step\": -1,\n  \"farmes\": 3,\n  \"drops\": [ { \"raduis\": 0.1 } ],\n  \"gravity\": \"x\"\n}\n");
  const Outcome outcome = tool("evolve bad.json -o out");
  EXPECT_EQ(outcome.code, 2);
  for (const char* part : {"bad.json:2:", "bad.json:3:", "bad.json:4:", "bad.json:5:", "did you mean \"frames\"",
                           "did you mean \"radius\""})
    EXPECT_TRUE(has(outcome.err, part)) << part << "\n" << outcome.err;
  EXPECT_FALSE(fs::exists(path("out")));
  EXPECT_EQ(tool("evolve splash.json -o out --set drops.0.radius=-1").code, 2);
  EXPECT_EQ(tool("evolve splash.json splash.json -o out").code, 2);
}

TEST_F(Evolve, FilesThatCannotBeReadOrTakenHaveTheirExitCodes) {
  write_mesh(path("open.ply"), open_sphere());
  write("text", "");
  EXPECT_EQ(tool("evolve missing.json -o out").code, 3);
  EXPECT_EQ(tool("evolve missing.ply -o out").code, 3);
  EXPECT_EQ(tool("evolve splash.xyz -o out").code, 2);
  const Outcome open = tool("evolve open.ply -o out");
  EXPECT_EQ(open.code, 4);
  EXPECT_TRUE(has(open.err, "open.ply")) << open.err;
  EXPECT_EQ(tool("evolve splash.json -o text").code, 3);
}

TEST_F(Evolve, InterruptedRunEndsItsStepAndWritesItsSummary) {
  const Outcome outcome = shell(
      "\"$MENISCUS\" evolve splash.json -o out --steps 1000000 --set solids='[]' & pid=$!;"
      " while [ ! -e out/frame_0001.ply ]; do sleep 0.05; done; kill -TERM $pid; wait $pid");
  EXPECT_EQ(outcome.code, 130) << outcome.err;
  const json run = report("out/run.json");
  EXPECT_EQ(run["status"], "interrupted");
  EXPECT_GT(run["steps"].get<int>(), 0);
  EXPECT_TRUE(has(outcome.err, "interrupted")) << outcome.err;
}

}  // namespace
}  // namespace meniscus
