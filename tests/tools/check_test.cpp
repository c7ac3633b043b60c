// SPDX-License-Identifier: GPL-3.0-or-later
#include "tool_test.h"

#include <cmath>

namespace meniscus {
namespace {

using Check = ToolTest;

TEST_F(Check, SoundMeshIsDoneWithAllFields) {
  write("a.ply", sphere());
  const Outcome outcome = tool("check a.ply --json report.json");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_TRUE(has(outcome.out, "a.ply: sound")) << outcome.out;
  EXPECT_EQ(outcome.err, "");
  const json list = report("report.json");
  ASSERT_EQ(list.size(), 1u);
  expect_check_fields(list[0]);
  const MeshData data = mesh("a.ply");
  EXPECT_EQ(list[0]["vertices"], data.points.size());
  EXPECT_EQ(list[0]["faces"], data.triangles.size());
  EXPECT_EQ(list[0]["components"], 1);
  EXPECT_EQ(list[0]["genus"], 0);
  for (const char* yes : {"closed", "manifold", "outward", "bounds_volume", "sound"})
    EXPECT_EQ(list[0][yes], true) << yes;
  EXPECT_EQ(list[0]["self_intersecting"], false);
  EXPECT_NEAR(list[0]["volume"].get<double>(), volume_of(data), 1e-15);
  EXPECT_TRUE(list[0]["defects"].empty());
}

TEST_F(Check, ReportOnStdoutIsJsonAndNothingElse) {
  write("a.ply", sphere());
  write("b.off", sphere());
  const Outcome outcome = tool("check a.ply b.off --json -");
  const json list = json::parse(outcome.out);
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0]["file"], "a.ply");
  EXPECT_EQ(list[1]["file"], "b.off");
}

TEST_F(Check, DefectsAreFoundNamedAndExitCodeOne) {
  write("sound.off", sphere());
  write_mesh(path("open.ply"), open_sphere());
  const Outcome outcome = tool("check -v sound.off open.ply --json report.json");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_TRUE(has(outcome.out, "open.ply: NOT SOUND")) << outcome.out;
  EXPECT_TRUE(has(outcome.out, "boundary_edge")) << outcome.out;
  const json list = report("report.json");
  EXPECT_EQ(list[0]["sound"], true);
  EXPECT_EQ(list[1]["sound"], false);
  EXPECT_EQ(list[1]["closed"], false);
  ASSERT_EQ(list[1]["defects"].size(), 1u);
  EXPECT_EQ(list[1]["defects"][0]["kind"], "boundary_edge");
  EXPECT_FALSE(list[1]["defects"][0]["message"].get<std::string>().empty());
  EXPECT_EQ(list[1]["defects"][0]["vertices"].size(), 3u);
  EXPECT_TRUE(list[1]["defects"][0].contains("faces"));
}

TEST_F(Check, InsideOutAndSelfIntersectingMeshesAreDefects) {
  MeshData data = to_mesh_data(sphere());
  for (auto& triangle : data.triangles) std::swap(triangle[1], triangle[2]);
  write_mesh(path("inside_out.ply"), data);
  write_mesh(path("overlap.ply"), joined(sphere(), make_sphere({0.2, 0.013, 0.007}, 0.2, 0.06)));
  const Outcome outcome = tool("check inside_out.ply overlap.ply --json -");
  EXPECT_EQ(outcome.code, 1);
  const json list = json::parse(outcome.out);
  EXPECT_EQ(list[0]["outward"], false);
  EXPECT_EQ(list[0]["sound"], false);
  EXPECT_EQ(list[1]["self_intersecting"], true);
  EXPECT_EQ(list[1]["components"], 2);
}

TEST_F(Check, BinaryMeshOnStdinWorks) {
  for (const char* file : {"a.ply", "a.stl", "a.off", "a.obj"}) {
    write(file, sphere());
    const std::string format = fs::path(file).extension().string().substr(1);
    const Outcome outcome = shell(std::string("cat ") + file + " | \"$MENISCUS\" check - --json - --format " + format);
    EXPECT_EQ(outcome.code, 0) << file << outcome.err;
    EXPECT_EQ(json::parse(outcome.out)[0]["faces"], to_mesh_data(sphere()).triangles.size()) << file;
  }
  const Outcome outcome = shell("cat a.ply | \"$MENISCUS\" check -");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_TRUE(has(outcome.err, "--format")) << outcome.err;
}

TEST_F(Check, PolygonsAreCutAndSaidSo) {
  write("cube.off",
        "OFF\n8 6 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
        "4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n");
  const Outcome outcome = tool("check cube.off --json -");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_TRUE(has(outcome.err, "cube.off: 6 polygons cut into 12 triangles")) << outcome.err;
  EXPECT_NEAR(json::parse(outcome.out)[0]["volume"].get<double>(), 1, 1e-14);
}

TEST_F(Check, FilesThatCannotBeReadSayWhereAndWhy) {
  write("good.ply", sphere());
  const std::string whole = text("good.ply");
  write("truncated.ply", whole.substr(0, whole.size() / 2));
  write("header.off", "FOO\n1 2 3\n");
  write("range.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n");
  write("empty.off", "");
  fs::create_directory(path("folder.ply"));
  for (const char* file : {"missing.ply", "truncated.ply", "header.off", "empty.off", "folder.ply"}) {
    const Outcome outcome = tool(std::string("check ") + file);
    EXPECT_EQ(outcome.code, 3) << file << outcome.err;
    EXPECT_TRUE(has(outcome.err, file)) << outcome.err;
  }
  EXPECT_TRUE(has(tool("check header.off").err, "header.off:1")) << tool("check header.off").err;
  const Outcome range = tool("check range.off");
  EXPECT_TRUE(range.code == 1 || range.code == 3) << range.code;
  EXPECT_TRUE(has(range.out + range.err, "7")) << range.out << range.err;
  EXPECT_EQ(tool("check a.txt").code, 2);
}

TEST_F(Check, OneUnreadableFileDoesNotKeepTheOthersFromBeingChecked) {
  write("good.ply", sphere());
  const Outcome outcome = tool("check missing.ply good.ply --json report.json");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_TRUE(has(outcome.err, "missing.ply")) << outcome.err;
  const json list = report("report.json");
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0]["sound"], false);
  EXPECT_EQ(list[1]["sound"], true);
}

TEST_F(Check, CoordinatesThatAreNotFiniteAreDefects) {
  MeshData data = to_mesh_data(sphere());
  data.points[7][1] = std::nan("");
  data.points[9][2] = INFINITY;
  write_mesh(path("a.ply"), data);
  const Outcome outcome = tool("check a.ply --json -");
  EXPECT_EQ(outcome.code, 1);
  const json list = json::parse(outcome.out);
  EXPECT_EQ(list[0]["defects"][0]["kind"], "non_finite_coordinate");
  EXPECT_EQ(list[0]["defects"][0]["vertices"], json({7, 9}));
}

TEST_F(Check, EmptyMeshIsADefect) {
  write("a.off", "OFF\n0 0 0\n");
  const Outcome outcome = tool("check a.off --json -");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(json::parse(outcome.out)[0]["defects"][0]["kind"], "empty_mesh");
}

}  // namespace
}  // namespace meniscus
