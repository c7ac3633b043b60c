// SPDX-License-Identifier: GPL-3.0-or-later
#include "tool_test.h"

#include <thread>

namespace meniscus {
namespace {

/// A drop that hits a plate while another one falls past it.
constexpr const char* scene = R"({
  "time_step": 0.0005, "frames": 8, "steps_per_frame": 4,
  "mesh": { "edge_min": 0.04, "edge_max": 0.12 },
  "solids": [ { "shape": "plane", "advancing_angle_deg": 70, "receding_angle_deg": 50 } ],
  "drops": [ { "shape": "sphere", "center": [0,0,0.21], "radius": 0.2, "velocity": [0,0,-40] },
             { "shape": "sphere", "center": [2,0,0.5], "radius": 0.1 } ]
})";

/// run.json without what a clock says.
json without_times(json run) {
  for (const char* field :
       {"wall_seconds", "cpu_seconds", "threads", "triangle_steps_per_second", "step_ms", "stage_ms"})
    run.erase(field);
  return run;
}

class Resume : public ToolTest {
 protected:
  void SetUp() override {
    ToolTest::SetUp();
    write("scene.json", scene);
    ASSERT_EQ(tool("evolve scene.json -o whole").code, 0);
  }

  void expect_as_whole(const std::string& directory) const {
    ASSERT_EQ(names(directory), names("whole"));
    for (const std::string& name : names("whole")) {
      if (name == "run.json") {
        EXPECT_EQ(without_times(report(directory + "/run.json")), without_times(report("whole/run.json")));
        continue;
      }
      EXPECT_EQ(text(directory + "/" + name), text("whole/" + name)) << name;
    }
  }
  bool has_checkpoint(const std::string& directory) const {
    const auto all = names(directory);
    return std::any_of(all.begin(), all.end(), [](const auto& name) { return has(name, "checkpoint_"); });
  }

  /// Ends a run from outside: `evolve` stops itself as soon as a file appears.
  Outcome stopped_at(const std::string& file, const std::string& signal, const std::string& arguments) const {
    return shell("\"$MENISCUS\" evolve " + arguments + " & pid=$!; while [ ! -e " + file +
                 " ] && kill -0 $pid 2>/dev/null; do :; done; kill -" + signal + " $pid; wait $pid");
  }
};

TEST_F(Resume, AfterEachSignalGivesTheBytesOfTheUnbrokenRun) {
  for (const char* signal : {"INT", "TERM"}) {
    const std::string out = signal;
    const Outcome stopped = stopped_at(out + "/frame_0003.ply", signal, "scene.json -o " + out);
    if (stopped.code == 0) continue;  // it was faster than the signal
    EXPECT_EQ(stopped.code, 130) << stopped.err;
    EXPECT_EQ(report(out + "/run.json")["status"], "interrupted");
    EXPECT_TRUE(has_checkpoint(out));
    const Outcome resumed = tool("evolve scene.json --resume -o " + out);
    ASSERT_EQ(resumed.code, 0) << resumed.err;
    expect_as_whole(out);
  }
}

TEST_F(Resume, AfterKillingGoesOnFromTheLastCheckpoint) {
  for (const char* frame : {"frame_0000.ply", "frame_0002.ply", "frame_0005.ply", "frame_0007.ply"}) {
    const std::string out = std::string("killed_") + frame;
    stopped_at(out + "/" + frame, "KILL", "scene.json --checkpoint-every 2 -o " + out);
    for (const std::string& name : names(out)) {
      if (has(name, ".ply")) {
        EXPECT_EQ(text(out + "/" + name), text("whole/" + name)) << name;
      }
    }
    ASSERT_EQ(tool("evolve scene.json --resume --checkpoint-every 2 -o " + out).code, 0);
    expect_as_whole(out);
  }
}

TEST_F(Resume, WithoutASceneTheCheckpointsOwnIsTaken) {
  ASSERT_EQ(stopped_at("out/frame_0002.ply", "KILL", "scene.json --checkpoint-every 1 -o out").code, 137);
  fs::remove(path("scene.json"));
  const Outcome resumed = tool("evolve --resume -o out");
  ASSERT_EQ(resumed.code, 0) << resumed.err;
  expect_as_whole("out");
  const Outcome again = tool("evolve --resume -o out");
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_TRUE(has(again.err, "complete")) << again.err;
}

TEST_F(Resume, GoesOnFromAnywhereWithoutTheFilesOfDrops) {
  fs::create_directories(path("scenes/meshes"));
  fs::create_directory(path("elsewhere"));
  write("scenes/meshes/ball.off", sphere());
  write("scenes/meshes/plate.off", make_box({0, 0, -0.35}, {1, 1, 0.2}, 0.1));
  write("scenes/a.json", R"({ "frames": 8, "mesh": { "edge_min": 0.04, "edge_max": 0.12 },
    "solids": [ { "shape": "mesh", "file": "meshes/plate.off" } ], "drops": [ { "mesh": "meshes/ball.off" } ] })");
  ASSERT_EQ(tool("evolve scenes/a.json -o whole_a").code, 0);
  ASSERT_EQ(stopped_at("out/frame_0002.ply", "KILL", "scenes/a.json --checkpoint-every 1 -o out").code, 137);
  fs::remove(path("scenes/meshes/ball.off"));
  const Outcome resumed = shell("cd elsewhere && \"$MENISCUS\" evolve --resume -o ../out");
  ASSERT_EQ(resumed.code, 0) << resumed.err;
  for (const std::string& name : names("whole_a")) {
    if (name == "run.json") continue;
    EXPECT_EQ(text("out/" + name), text("whole_a/" + name)) << name;
  }
}

TEST_F(Resume, ASolidsMeshMustBeWhatItWas) {
  const auto plate = [&](double z) { write("plate.off", make_box({0, 0, z - 0.35}, {1, 1, 0.2}, 0.1)); };
  plate(0);
  write("b.json", R"({ "frames": 8, "mesh": { "edge_min": 0.04, "edge_max": 0.12 },
    "solids": [ { "shape": "mesh", "file": "plate.off" } ], "drops": [ { "shape": "sphere", "radius": 0.2 } ] })");
  ASSERT_EQ(stopped_at("out/frame_0002.ply", "KILL", "b.json --checkpoint-every 1 -o out").code, 137);
  const auto expect_refused = [&](const std::string& part) {
    const Outcome outcome = tool("evolve --resume -o out");
    EXPECT_EQ(outcome.code, 3);
    EXPECT_TRUE(has(outcome.err, "plate.off") && has(outcome.err, part)) << outcome.err;
    EXPECT_TRUE(has_checkpoint("out"));
  };
  plate(0.1);
  expect_refused("has changed");
  fs::remove(path("plate.off"));
  expect_refused("is gone");
  fs::create_directory(path("moved"));
  plate(0);
  fs::rename(path("plate.off"), path("moved/plate.off"));
  fs::rename(path("b.json"), path("moved/b.json"));
  EXPECT_EQ(tool("evolve moved/b.json --resume -o out").code, 0) << "the scene says where the mesh is now";
}

TEST_F(Resume, FewerStepsThanAreDoneAreRefused) {
  ASSERT_EQ(stopped_at("out/frame_0004.ply", "KILL", "scene.json --checkpoint-every 1 -o out").code, 137);
  for (const char* arguments : {"--frames 1", "scene.json --steps 2"}) {
    const Outcome outcome = tool(std::string("evolve --resume -o out ") + arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_TRUE(has(outcome.err, "step")) << outcome.err;
  }
  ASSERT_EQ(tool("evolve --resume -o out").code, 0) << "the checkpoint is still there";
  expect_as_whole("out");
}

/// The choice was made for the drops at the start, which are no more.
TEST_F(Resume, WhatTheModelAutoChoseIsKept) {
  const std::string settings = "--set model=auto --set accuracy=motion ";
  ASSERT_EQ(tool("evolve scene.json --overwrite -o whole " + settings).code, 0);
  const std::string arguments = "scene.json --checkpoint-every 1 -o out " + settings;
  ASSERT_EQ(stopped_at("out/frame_0002.ply", "KILL", arguments).code, 137);
  const Outcome resumed = tool("evolve --resume -o out");
  ASSERT_EQ(resumed.code, 0) << resumed.err;
  expect_as_whole("out");
  EXPECT_EQ(report("out/run.json")["auto"], report("whole/run.json")["auto"]);
}

TEST_F(Resume, OfACompleteRunDoesNothing) {
  for (const char* arguments : {"", "scene.json ", "scene.json --frames 2 ", "--frames 8 "}) {
    const Outcome outcome = tool(std::string("evolve --resume -o whole ") + arguments);
    EXPECT_EQ(outcome.code, 0) << arguments;
    EXPECT_TRUE(has(outcome.err, "complete")) << outcome.err;
  }
}

TEST_F(Resume, MoreOfACompleteRunOrAnotherSceneIsRefused) {
  const std::string before = text("whole/run.json");
  for (const char* arguments : {"--frames 9", "scene.json --frames 9", "scene.json --set liquid.viscosity=0.5"}) {
    const Outcome outcome = tool(std::string("evolve --resume -o whole ") + arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_TRUE(has(outcome.err, "whole")) << outcome.err;
  }
  EXPECT_EQ(text("whole/run.json"), before);
}

TEST_F(Resume, WhereNothingIsStartsTheRun) {
  ASSERT_EQ(tool("evolve scene.json --resume -o fresh").code, 0);
  expect_as_whole("fresh");
}

TEST_F(Resume, ADamagedCheckpointGivesWayToTheOneBefore) {
  ASSERT_EQ(stopped_at("out/frame_0004.ply", "KILL", "scene.json --checkpoint-every 1 -o out").code, 137);
  std::vector<std::string> checkpoints = names("out");
  checkpoints.erase(std::remove_if(checkpoints.begin(), checkpoints.end(),
                                   [](const auto& name) { return !has(name, "checkpoint_"); }),
                    checkpoints.end());
  ASSERT_EQ(checkpoints.size(), 2u);
  std::string bytes = text("out/" + checkpoints.back());
  bytes[bytes.size() / 2] ^= 1;
  write("out/" + checkpoints.back(), bytes);
  const Outcome resumed = tool("evolve scene.json --resume -o out");
  ASSERT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_TRUE(has(resumed.err, checkpoints.back())) << resumed.err;
  expect_as_whole("out");
}

TEST_F(Resume, OnlyDamagedCheckpointsAreAnError) {
  fs::create_directory(path("out"));
  write("out/checkpoint_00000004.bin", "meniscus checkpoint 3 5 00000000\nabcde");
  const Outcome outcome = tool("evolve scene.json --resume -o out");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_TRUE(has(outcome.err, "--overwrite")) << outcome.err;
}

TEST_F(Resume, AnotherSceneIsRefusedAndAnInterruptedRunIsNotOverwritten) {
  ASSERT_EQ(stopped_at("out/frame_0002.ply", "KILL", "scene.json --checkpoint-every 1 -o out").code, 137);
  const Outcome other = tool("evolve scene.json --set liquid.viscosity=1 --resume -o out");
  EXPECT_EQ(other.code, 2);
  EXPECT_TRUE(has(other.err, "/liquid/viscosity")) << other.err;
  const Outcome anew = tool("evolve scene.json -o out");
  EXPECT_EQ(anew.code, 2);
  EXPECT_TRUE(has(anew.err, "--overwrite")) << anew.err;
  ASSERT_EQ(tool("evolve scene.json --overwrite -o out").code, 0);
  expect_as_whole("out");
}

TEST_F(Resume, TwoRunsIntoOneDirectoryAreRefused) {
  const Outcome outcome = shell(
      "\"$MENISCUS\" evolve scene.json --set frames=100000 -o out & pid=$!; "
      "while [ ! -e out/frame_0001.ply ]; do sleep 0.01; done; "
      "\"$MENISCUS\" evolve scene.json --overwrite -o out; code=$?; kill -KILL $pid; wait $pid 2>/dev/null; exit "
      "$code");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_TRUE(has(outcome.err, "another run")) << outcome.err;
  EXPECT_EQ(tool("evolve scene.json --overwrite -o out").code, 0) << "a dead run holds nothing";
  expect_as_whole("out");
}

/// 1 MB for a run that needs more: the disk is a small tmpfs, which only root can make.
TEST_F(Resume, AFullDiskNamesTheFileAndSpaceLetsItGoOn) {
  fs::create_directory(path("disk"));
  if (shell("mount -t tmpfs -o size=200k tmpfs disk").code != 0) GTEST_SKIP() << "needs leave to mount a tmpfs";
  const Outcome full = tool("evolve scene.json --checkpoint-every 1 -o disk/out");
  EXPECT_EQ(full.code, 3) << full.err;
  EXPECT_TRUE(has(full.err, "disk/out/")) << full.err;
  EXPECT_TRUE(has(full.err, "No space left")) << full.err;
  std::size_t frames = 0;
  for (const std::string& name : names("disk/out")) {
    EXPECT_FALSE(has(name, ".tmp")) << name;
    if (!has(name, ".ply")) continue;
    ++frames;
    EXPECT_EQ(text("disk/out/" + name), text("whole/" + name)) << name;
  }
  EXPECT_GT(frames, 0u);
  EXPECT_LT(frames, 9u);
  EXPECT_EQ(shell("mount -o remount,size=20m disk").code, 0);
  const Outcome resumed = tool("evolve scene.json --resume -o disk/out");
  EXPECT_EQ(resumed.code, 0) << resumed.err;
  if (resumed.code == 0) expect_as_whole("disk/out");
  shell("umount disk");
}

}  // namespace
}  // namespace meniscus
