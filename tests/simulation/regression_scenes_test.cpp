// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/scene/read_scene.h"
#include "meniscus/simulation/simulation.h"
#include "meniscus/state/judge.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace meniscus {
namespace {

/// Scenes that scripts/soak drew and that once failed, cut down to what fails: data/regressions/<symptom>.json.
class FailedScenes : public testing::TestWithParam<std::string> {};

TEST_P(FailedScenes, StaySoundAndLoseNothing) {
  const Scene scene = read_scene(MENISCUS_DATA_DIR "/regressions/" + GetParam() + ".json");
  Simulation simulation(scene);
  double there = simulation.target_volume();
  for (int n = 1; n <= scene.frames * scene.steps_per_frame; ++n) {
    there += simulation.step().volume_added;
    for (const Drop& drop : simulation.drops())
      ASSERT_EQ(judge::defect(drop), "") << "drop " << drop.id() << ", step " << n;
    ASSERT_NEAR(simulation.target_volume(), there, 1e-9 * there) << "step " << n;
  }
  EXPECT_NEAR(simulation.volume(), there, 0.01 * there);
}

INSTANTIATE_TEST_SUITE_P(
    Regressions, FailedScenes,
    testing::Values("refinement_without_end", "top_falls_on_wetted_area", "speck_knots", "lift_adds_volume",
                    "pressure_film_sinks", "source_fills_with_a_rush", "speck_blows_up",
                    "film_comes_through_wetted_area", "wet_faces_lie_on_each_other", "drop_meets_source_from_behind",
                    "offset_pushes_film_through", "dewetting_lays_films_down", "wet_faces_bend",
                    "convex_solid_through_film", "sheets_meet", "drop_stretches", "volume_after_remeshing",
                    "stream_hits_drop", "source_dries", "disc_thins", "sheets_touch_on_moving_plane",
                    "fed_piece_loses_speck", "jet_evens_out_through_disc", "solid_bulges_into_film",
                    "union_shuts_in_a_speck", "curtain_in_tatters", "knot_is_hurried", "sheets_do_not_bear_a_shift",
                    "liquid_runs_off_disc", "free_points_on_shared_plane", "drop_passes_disc_from_behind",
                    "mending_turns_box", "wetted_vertex_through_line", "vertex_stopped_at_disc"),
    [](const auto& scene) { return scene.param; });

/// Parts of a contact line that meet become one: then nothing crosses any more, and nothing has to be taken back.
class Slits : public testing::TestWithParam<std::string> {};

TEST_P(Slits, Close) {
  const Scene scene = read_scene(MENISCUS_DATA_DIR "/regressions/" + GetParam() + ".json");
  Simulation simulation(scene);
  for (int n = 1; n <= scene.frames; ++n) {
    const StepReport report = simulation.step();
    for (const Drop& drop : simulation.drops()) ASSERT_EQ(judge::defect(drop), "") << "step " << n;
    if (n > 20) {
      EXPECT_EQ(report.taken_back, 0u) << "step " << n;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Regressions, Slits, testing::Values("slit_beside_island", "slit_under_roof"),
                         [](const auto& scene) { return scene.param; });

}  // namespace
}  // namespace meniscus
