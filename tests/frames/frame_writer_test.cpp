// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/frames/frame_writer.h"

#include "meniscus/core/error.h"
#include "meniscus/frames/measures.h"
#include "meniscus/geometry/shapes.h"
#include "meniscus/io/read_file.h"
#include "meniscus/io/read_mesh.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

namespace meniscus {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

class FrameWriterTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "meniscus_frames_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    directory_ = name;
  }
  void TearDown() override { fs::remove_all(directory_); }

  void touch(const std::string& name) const { std::ofstream(directory_ / name) << "old"; }
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const auto& entry : fs::directory_iterator(directory_)) all.push_back(entry.path().filename().string());
    std::sort(all.begin(), all.end());
    return all;
  }

  fs::path directory_;
};

std::vector<Drop> two_drops() {
  std::vector<Drop> drops;
  drops.emplace_back(make_sphere({0, 0, 1}, 0.2, 0.1));
  drops.emplace_back(make_sphere({1.0 / 3, 0, 1}, 0.1, 0.05));
  drops[0].set_id(4);
  drops[1].set_id(7);
  drops[1].velocities().setConstant(-1.0 / 7);
  drops[1].set_target_volume(0.005);
  drops[0].contact()[0] = Contact::line;
  return drops;
}

TEST_F(FrameWriterTest, FrameReadsBackToTheSameDropsBitForBit) {
  const std::vector<Drop> drops = two_drops();
  FrameWriter writer(directory_);
  writer.write(0, 1.0 / 3, drops);
  EXPECT_EQ(writer.num_frames(), 1);
  const MeshData data = read_mesh(directory_ / "frame_0000.ply");
  ASSERT_FALSE(data.comments.empty());
  EXPECT_EQ(data.comments[0], "time 0.33333333333333331");
  ASSERT_NE(data.attribute("drop"), nullptr);
  EXPECT_EQ(data.attribute("drop")->type, ScalarType::int32);
  ASSERT_NE(data.attribute("contact"), nullptr);
  EXPECT_EQ(data.attribute("contact")->type, ScalarType::uint8);
  EXPECT_EQ(data.attribute("vx")->type, ScalarType::float64);
  const std::vector<Drop> read = to_drops(data);
  ASSERT_EQ(read.size(), 2u);
  for (int k = 0; k < 2; ++k) {
    EXPECT_EQ(read[k].id(), drops[k].id());
    EXPECT_EQ(read[k].target_volume(), drops[k].target_volume());
    EXPECT_TRUE(read[k].positions() == drops[k].positions());
    EXPECT_TRUE(read[k].velocities() == drops[k].velocities());
    EXPECT_EQ(read[k].connectivity().triangles(), drops[k].connectivity().triangles());
    EXPECT_TRUE(std::equal(read[k].contact(), read[k].contact() + read[k].num_rows(), drops[k].contact()));
  }
}

TEST_F(FrameWriterTest, FrameWithoutDropsIsAnEmptyMesh) {
  FrameWriter writer(directory_);
  writer.write(0, 0, {});
  EXPECT_TRUE(read_mesh(directory_ / "frame_0000.ply").points.empty());
  EXPECT_EQ(read_file(directory_ / "measures.csv"), measures_header());
}

TEST_F(FrameWriterTest, TableHasALineAFrameAndDrop) {
  const std::vector<Drop> drops = two_drops();
  FrameWriter writer(directory_);
  writer.write(0, 0, drops);
  writer.write(1, 0.25, drops);
  std::string expected = measures_header();
  for (const double time : {0.0, 0.25})
    for (const Drop& drop : drops) expected += measures_row(time, measure_drop(drop, 1));
  EXPECT_EQ(read_file(directory_ / "measures.csv"), expected);
}

TEST_F(FrameWriterTest, OtherFormatsLieBesideThePly) {
  FrameOptions options;
  options.formats = parse_frame_formats("off,obj");
  FrameWriter writer(directory_ / "deep" / "er", options);
  writer.write(12, 0, two_drops());
  const fs::path place = directory_ / "deep" / "er";
  const auto triangles = read_mesh(place / "frame_0012.ply").triangles;
  EXPECT_EQ(read_mesh(place / "frame_0012.off").triangles, triangles);
  EXPECT_EQ(read_mesh(place / "frame_0012.obj").triangles, triangles);
}

TEST_F(FrameWriterTest, OldFramesGoAndNothingElse) {
  for (const char* name : {"frame_0000.ply", "frame_0123.off", "frame_12345.obj", "frame_0000.vtp", "frame_0000.glb",
                           "frames.pvd", "frames.usda", "frame_0001.stl", "frame_1.ply", "frame_00001.ply",
                           "my_frame_0000.ply", "frame_0000.ply.bak", "notes.txt"})
    touch(name);
  FrameWriter writer(directory_);
  EXPECT_EQ(names(), (std::vector<std::string>{"frame_0000.ply.bak", "frame_00001.ply", "frame_0001.stl", "frame_1.ply",
                                               "measures.csv", "my_frame_0000.ply", "notes.txt"}));
}

TEST_F(FrameWriterTest, WithoutMeshesOldFramesStay) {
  touch("frame_0000.ply");
  FrameOptions options;
  options.meshes = false;
  FrameWriter writer(directory_, options);
  writer.write(0, 0, two_drops());
  EXPECT_EQ(names(), (std::vector<std::string>{"frame_0000.ply", "measures.csv"}));
  EXPECT_EQ(read_file(directory_ / "frame_0000.ply"), "old");
}

TEST_F(FrameWriterTest, DirectoryThatIsAFileIsAnError) {
  touch("taken");
  EXPECT_THROW(FrameWriter(directory_ / "taken"), FileError);
  EXPECT_THROW(FrameWriter(directory_ / "taken" / "deeper"), FileError);
}

TEST_F(FrameWriterTest, CollectionListsTheFramesSoFar) {
  FrameOptions options;
  options.formats = parse_frame_formats("vtp");
  FrameWriter writer(directory_, options);
  for (int k = 0; k < 3; ++k) {
    writer.write(k, 0.25 * k, two_drops());
    const std::string list = read_file(directory_ / "frames.pvd");
    EXPECT_NE(list.find(fmt::format("timestep=\"{:.17g}\" part=\"0\" file=\"frame_000{}.vtp\"", 0.25 * k, k)),
              std::string::npos)
        << list;
    EXPECT_EQ(std::count(list.begin(), list.end(), '\n'), 3 + 2 + (k + 1));
  }
}

TEST_F(FrameWriterTest, SequenceOfAllFramesComesAtTheEnd) {
  FrameOptions options;
  options.formats = parse_frame_formats("usda");
  FrameWriter writer(directory_, options);
  writer.write(0, 0, two_drops());
  writer.write(1, 0.5, two_drops());
  EXPECT_FALSE(fs::exists(directory_ / "frames.usda"));
  writer.finish();
  const std::string text = read_file(directory_ / "frames.usda");
  EXPECT_EQ(text.rfind("#usda 1.0\n", 0), 0u);
  EXPECT_NE(text.find("timeCodesPerSecond = 2\n"), std::string::npos);
  EXPECT_NE(text.find("endTimeCode = 1\n"), std::string::npos);
  EXPECT_EQ(names(), (std::vector<std::string>{"frame_0000.ply", "frame_0001.ply", "frames.usda", "measures.csv"}));
}

TEST(FrameFormats, PlyIsAlwaysFirstAndNamesAreChecked) {
  using Formats = std::vector<FrameFormat>;
  EXPECT_EQ(parse_frame_formats("ply"), (Formats{FrameFormat::ply}));
  EXPECT_EQ(parse_frame_formats("obj,off,obj"), (Formats{FrameFormat::ply, FrameFormat::obj, FrameFormat::off}));
  EXPECT_EQ(parse_frame_formats("vtp,glb,usda").size(), 4u);
  for (const char* bad : {"", "ply,", "stl", "vtk", "ply,gltf", "usd", "PLY "})
    EXPECT_THROW(parse_frame_formats(bad), UsageError) << bad;
}

TEST(FrameNames, CountUpBeyondFourDigits) {
  EXPECT_EQ(frame_name(7, FrameFormat::ply), "frame_0007.ply");
  EXPECT_EQ(frame_name(123456, FrameFormat::off), "frame_123456.off");
  for (const int frame : {0, 9999, 10000, 2000000000}) EXPECT_TRUE(is_frame_name(frame_name(frame, FrameFormat::obj)));
}

}  // namespace
}  // namespace meniscus
