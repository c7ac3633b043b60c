// SPDX-License-Identifier: GPL-3.0-or-later
#include "page_scene.h"

#include "meniscus/core/error.h"
#include "meniscus/io/read_file.h"
#include "meniscus/io/read_mesh.h"

#include <Eigen/Geometry>

namespace meniscus::tools {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

constexpr double degree = 3.14159265358979323846 / 180;

Vector3d vector(const Json& solid, const char* key) {
  const auto xyz = solid.at(key).get<std::array<double, 3>>();
  return {xyz[0], xyz[1], xyz[2]};
}

/// A solid's mesh as the scene places it: scaled and turned about the origin, then moved.
MeshData placed_mesh(const Json& solid, const fs::path& file) {
  MeshData data = read_mesh(file);
  const Vector3d angle = degree * vector(solid, "rotate_deg"), translation = vector(solid, "translate");
  const double scale = solid.at("scale").get<double>();
  const Eigen::Matrix3d turn =
      (Eigen::AngleAxisd(angle.z(), Vector3d::UnitZ()) * Eigen::AngleAxisd(angle.y(), Vector3d::UnitY()) *
       Eigen::AngleAxisd(angle.x(), Vector3d::UnitX()))
          .toRotationMatrix();
  for (auto& point : data.points) {
    Eigen::Map<Vector3d> x(point.data());
    x = (turn * (scale * x) + translation).eval();
  }
  return data;
}

/// Where a file that a scene names is now; nothing if it is gone.
std::optional<fs::path> find(const fs::path& named, const fs::path& scene_directory, const fs::path& run) {
  for (const fs::path& directory : {scene_directory, run})
    if (fs::exists(directory / named)) return directory / named;
  return std::nullopt;
}

PageScene to_page(const Json& run, const fs::path& directory, const Console& console) {
  const Json& resolved = run.at("resolved_scene");
  const fs::path scene_directory = fs::path(run.at("scene").get<std::string>()).parent_path();
  PageScene scene;
  for (const Json& solid : resolved.value("solids", Json::array())) {
    PageSolid shown{solid, std::nullopt};
    if (solid.at("shape") == "mesh") {
      const fs::path named = solid.at("file").get<std::string>();
      const std::optional<fs::path> file = find(named, scene_directory, directory);
      if (!file) {
        console.say(fmt::format("warning: {}: not found, so the page does not show this solid", named.string()));
        continue;
      }
      shown.mesh = placed_mesh(solid, *file);
    }
    scene.solids.push_back(std::move(shown));
  }
  scene.sources = resolved.value("sources", Json::array());
  return scene;
}

}  // namespace

PageScene read_run_scene(const fs::path& directory, const Console& console) {
  const fs::path file = directory / "run.json";
  if (!fs::exists(file)) return {};
  try {
    return to_page(Json::parse(read_file(file)), directory, console);
  } catch (const Json::exception& error) {
    throw FileError(
        fmt::format("{}: is not what evolve writes ({}); run the scene again", file.string(), error.what()));
  }
}

}  // namespace meniscus::tools
