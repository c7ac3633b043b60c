// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/core/error.h"
#include "meniscus/core/mesh_arrays.h"
#include "meniscus/frames/checkpoint_archive.h"
#include "meniscus/frames/checkpoint_file.h"
#include "meniscus/scene/read_scene.h"
#include "meniscus/simulation/simulation.h"
#include "support/judge.h"

#include <gtest/gtest.h>

namespace meniscus {
namespace {

nlohmann::json saved(const Simulation& simulation) {
  CheckpointWriter writer;
  writer("simulation", simulation);
  return writer.state();
}

/// Where two states differ first, or nothing.
std::string difference(const nlohmann::json& a, const nlohmann::json& b) {
  if (a == b) return {};
  const nlohmann::json changes = nlohmann::json::diff(a, b);
  const std::string path = changes[0]["path"];
  const nlohmann::json& list = a.at(nlohmann::json::json_pointer(path.substr(0, path.rfind('/'))));
  return path + (list.contains("name") ? " of " + list["name"].get<std::string>() : "");
}

/// A simulation from the bytes of a file.
Simulation restored(const Scene& scene, const std::string& bytes) {
  const nlohmann::json state = decode_checkpoint(bytes, "test");
  Simulation simulation(scene, std::vector<Drop>{});
  CheckpointReader reader(state, "test");
  reader("simulation", simulation);
  return simulation;
}

/// A scene of data/scenes, short and coarse enough for a test.
Scene scene_of(const std::filesystem::path& file, const std::vector<std::string>& settings = {}) {
  return read_scene(file, settings);
}

/// Steps a simulation on and a copy that went through a file, and asks for the same bytes each time.
void expect_same_way_on(const Scene& scene, int before, int after) {
  Simulation simulation(scene);
  for (int k = 0; k < before; ++k) simulation.step();
  Simulation copy = restored(scene, encode_checkpoint(saved(simulation)));
  ASSERT_EQ(difference(saved(copy), saved(simulation)), "");
  for (const Drop& drop : copy.drops()) EXPECT_EQ(judge::topology_defect(drop.mesh()), "");
  for (int k = 0; k < after; ++k) {
    simulation.step();
    copy.step();
    ASSERT_EQ(saved(copy), saved(simulation)) << "step " << k + 1 << " after the checkpoint";
  }
}

TEST(Checkpoint, EveryScenePlayedOnFromAFileGoesTheSameWayToTheBit) {
  for (const auto& entry : std::filesystem::directory_iterator(MENISCUS_DATA_DIR "/scenes")) {
    if (entry.path().extension() != ".json") continue;
    SCOPED_TRACE(entry.path().filename());
    expect_same_way_on(scene_of(entry.path()), 23, 12);
  }
}

/// A ball that is hit hard by a plate: remeshing leaves removed elements behind, and the paper's level cuts.
constexpr const char* impact = R"({
  "time_step": 0.0005, "mesh": { "edge_min": 0.03, "edge_max": 0.1 }, "model": "%MODEL%",
  "solver": { "method": "%METHOD%" },
  "solids": [ { "shape": "plane", "advancing_angle_deg": 60, "receding_angle_deg": 30 } ],
  "drops": [ { "shape": "ellipsoid", "center": [0,0,0.25], "semi_axes": [0.2,0.15,0.25], "velocity": [3,0,-60] },
             { "shape": "sphere", "center": [1,0,0.5], "radius": 0.1 } ]
})";

Scene impact_scene(const std::string& model, const std::string& method) {
  std::string text = impact;
  text.replace(text.find("%MODEL%"), 7, model);
  text.replace(text.find("%METHOD%"), 8, method);
  return parse_scene(text, "impact", "");
}

TEST(Checkpoint, RemovedElementsAndKeptFactorsGoAlong) {
  bool had_removed = false;
  for (const char* model : {"calibrated", "paper"})
    for (const char* method : {"auto", "cholesky"}) {
      SCOPED_TRACE(std::string(model) + " " + method);
      const Scene scene = impact_scene(model, method);
      for (int before : {1, 17, 40}) {
        Simulation simulation(scene);
        for (int k = 0; k < before; ++k) simulation.step();
        had_removed = had_removed || simulation.drops()[0].mesh().has_garbage();
        expect_same_way_on(scene, before, 10);
      }
    }
  EXPECT_TRUE(had_removed) << "this scene does not try what it is for";
}

TEST(Checkpoint, DamagedBytesAreRefused) {
  const std::string bytes = encode_checkpoint(saved(Simulation(impact_scene("calibrated", "auto"))));
  for (std::size_t length = 0; length < bytes.size(); length += 1 + bytes.size() / 97)
    EXPECT_THROW(decode_checkpoint(bytes.substr(0, length), "cut"), FileError) << length;
  for (std::size_t at = 0; at < bytes.size(); at += 1 + bytes.size() / 389) {
    std::string changed = bytes;
    changed[at] = static_cast<char>(changed[at] ^ 0x10);
    EXPECT_THROW(decode_checkpoint(changed, "changed"), FileError) << at;
  }
  EXPECT_THROW(decode_checkpoint(bytes + "x", "longer"), FileError);
  EXPECT_THROW(decode_checkpoint("meniscus checkpoint 1 0 00000000\n", "other version"), FileError);
}

TEST(Checkpoint, NestingHasALimit) {
  nlohmann::json deep = 1;
  for (int k = 0; k < 5000; ++k) deep = nlohmann::json::array({std::move(deep)});
  EXPECT_THROW(decode_checkpoint(encode_checkpoint(deep), "deep"), FileError);
}

/// Values of the right type that are wrong: whole files, so that no checksum hides them.
TEST(Checkpoint, MeshesThatAreNoneAreRefused) {
  const nlohmann::json good = saved(Simulation(impact_scene("calibrated", "auto")));
  const auto refused = [&](const char* what, auto damage) {
    nlohmann::json state = good;
    damage(state["simulation"]["drops"][0]);
    Simulation simulation(impact_scene("calibrated", "auto"), std::vector<Drop>{});
    CheckpointReader reader(state, "damaged");
    EXPECT_THROW(reader("simulation", simulation), FileError) << what;
  };
  for (const char* list : {"vertex_halfedge", "halfedges", "face_halfedge", "ring_starts"}) {
    refused(list, [&](auto& drop) { drop.erase(list); });
    refused(list, [&](auto& drop) { drop[list] = 3; });
    refused(list, [&](auto& drop) { drop[list].get_binary().resize(8); });
    refused(list, [&](auto& drop) { drop[list].get_binary()[5] = 0xff; });
    refused(list, [&](auto& drop) { drop[list].get_binary()[4] ^= 64; });
  }
  refused("removed_faces", [](auto& drop) { drop["removed_faces"] = nlohmann::json::binary({0, 0, 0, 0}); });
  refused("maps", [](auto& drop) { drop["maps"][0]["type"] = "float"; });
  refused("maps", [](auto& drop) { drop["maps"][1]["values"].get_binary().resize(8); });
  refused("maps", [](auto& drop) {
    for (auto& map : drop["maps"])
      if (map["name"] == "v:velocity") {
        map["type"] = "float64";
        map["values"].get_binary().resize(map["values"].get_binary().size() / 3);
      }
  });
  refused("id", [](auto& drop) { drop["id"] = std::int64_t{1} << 40; });
  refused("target_volume", [](auto& drop) { drop["target_volume"] = "much"; });
  refused("rest_time", [](auto& drop) { drop["rest_time"] = std::nan(""); });
}

/// A tetrahedron 0 1 2 3 whose edge 0-1 is slit and filled with vertices 4 and 5: closed, one fan a vertex, a sphere by
/// Euler's formula, but two edges join 0 and 1, and their rings name each other twice.
TEST(Checkpoint, AMeshOfTwoEdgesBetweenTheSameVerticesIsRefused) {
  struct Corner {
    std::uint32_t from, edge;
  };
  const Corner faces[][3] = {{{0, 0}, {1, 2}, {2, 3}},   {{0, 4}, {3, 5}, {1, 1}}, {{1, 5}, {3, 6}, {2, 2}},
                             {{0, 3}, {2, 6}, {3, 4}},   {{1, 0}, {0, 7}, {4, 8}}, {{0, 1}, {1, 9}, {5, 10}},
                             {{0, 10}, {5, 11}, {4, 7}}, {{5, 9}, {1, 8}, {4, 11}}};
  MeshArrays arrays;
  arrays.vertex_halfedge.resize(6);
  arrays.halfedges.resize(24);
  std::vector<bool> used(24, false);
  for (const auto& face : faces) {
    std::uint32_t half[3];
    for (int k = 0; k < 3; ++k) {
      half[k] = 2 * face[k].edge + (used[2 * face[k].edge] ? 1 : 0);
      used[half[k]] = true;
    }
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t target = face[(k + 1) % 3].from;
      arrays.halfedges[half[k]] = {target, static_cast<std::uint32_t>(arrays.face_halfedge.size()), half[(k + 1) % 3]};
      arrays.vertex_halfedge[target] = half[k];
    }
    arrays.face_halfedge.push_back(half[0]);
  }
  EXPECT_THROW(to_mesh(arrays), GeometryError);
}

}  // namespace
}  // namespace meniscus
