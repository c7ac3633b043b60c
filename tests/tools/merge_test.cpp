// SPDX-License-Identifier: GPL-3.0-or-later
#include "tool_test.h"

namespace meniscus {
namespace {

class Merge : public ToolTest {
 protected:
  void SetUp() override {
    ToolTest::SetUp();
    write("a.off", make_box({0, 0, 0}, {2, 2, 2}, 1));
    write("b.off", make_box({1, 0.25, 0.5}, {1, 1, 1}, 0.6));
    write("far.off", make_box({9, 0, 0}, {1, 1, 1}, 1));
  }
};

TEST_F(Merge, UnitesIntersectsAndSubtracts) {
  const std::pair<const char*, double> cases[] = {
      {"", 8.5}, {" --operation union", 8.5}, {" --operation intersection", 0.5}, {" --operation difference", 7.5}};
  for (const auto& [operation, volume] : cases) {
    const Outcome outcome = tool(std::string("merge a.off b.off -o c.ply --json report.json") + operation);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const json r = report("report.json");
    expect_report_fields(r, {"joins", "crossings", "retries", "shift", "outcome", "step"});
    EXPECT_EQ(r["inputs"].size(), 2u);
    EXPECT_EQ(r["outputs"][0]["sound"], true);
    EXPECT_EQ(r["outcome"], "crossing");
    EXPECT_NEAR(volume_of(mesh("c.ply")), volume, 1e-12) << operation;
  }
}

TEST_F(Merge, ManyAtOnceFromAPipe) {
  const Outcome outcome = shell(
      "cat far.off | \"$MENISCUS\" merge a.off - b.off -o - --format off -q | \"$MENISCUS\" check - --format off "
      "--json -");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json r = json::parse(outcome.out);
  EXPECT_EQ(r[0]["components"], 2);
  EXPECT_NEAR(r[0]["volume"].get<double>(), 9.5, 1e-12);
}

TEST_F(Merge, CarriesVelocities) {
  MeshData a = mesh("a.off"), b = mesh("b.off");
  for (MeshData* data : {&a, &b}) {
    data->attributes = {{"vx", ScalarType::float64, {}}, {"drop", ScalarType::int32, {}}};
    for (const auto& p : data->points) {
      data->attributes[0].values.push_back(3 * p[1]);
      data->attributes[1].values.push_back(data == &a ? 5 : 2);
    }
    data->comments = {"drop 5 target_volume 8"};
  }
  write_mesh(path("a.ply"), a);
  write_mesh(path("b.ply"), b);
  ASSERT_EQ(tool("merge a.ply b.ply -o c.ply").code, 0);
  const MeshData c = mesh("c.ply");
  EXPECT_TRUE(c.comments.empty()) << "a target volume of a part means nothing for the whole";
  for (std::size_t v = 0; v < c.points.size(); ++v) {
    EXPECT_NEAR(c.attribute("vx")->values[v], 3 * c.points[v][1], 1e-12);
    EXPECT_EQ(c.attribute("drop")->values[v], 2);
  }
}

TEST_F(Merge, RefusesWhatIsNotSoundAndMendsItIfAsked) {
  MeshData open = mesh("b.off");
  open.triangles.pop_back();
  write_mesh(path("open.off"), open);
  const Outcome refused = tool("merge a.off open.off -o c.off --json report.json");
  EXPECT_EQ(refused.code, 4);
  EXPECT_TRUE(has(refused.err, "open.off")) << refused.err;
  EXPECT_EQ(report("report.json")["status"], "refused");
  EXPECT_EQ(report("report.json")["reason"], "boundary_edge");
  EXPECT_FALSE(fs::exists(path("c.off")));
  ASSERT_EQ(tool("merge a.off open.off -o c.off --repair").code, 0);
  EXPECT_NEAR(volume_of(mesh("c.off")), 8.5, 1e-12);
}

TEST_F(Merge, SaysWhyAndSavesThePairThatFails) {
  write("c.off", make_box({2, 2, 0}, {2, 2, 2}, 9));  // touches along an edge
  const Outcome refused = tool("merge a.off c.off -o d.off --max-shift 0 --save-failing failing --json report.json");
  EXPECT_EQ(refused.code, 4);
  EXPECT_EQ(report("report.json")["reason"], "pinched");
  EXPECT_TRUE(has(refused.err, "2-manifold")) << refused.err;
  EXPECT_EQ(names("failing"), (std::vector<std::string>{"a.ply", "b.ply"}));
  const Outcome moved = tool("merge a.off c.off -o d.off --json report.json");
  ASSERT_EQ(moved.code, 0) << moved.err;
  EXPECT_EQ(report("report.json")["outcome"], "touching");
  EXPECT_GT(report("report.json")["shift"].get<double>(), 0);
  EXPECT_LT(report("report.json")["shift"].get<double>(), 1e-9);
}

TEST_F(Merge, AnEmptyResultIsRefused) {
  const Outcome refused = tool("merge a.off far.off -o c.off --operation intersection --json report.json");
  EXPECT_EQ(refused.code, 4);
  EXPECT_EQ(report("report.json")["reason"], "empty_result");
  EXPECT_FALSE(fs::exists(path("c.off")));
}

TEST_F(Merge, MistakesAreUsageErrors) {
  for (const char* arguments :
       {"merge a.off b.off", "merge -o c.off", "merge a.off b.off -o c.off --operation sum",
        "merge a.off b.off -o c.off --max-shift 2", "split a.off -o 'p_{}.off' --plane 0,0,1",
        "split a.off -o 'p_{}.off' --plane 0,0,0,1", "split a.off -o 'p_{}.off' --plane 0,0,x,1",
        "split a.off -o 'p_{}.off' --plane 0,0,1,0 --cutter b.off",
        "split a.off -o 'p_{}.off' --plane 0,0,1,0 --neck 0.1"})
    EXPECT_EQ(tool(arguments).code, 2) << arguments;
}

TEST_F(Merge, SplitAlongAPlane) {
  const Outcome outcome = tool("split a.off -o 'p_{}.off' --plane 0,0,2,1 --json report.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json r = report("report.json");
  EXPECT_EQ(r["pieces"], 2);
  for (const auto& output : r["outputs"]) EXPECT_EQ(output["sound"], true);
  EXPECT_NEAR(volume_of(mesh("p_0.off")), 6, 1e-12);  // below
  EXPECT_NEAR(volume_of(mesh("p_1.off")), 2, 1e-12);
}

TEST_F(Merge, SplitByAMesh) {
  ASSERT_EQ(tool("split a.off -o 'p_{}.off' --cutter b.off --json report.json").code, 0);
  EXPECT_EQ(report("report.json")["pieces"], 2);
  EXPECT_NEAR(volume_of(mesh("p_0.off")), 0.5, 1e-12);
  EXPECT_NEAR(volume_of(mesh("p_1.off")), 7.5, 1e-12);
}

}  // namespace
}  // namespace meniscus
