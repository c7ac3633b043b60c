// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/simulation/choose_model.h"

#include "meniscus/core/error.h"
#include "meniscus/frames/checkpoint_archive.h"
#include "meniscus/scene/read_scene.h"
#include "meniscus/simulation/oscillation.h"
#include "meniscus/simulation/simulation.h"
#include "meniscus/state/contact_line.h"

#include <gtest/gtest.h>
#include <Eigen/QR>

#include <cmath>

namespace meniscus {
namespace {

constexpr const char* accuracies[] = {"look", "shape", "motion"};

/// A ball in the air or, if `angle_deg` is given, a cap on a plate. `keys` are more keys of the scene.
Scene scene_of(const std::string& accuracy, const std::string& keys = "", double radius = 0.2, double edge = 0.04,
               int angle_deg = 0) {
  const std::string drop = angle_deg > 0 ? R"("shape": "cap", "on": "plate", "angle_deg": )" + std::to_string(angle_deg)
                                         : R"("shape": "sphere")";
  const std::string solid =
      R"({"name": "plate", "shape": "plane", "advancing_angle_deg": )" + std::to_string(std::max(angle_deg, 1)) + "}";
  return parse_scene("{\"model\": \"auto\", \"accuracy\": \"" + accuracy + "\", \"mesh\": {\"edge_min\": " +
                         std::to_string(edge) + ", \"edge_max\": " + std::to_string(3 * edge) + "}, " +
                         (angle_deg > 0 ? "\"solids\": [" + solid + "], " : "") + keys + "\"drops\": [{" + drop +
                         ", \"radius\": " + std::to_string(radius) + "}]}",
                     "s.json", "");
}

ModelChoice choice_of(const Scene& scene) { return Simulation(scene).choice(); }

TEST(ChooseModel, WithoutAnAccuracyTakesWhatTheSceneSays) {
  Scene scene = default_scene();
  scene.model = Level::paper;
  scene.volume_correction = VolumeCorrectionMethod::local;
  scene.substeps = 3;
  scene.solver.tolerance = 1e-5;
  const ModelChoice choice = choose_model(scene, {}, {});
  EXPECT_EQ(choice.level, Level::paper);
  EXPECT_EQ(choice.volume_correction, VolumeCorrectionMethod::local);
  EXPECT_EQ(choice.substeps, 3);
  EXPECT_EQ(choice.solver_tolerance, 1e-5);
  EXPECT_EQ(choice.why, "");
}

TEST(ChooseModel, InTheAirTheCheaperLevelIsEnoughUnlessMotionIsAskedFor) {
  for (const char* accuracy : {"look", "shape"}) {
    const ModelChoice choice = choice_of(scene_of(accuracy));
    EXPECT_EQ(choice.level, Level::calibrated) << accuracy;
    EXPECT_EQ(choice.substeps, 1) << accuracy;
    EXPECT_EQ(choice.volume_correction, VolumeCorrectionMethod::global) << "the one that keeps the volume";
    EXPECT_TRUE(choice.is_met) << choice.why;
  }
  const ModelChoice motion = choice_of(scene_of("motion"));
  EXPECT_EQ(motion.level, Level::pressure) << "calibrated loses more than 5 % of the amplitude a period at any step";
  EXPECT_EQ(motion.substeps, 4) << "omega dt = 1.12 at 1/240 s; 0.28 was measured to be enough, 0.56 not";
  EXPECT_TRUE(motion.is_met) << motion.why;
}

TEST(ChooseModel, OnSolidsNothingThatFailedInTheMapIsTaken) {
  for (const char* accuracy : accuracies) {
    const ModelChoice choice = choice_of(scene_of(accuracy, "", 0.2, 0.02, 90));
    EXPECT_EQ(choice.level, Level::pressure) << accuracy << ": " << choice.why;
    EXPECT_TRUE(choice.is_met) << choice.why;
  }
}

TEST(ChooseModel, ASolidThatNothingCanReachDoesNotCount) {
  const std::string far = R"("solids": [{"shape": "sphere", "center": [9, 0, 0], "radius": 1}], )";
  EXPECT_EQ(choice_of(scene_of("look", far)).level, Level::pressure) << "gravity may bring the drop there";
  EXPECT_EQ(choice_of(scene_of("look", far + R"("gravity": [0, 0, 0], )")).level, Level::calibrated);
}

TEST(ChooseModel, TimeStepsCountByThePhaseOfTheSmallestDrop) {
  const auto substeps = [](double radius, const std::string& keys) {
    return choice_of(scene_of("motion", keys, radius, 0.1 * radius)).substeps;
  };
  EXPECT_EQ(substeps(0.2, R"("time_step": 0.001, )"), 1);
  EXPECT_GE(substeps(0.1, ""), 11) << "2^1.5 times as many as for R = 0.2";
  EXPECT_EQ(substeps(0.2, R"("liquid": {"density": 64}, )"), 1) << "an eighth of the frequency";
}

TEST(ChooseModel, MeshesThatAreTooCoarseAreSaidToBe) {
  const ModelChoice coarse = choice_of(scene_of("shape", "", 0.3, 0.06, 90));
  EXPECT_FALSE(coarse.is_met) << "edges of 0.2 R: both levels are more than 1 % off at R = 0.3";
  EXPECT_NE(coarse.why.find("0.14 R would do"), std::string::npos) << coarse.why;
  EXPECT_FALSE(choice_of(scene_of("shape", "", 0.2, 0.1, 90)).is_met) << "coarser than anything measured";
  EXPECT_FALSE(choice_of(scene_of("shape", "", 0.2, 0.02, 10)).is_met) << "flatter than anything measured";
  EXPECT_TRUE(choice_of(scene_of("look", "", 0.3, 0.06, 90)).is_met) << "look asks for no shape";
}

TEST(ChooseModel, AScenesOwnKeysWin) {
  const ModelChoice choice = choice_of(
      scene_of("look", R"("volume_correction": "local_then_global", "substeps": 7, "solver": {"tolerance": 1e-8}, )"));
  EXPECT_EQ(choice.volume_correction, VolumeCorrectionMethod::local_then_global);
  EXPECT_EQ(choice.substeps, 7);
  EXPECT_EQ(choice.solver_tolerance, 1e-8);
  const ModelChoice too_few = choice_of(scene_of("motion", R"("substeps": 1, )"));
  EXPECT_EQ(too_few.substeps, 1);
  EXPECT_FALSE(too_few.is_met);
  EXPECT_NE(too_few.why.find("substeps are needed"), std::string::npos) << too_few.why;
  EXPECT_FALSE(choice_of(scene_of("look", R"("volume_correction": "none", )")).is_met) << "it loses volume";
}

TEST(ChooseModel, NeedsNoDropsNoTensionAndNoGravity) {
  EXPECT_TRUE(choose_model(scene_of("motion"), {}, {}).is_met);
  const std::string nothing = R"("liquid": {"surface_tension": 0}, "gravity": [0, 0, 0], )";
  for (const char* accuracy : accuracies) {
    EXPECT_EQ(choice_of(scene_of(accuracy, nothing)).substeps, 1);
    EXPECT_EQ(choice_of(scene_of(accuracy, nothing, 0.2, 0.02, 90)).substeps, 1);
  }
}

nlohmann::json state_of(const Simulation& simulation) {
  CheckpointWriter writer;
  writer("simulation", simulation);
  return writer.state()["simulation"];
}

TEST(ChooseModel, WhatIsChosenGivesTheBitsOfTheSceneThatSaysIt) {
  for (const char* accuracy : accuracies) {
    const Scene scene = scene_of(accuracy, "", 0.2, 0.04, 60);
    Simulation chosen(scene), said(with_choice(scene, chosen.choice()));
    for (int k = 0; k < 5; ++k) {
      chosen.step();
      said.step();
    }
    EXPECT_EQ(state_of(chosen)["drops"], state_of(said)["drops"]) << accuracy;
  }
}

TEST(ChooseModel, SubstepsAreStepsOfTheModel) {
  const Scene whole = scene_of("look", R"("substeps": 4, )", 0.2, 0.04, 60);
  Scene parts = with_choice(whole, choice_of(whole));
  parts.time_step /= 4;
  parts.substeps = 1;
  Simulation a(whole), b(parts);
  for (int k = 0; k < 3; ++k) {
    a.step();
    for (int j = 0; j < 4; ++j) b.step();
  }
  EXPECT_EQ(a.time(), b.time());
  EXPECT_EQ(state_of(a)["drops"], state_of(b)["drops"]);
}

/// A resumed run has other drops than those that the choice was made for.
TEST(ChooseModel, GoesThroughACheckpoint) {
  const Scene scene = scene_of("motion", R"("time_step": 0.002, )", 0.2, 0.04, 60);
  Simulation simulation(scene);
  for (int k = 0; k < 3; ++k) simulation.step();
  nlohmann::json state{{"simulation", state_of(simulation)}};
  const auto read = [&](Simulation& to) {
    CheckpointReader reader(state, "test");
    reader("simulation", to);
  };
  Simulation copy(scene, std::vector<Drop>{});
  ASSERT_NE(copy.choice().substeps, simulation.choice().substeps);
  read(copy);
  EXPECT_EQ(copy.choice().substeps, simulation.choice().substeps);
  EXPECT_EQ(copy.choice().why, simulation.choice().why);
  copy.step();
  simulation.step();
  EXPECT_EQ(state_of(copy), state_of(simulation));
  for (const auto& [key, wrong] : {std::pair{"level", 3}, {"substeps", 0}, {"substeps", 1001}}) {
    const auto kept = state;
    state["simulation"]["choice"][key] = wrong;
    Simulation damaged(scene, std::vector<Drop>{});
    EXPECT_THROW(read(damaged), FileError) << key;
    state = kept;
  }
}

TEST(ChooseModel, MotionIsWhatIsAskedFor) {
  Scene scene = scene_of("motion", R"("gravity": [0, 0, 0], "liquid": {"viscosity": 0}, )");
  scene.mesh = {0.02, 0.06, 0.5, 1};
  std::vector<Drop> drops;
  drops.push_back(oscillating_drop(8, 0.2, 0.05));
  Simulation simulation(scene, std::move(drops));
  std::vector<double> amplitudes;
  while (simulation.time() < 0.08) {
    amplitudes.push_back(mode_two_amplitude(simulation.drops().front()));
    simulation.step();
  }
  const auto [omega, kept] = fit_swing(amplitudes, scene.time_step);
  const AccuracyTarget target = target_of(Accuracy::motion);
  EXPECT_NEAR(omega / std::sqrt(8 * 72 / 0.008), 1, target.frequency_error);
  EXPECT_NEAR(kept, 1, target.amplitude_error);
}

/// Without gravity and at 90 degrees a drop at rest is half a ball.
TEST(ChooseModel, ShapeIsWhatIsAskedFor) {
  for (const double edge : {0.02, 0.04}) {
    Scene scene = scene_of("shape", R"("gravity": [0, 0, 0], )", 0.2, edge, 90);
    scene.drops[0].angle = 75 * pi / 180;
    Simulation simulation(scene);
    EXPECT_TRUE(simulation.choice().is_met) << simulation.choice().why;
    while (simulation.time() < 0.5) simulation.step();
    const Drop& drop = simulation.drops().front();
    double height = 0;
    for (std::uint32_t v = 0; v < drop.num_rows(); ++v)
      if (drop.connectivity().degree(v) > 0) height = std::max(height, drop.positions()(2, v));
    const double radius = std::cbrt(drop.target_volume() * 1.5 / pi);
    const double error = target_of(Accuracy::shape).rest_error;
    EXPECT_NEAR(height / radius, 1, error) << edge;
    EXPECT_NEAR(std::sqrt(wetted_area(drop) / pi) / radius, 1, error) << edge;
  }
}

}  // namespace
}  // namespace meniscus
