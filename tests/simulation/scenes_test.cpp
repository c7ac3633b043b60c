// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/scene/read_scene.h"
#include "meniscus/simulation/simulation.h"
#include "support/judge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

namespace meniscus {
namespace {

std::vector<std::filesystem::path> scene_files() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(MENISCUS_DATA_DIR "/scenes"))
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

class EachScene : public testing::TestWithParam<std::filesystem::path> {};

/// bench_scenes runs them to the end.
TEST_P(EachScene, StartsSoundAndKeepsItsVolume) {
  Simulation simulation(read_scene(GetParam()));
  double expected = simulation.target_volume();
  for (int n = 0; n < 6; ++n) expected += simulation.step().volume_added;
  EXPECT_NEAR(simulation.target_volume(), expected, 1e-12 * (1 + expected));
  EXPECT_NEAR(simulation.volume(), expected, 0.02 * expected);
  ASSERT_FALSE(simulation.drops().empty());
  for (const Drop& drop : simulation.drops()) EXPECT_EQ(judge::defect(drop.mesh()), "") << drop.id();
}

INSTANTIATE_TEST_SUITE_P(Data, EachScene, testing::ValuesIn(scene_files()),
                         [](const auto& scene) { return scene.param.stem().string(); });

}  // namespace
}  // namespace meniscus
