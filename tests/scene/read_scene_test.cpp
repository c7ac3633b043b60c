// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/scene/read_scene.h"

#include "scene/scene_test_helpers.h"

#include <filesystem>

namespace meniscus::test {
namespace {

TEST(ReadScene, FillsInTheDefaults) {
  const Scene scene = parse(R"({"drops": [{"shape": "sphere", "radius": 0.3}], "solids": [{"shape": "plane"}]})");
  EXPECT_EQ(scene.time_step, 1.0 / 240);
  EXPECT_EQ(scene.frames, 120);
  EXPECT_EQ(scene.steps_per_frame, 4);
  EXPECT_EQ(scene.gravity, Eigen::Vector3d(0, 0, -981));
  EXPECT_EQ(scene.liquid.surface_tension, 72);
  EXPECT_EQ(scene.model, Level::calibrated);
  EXPECT_EQ(scene.volume_correction, VolumeCorrectionMethod::global);
  EXPECT_EQ(scene.mesh.edge_min, 0.04);
  EXPECT_TRUE(scene.topology.merge && scene.topology.split && !scene.topology.self_merge);
  EXPECT_EQ(scene.solver.method, SolverMethod::automatic);
  ASSERT_EQ(scene.drops.size(), 1u);
  EXPECT_EQ(scene.drops[0].radius, 0.3);
  EXPECT_EQ(scene.drops[0].center, Eigen::Vector3d(0, 0, 0));
  ASSERT_EQ(scene.solids.size(), 1u);
  EXPECT_EQ(scene.solids[0].normal, Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(scene.solids[0].advancing_angle, pi / 2);
  EXPECT_TRUE(scene.solids[0].keys.empty());
}

TEST(ReadScene, ReadsEveryKey) {
  const Scene scene = parse(R"({ "$schema": "scene.schema.json",
    "time_step": 0.001, "frames": 7, "steps_per_frame": 2.0, "gravity": [1, -2.5, 3e1],
    "liquid": {"density": 2, "surface_tension": 30, "viscosity": 0.5}, "model": "paper",
    "paper": {"curvature_flow_coefficient": 0.1, "damping_rate": 0.3, "viscosity_coefficient": 0, "boundary_force": 2},
    "volume_correction": "local_then_global",
    "mesh": {"edge_min": 0.01, "edge_max": 0.03, "wetted_weight": 1},
    "topology": {"merge": false, "self_merge": true, "keep_air": true, "split": false},
    "solver": {"method": "cholesky", "tolerance": 1e-8},
    "solids": [
      {"name": "p", "shape": "plane", "point": [1,2,3], "normal": [0,1,0], "advancing_angle_deg": 60,
       "receding_angle_deg": 30, "friction_speed": 0.2, "velocity": [1,0,0]},
      {"shape": "sphere", "center": [0,0,-2], "radius": 1.5, "advancing_angle_deg": 120},
      {"shape": "box", "center": [0,0,-2], "size": [1,2,3], "rotate_deg": [0,90,0]},
      {"shape": "cylinder", "from": [0,0,0], "to": [0,0,5], "radius": 0.5},
      {"shape": "capsule", "from": [0,0,0], "to": [5,0,0], "radius": 0.25,
       "keys": [{"time": 0, "position": [0,0,0]}, {"time": 1, "position": [0,0,1]}]}],
    "drops": [
      {"shape": "ellipsoid", "semi_axes": [0.1,0.2,0.3], "rotate_deg": [0,0,180], "velocity": [0,0,-5]},
      {"shape": "box", "size": [1,0.3,0.3], "angular_velocity": [0,0,2]},
      {"shape": "cap", "on": "p", "radius": 0.2, "angle_deg": 45},
      {"shape": "cap", "on": "p", "radius": 0.1, "center": [1,0,0]}]})");
  EXPECT_EQ(scene.frames, 7);
  EXPECT_EQ(scene.steps_per_frame, 2);
  EXPECT_EQ(scene.gravity, Eigen::Vector3d(1, -2.5, 30));
  EXPECT_EQ(scene.liquid.density, 2);
  EXPECT_EQ(scene.liquid.viscosity, 0.5);
  EXPECT_EQ(scene.model, Level::paper);
  EXPECT_EQ(scene.paper.boundary_force, 2);
  EXPECT_EQ(scene.paper.viscosity_coefficient, 0);
  EXPECT_EQ(scene.volume_correction, VolumeCorrectionMethod::local_then_global);
  EXPECT_EQ(scene.mesh.wetted_weight, 1);
  EXPECT_FALSE(scene.topology.merge || scene.topology.split);
  EXPECT_TRUE(scene.topology.self_merge && scene.topology.keep_air);
  EXPECT_EQ(scene.solver.method, SolverMethod::cholesky);
  EXPECT_EQ(scene.solver.tolerance, 1e-8);
  ASSERT_EQ(scene.solids.size(), 5u);
  EXPECT_EQ(scene.solids[0].name, "p");
  EXPECT_DOUBLE_EQ(scene.solids[0].advancing_angle, pi / 3);
  EXPECT_DOUBLE_EQ(scene.solids[0].receding_angle, pi / 6);
  EXPECT_EQ(scene.solids[0].velocity, Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(scene.solids[1].shape, SolidShape::sphere);
  EXPECT_EQ(scene.solids[1].receding_angle, scene.solids[1].advancing_angle);  // follows if not given
  EXPECT_DOUBLE_EQ(scene.solids[2].rotation.y(), pi / 2);
  EXPECT_EQ(scene.solids[3].to, Eigen::Vector3d(0, 0, 5));
  ASSERT_EQ(scene.solids[4].keys.size(), 2u);
  EXPECT_EQ(scene.solids[4].keys[1].position, Eigen::Vector3d(0, 0, 1));
  ASSERT_EQ(scene.drops.size(), 4u);
  EXPECT_EQ(scene.drops[0].semi_axes, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_DOUBLE_EQ(scene.drops[0].rotation.z(), pi);
  EXPECT_EQ(scene.drops[1].angular_velocity, Eigen::Vector3d(0, 0, 2));
  EXPECT_DOUBLE_EQ(scene.drops[2].angle.value(), pi / 4);
  EXPECT_FALSE(scene.drops[3].angle.has_value());
}

TEST(ReadScene, TakesCommentsAndAByteOrderMark) {
  EXPECT_EQ(parse("\xEF\xBB\xBF// one\n" + with_drop(R"(/* two "frames": 5 */ "frames": 6)") + "// end").frames, 6);
}

TEST(ReadScene, ExampleScenesAreSound) {
  int num_scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(MENISCUS_DATA_DIR) + "/scenes")) {
    if (entry.path().extension() != ".json") continue;
    ++num_scenes;
    try {
      const Scene scene = read_scene(entry.path());
      EXPECT_FALSE(scene.drops.empty() && scene.sources.empty());
      EXPECT_EQ(scene.file, entry.path());
      for (const DropSpec& drop : scene.drops) {
        EXPECT_TRUE(drop.shape != DropShape::mesh || std::filesystem::exists(scene.locate(drop.file)));
      }
    } catch (const SceneError& error) {
      ADD_FAILURE() << error.what();
    }
  }
  EXPECT_GE(num_scenes, 5);
}

TEST(ReadScene, FilesThatCannotBeRead) {
  EXPECT_THROW(read_scene("no_such_scene.json"), FileError);
  EXPECT_THROW(read_scene(MENISCUS_DATA_DIR), FileError);
}

TEST(ReadScene, AFilesNameIsInItsMessages) {
  const auto path = std::filesystem::temp_directory_path() / "meniscus_read_scene_test.json";
  std::ofstream(path) << "{\n}";
  try {
    read_scene(path);
    ADD_FAILURE();
  } catch (const SceneError& error) {
    EXPECT_EQ(std::string(error.what()),
              path.string() + ":1:1: missing \"drops\" (a list of objects), and there are no \"sources\"");
  }
  std::filesystem::remove(path);
}

TEST(ReadScene, TheModelAutoHasAnAccuracyAndKnowsWhatIsGiven) {
  EXPECT_FALSE(parse(with_drop("")).accuracy.has_value());
  EXPECT_EQ(parse(with_drop(R"("model": "auto")")).accuracy, Accuracy::shape);
  for (const char* keys : {R"("model": "auto", "accuracy": "motion")", R"("accuracy": "motion", "model": "auto")"})
    EXPECT_EQ(parse(with_drop(keys)).accuracy, Accuracy::motion) << keys;
  const Scene bare = parse(with_drop(R"("model": "auto", "solver": {})"));
  EXPECT_FALSE(bare.given.volume_correction || bare.given.solver_method || bare.given.solver_tolerance ||
               bare.given.substeps);
  const Scene given = parse(with_drop(
      R"("model": "auto", "volume_correction": "none", "substeps": 3, "solver": {"tolerance": 1e-8, "method": "auto"})"));
  EXPECT_TRUE(given.given.volume_correction && given.given.solver_method && given.given.solver_tolerance &&
              given.given.substeps);
  EXPECT_EQ(given.substeps, 3);
}

}  // namespace
}  // namespace meniscus::test
