// SPDX-License-Identifier: GPL-3.0-or-later
#include "tool_test.h"

#include <cmath>

namespace meniscus {
namespace {

/// convert, remesh, split and flow: meshes in, meshes out.
class MeshVerbs : public ToolTest {
 protected:
  /// A sphere whose velocity is twice its position, with an attribute of its own.
  static MeshData sphere_with_attributes() {
    MeshData data = to_mesh_data(sphere());
    const char* const names[] = {"vx", "vy", "vz"};
    for (std::size_t k = 0; k < 3; ++k) {
      data.attributes.push_back({names[k], ScalarType::float64, {}});
      for (const auto& point : data.points) data.attributes[k].values.push_back(2 * point[k]);
    }
    data.attributes.push_back({"temperature", ScalarType::float32, std::vector<double>(data.points.size(), 21)});
    data.attributes.push_back({"drop", ScalarType::int32, std::vector<double>(data.points.size(), 5)});
    data.comments = {"drop 5 target_volume 0.03", "from a test"};
    return data;
  }
};

TEST_F(MeshVerbs, ConvertKeepsTheMeshThroughEveryFormat) {
  write("a.ply", sphere());
  const MeshData data = mesh("a.ply");
  ASSERT_EQ(tool("convert a.ply b.off").code, 0);
  ASSERT_EQ(tool("convert b.off c.obj").code, 0);
  ASSERT_EQ(tool("convert c.obj d.ply --text").code, 0);
  EXPECT_EQ(mesh("d.ply").points, data.points);
  EXPECT_EQ(mesh("d.ply").triangles, data.triangles);
  EXPECT_TRUE(has(text("d.ply"), "format ascii"));
  ASSERT_EQ(tool("convert d.ply e.stl --json report.json").code, 0);
  EXPECT_EQ(mesh("e.stl").triangles.size(), data.triangles.size());
  expect_report_fields(report("report.json"), {});
}

TEST_F(MeshVerbs, ConvertKeepsAttributesAndSaysWhenAFormatCannot) {
  const MeshData data = sphere_with_attributes();
  write_mesh(path("a.ply"), data);
  ASSERT_EQ(tool("convert a.ply b.ply").code, 0);
  EXPECT_EQ(mesh("b.ply").comments, data.comments);
  for (const auto& attribute : data.attributes) {
    ASSERT_NE(mesh("b.ply").attribute(attribute.name), nullptr);
    EXPECT_EQ(mesh("b.ply").attribute(attribute.name)->values, attribute.values);
  }
  const Outcome outcome = tool("convert a.ply b.off");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_TRUE(has(outcome.err, "temperature")) << outcome.err;
}

TEST_F(MeshVerbs, PipesGoFromVerbToVerb) {
  write("a.stl", sphere());
  const Outcome outcome = shell(
      "cat a.stl | \"$MENISCUS\" convert - - --format stl --output-format ply |"
      " \"$MENISCUS\" remesh - -o - --format ply --edge 0.05 -q | \"$MENISCUS\" check - --format ply --json -");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(json::parse(outcome.out)[0]["sound"], true);
}

TEST_F(MeshVerbs, MeshAndReportCannotShareStdout) {
  write("a.ply", sphere());
  for (const char* arguments : {"convert a.ply - --format ply", "remesh a.ply -o - --format ply --edge 0.05",
                                "flow a.ply -o - --format ply --gamma 1 --dt 1e-4"}) {
    EXPECT_EQ(tool(std::string(arguments) + " --json -").code, 2) << arguments;
    EXPECT_EQ(tool(std::string(arguments) + " --json report.json").code, 0) << arguments;
  }
}

TEST_F(MeshVerbs, RemeshBringsEdgesIntoTheBandAndCarriesAttributes) {
  write_mesh(path("a.ply"), sphere_with_attributes());
  const Outcome outcome = tool("remesh a.ply -o b.ply --edge-min 0.02 --edge-max 0.05 --json report.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json r = report("report.json");
  expect_report_fields(r, {"splits", "collapses", "flips", "cuts", "passes", "retries", "edges_below", "edges_above"});
  EXPECT_EQ(r["outputs"][0]["sound"], true);
  EXPECT_GT(r["splits"].get<int>(), 0);
  EXPECT_LE(r["outputs"][0]["edge_length"]["max"].get<double>(), 0.05);
  EXPECT_GE(r["outputs"][0]["edge_length"]["min"].get<double>(), 0.02);
  const MeshData data = mesh("b.ply");
  ASSERT_NE(data.attribute("vx"), nullptr);
  ASSERT_NE(data.attribute("temperature"), nullptr);
  EXPECT_EQ(data.attribute("temperature")->type, ScalarType::float32);
  EXPECT_EQ(data.comments, sphere_with_attributes().comments);
  for (std::size_t v = 0; v < data.points.size(); ++v) {
    EXPECT_NEAR(data.attribute("vx")->values[v], 2 * data.points[v][0], 0.02);
    EXPECT_NEAR(data.attribute("temperature")->values[v], 21, 1e-5);
    EXPECT_EQ(data.attribute("drop")->values[v], 5);
  }
}

TEST_F(MeshVerbs, RemeshByCgalWorksToo) {
  write_mesh(path("a.ply"), sphere_with_attributes());
  const Outcome outcome = tool("remesh a.ply -o b.off --edge 0.04 --method isotropic --json report.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(report("report.json")["outputs"][0]["sound"], true);
  EXPECT_NEAR(report("report.json")["outputs"][0]["edge_length"]["mean"].get<double>(), 0.04, 0.01);
}

TEST_F(MeshVerbs, RemeshKeepsSharpEdgesIfAsked) {
  write("a.off", make_box({0, 0, 0}, {1, 1, 1}, 0.5));
  ASSERT_EQ(tool("remesh a.off -o b.off --edge 0.2 --features 40").code, 0);
  EXPECT_NEAR(volume_of(mesh("b.off")), 1, 1e-12);
}

TEST_F(MeshVerbs, BandsThatMeanNothingAreUsageErrors) {
  write("a.ply", sphere());
  const std::pair<const char*, const char*> cases[] = {
      {"--edge-min 0.06 --edge-max 0.12", "edge"}, {"--edge-min 0.2 --edge-max 0.1", "edge"}, {"--edge 1e-7", "faces"}};
  for (const auto& [band, word] : cases) {
    const Outcome outcome = tool(std::string("remesh a.ply -o b.ply ") + band);
    EXPECT_EQ(outcome.code, 2) << band << outcome.err;
    EXPECT_TRUE(has(outcome.err, word)) << outcome.err;
  }
  const Outcome isotropic = tool("remesh a.ply -o b.ply --method isotropic --edge 1e-7");
  EXPECT_EQ(isotropic.code, 2) << isotropic.err;
  EXPECT_EQ(names(), (std::vector<std::string>{"a.ply"}));
}

TEST_F(MeshVerbs, OpenMeshesAreRefusedWithAReport) {
  write_mesh(path("a.ply"), open_sphere());
  write("b.ply", "old");
  for (const char* arguments :
       {"remesh a.ply -o b.ply --edge 0.05", "flow a.ply -o b.ply --gamma 1 --dt 1e-4", "split a.ply -o 'b{}.ply'"}) {
    const Outcome outcome = tool(std::string(arguments) + " --json report.json");
    EXPECT_EQ(outcome.code, 4) << arguments;
    EXPECT_TRUE(has(outcome.err, "a.ply")) << outcome.err;
    EXPECT_TRUE(has(outcome.err, "open")) << outcome.err;
    const json r = report("report.json");
    EXPECT_EQ(r["status"], "refused");
    EXPECT_EQ(r["reason"], "boundary_edge");
    EXPECT_FALSE(r["message"].get<std::string>().empty());
    expect_check_fields(r["inputs"][0]);
    EXPECT_TRUE(r["outputs"].empty());
  }
  EXPECT_EQ(text("b.ply"), "old") << "whole or not at all";
  EXPECT_EQ(names(), (std::vector<std::string>{"a.ply", "b.ply", "report.json"}));
}

TEST_F(MeshVerbs, OtherMeshesThatCannotBeTakenAreRefused) {
  MeshData data = to_mesh_data(sphere());
  data.points[3][0] = std::nan("");
  write_mesh(path("nan.ply"), data);
  write("empty.off", "OFF\n0 0 0\n");
  data = to_mesh_data(sphere());
  data.triangles.push_back({0, 1, 2});
  write_mesh(path("fin.ply"), data);
  for (const char* file : {"nan.ply", "empty.off", "fin.ply"}) {
    const Outcome outcome = tool(std::string("remesh ") + file + " -o out.ply --edge 0.05");
    EXPECT_EQ(outcome.code, 4) << file << outcome.err;
    EXPECT_TRUE(has(outcome.err, file)) << outcome.err;
  }
  EXPECT_FALSE(fs::exists(path("out.ply")));
}

TEST_F(MeshVerbs, OutputThatCannotBeWrittenIsAFileError) {
  write("a.ply", sphere());
  const Outcome outcome = tool("remesh a.ply -o nowhere/b.ply --edge 0.05");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_TRUE(has(outcome.err, "nowhere/b.ply")) << outcome.err;
  EXPECT_EQ(tool("convert a.ply b.xyz").code, 2);
}

TEST_F(MeshVerbs, SplitWritesAFileAComponent) {
  MeshData data = joined(sphere(), make_sphere({1, 0, 0}, 0.1, 0.05));
  data.attributes.push_back({"drop", ScalarType::int32, std::vector<double>(data.points.size(), 3)});
  write_mesh(path("a.ply"), data);
  const Outcome outcome = tool("split a.ply -o 'piece_{}.ply' --json report.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(names(), (std::vector<std::string>{"a.ply", "piece_0.ply", "piece_1.ply", "report.json"}));
  const json r = report("report.json");
  expect_report_fields(r, {"cuts", "pieces"});
  EXPECT_EQ(r["outputs"].size(), 2u);
  for (const auto& output : r["outputs"]) EXPECT_EQ(output["sound"], true);
  EXPECT_NEAR(volume_of(mesh("piece_0.ply")), volume_of(to_mesh_data(sphere())), 1e-15);
  EXPECT_EQ(mesh("piece_1.ply").attribute("drop")->values[0], 3);
}

TEST_F(MeshVerbs, SplitCutsNecks) {
  write("a.off", make_dumbbell(1.2, 0.2, 0.03, 0.03));
  ASSERT_EQ(tool("split a.off -o 'whole_{}.off'").code, 0);
  EXPECT_FALSE(fs::exists(path("whole_1.off")));
  const Outcome outcome = tool("split a.off -o 'half_{}.off' --neck 0.1 --json report.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json r = report("report.json");
  EXPECT_EQ(r["cuts"], 1);
  ASSERT_EQ(r["outputs"].size(), 2u);
  for (const auto& output : r["outputs"]) EXPECT_EQ(output["sound"], true);
  EXPECT_NEAR(volume_of(mesh("half_0.off")) + volume_of(mesh("half_1.off")), volume_of(mesh("a.off")), 1e-4);
}

TEST_F(MeshVerbs, FlowShrinksASphereAsTheFormulaSays) {
  write("a.ply", make_icosphere({1, 2, 3}, 0.2, 12));
  const Outcome outcome = tool("flow a.ply -o b.ply --gamma 1 --dt 1e-5 --steps 100 --json report.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  expect_report_fields(report("report.json"), {"solver_iterations", "steps", "solver"});
  EXPECT_EQ(mesh("b.ply").triangles, mesh("a.ply").triangles);
  const double ratio = volume_of(mesh("b.ply")) / volume_of(mesh("a.ply"));
  EXPECT_NEAR(std::pow(ratio, 2.0 / 3), 1 - 4 * 1e-3 / 0.04, 1e-3) << "r^2 = r0^2 - 4 gamma t";
}

TEST_F(MeshVerbs, FlowKeepsTheVolumeOfEachComponentIfAsked) {
  const Mesh small = make_sphere({1, 0, 0}, 0.1, 0.03);
  write_mesh(path("a.ply"), joined(make_ellipsoid({0, 0, 0}, {0.3, 0.2, 0.2}, 0.05), small));
  ASSERT_EQ(tool("flow a.ply -o b.ply --gamma 1 --dt 1e-4 --steps 20 --keep-volume").code, 0);
  EXPECT_EQ(mesh("b.ply").triangles, mesh("a.ply").triangles);
  EXPECT_NEAR(volume_of(mesh("b.ply")) / volume_of(mesh("a.ply")), 1, 1e-6);
  ASSERT_EQ(tool("split b.ply -o 'b_{}.ply'").code, 0);
  EXPECT_NEAR(volume_of(mesh("b_1.ply")) / volume_of(to_mesh_data(small)), 1, 1e-6);
}

TEST_F(MeshVerbs, FlowKeepsTheVolumeInLongStepsOrSaysThatItCannot) {
  write("box.off", make_box({0, 0, 0}, {1, 1, 1}, 0.15));
  int kept = 0;
  for (const char* dt : {"0.0001", "0.001", "0.01", "0.1", "1", "10"}) {
    const Outcome outcome = tool(std::string("flow box.off -o flown.off --gamma 1 --keep-volume --dt ") + dt);
    if (outcome.code == 5) {
      EXPECT_TRUE(has(outcome.err, "--dt") || has(outcome.err, "smaller")) << outcome.err;
      continue;
    }
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NEAR(volume_of(mesh("flown.off")), volume_of(mesh("box.off")), 1e-8) << dt;
    ++kept;
  }
  EXPECT_GE(kept, 3);
}

TEST_F(MeshVerbs, WhatIsWrongWithAMeshIsSaidOfItsFile) {
  write("ball.off", sphere());
  write_mesh(path("open.off"), open_sphere());
  write("huge.off", "OFF\n4 4 0\n0 0 0\n1e300 0 0\n0 1e300 0\n0 0 1e300\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n");
  const std::pair<const char*, const char*> cases[] = {{"split open.off -o 'p_{}.off' --plane 0,0,1,0", "open.off"},
                                                       {"split ball.off -o 'p_{}.off' --cutter open.off", "open.off"},
                                                       {"convert huge.off huge.glb", "huge.off"},
                                                       {"convert huge.off huge.usda", "huge.off"},
                                                       {"flow huge.off -o b.off --gamma 1 --dt 1", "precision"}};
  for (const auto& [arguments, part] : cases) {
    const Outcome outcome = tool(arguments);
    EXPECT_EQ(outcome.code, 4) << arguments;
    EXPECT_TRUE(has(outcome.err, part)) << outcome.err;
  }
  EXPECT_EQ(tool("remesh ball.off -o b.off --edge 0.1 --features 400").code, 2);
}

TEST_F(MeshVerbs, FlowIsTheSameOnOneThreadAndTwo) {
  write("a.ply", make_ellipsoid({0, 0, 0}, {0.3, 0.2, 0.2}, 0.02));
  const std::string arguments = "flow a.ply --gamma 1 --dt 1e-4 --steps 5 ";
  ASSERT_EQ(tool(arguments + "-o b.ply --threads 1").code, 0);
  ASSERT_EQ(tool(arguments + "-o c.ply --threads 2").code, 0);
  EXPECT_EQ(text("b.ply"), text("c.ply"));
}

}  // namespace
}  // namespace meniscus
