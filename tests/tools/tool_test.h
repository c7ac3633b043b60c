// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/mesh_data.h"
#include "meniscus/geometry/shapes.h"
#include "meniscus/io/read_file.h"
#include "meniscus/io/read_mesh.h"
#include "meniscus/io/write_mesh.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace meniscus {

namespace fs = std::filesystem;
using nlohmann::json;

/// What a run of the program gave.
struct Outcome {
  int code;
  std::string out, err;
};

/// A temporary directory in which the program runs.
class ToolTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "meniscus_tools_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    directory_ = name;
    fs::create_directory(directory_ / "logs");
  }
  void TearDown() override { fs::remove_all(directory_); }

  /// Runs a shell command in the directory; $MENISCUS is the program.
  Outcome shell(const std::string& command) const {
    const std::string line = "cd '" + directory_.string() + "' && MENISCUS='" MENISCUS_TOOL "'; { " + command +
                             "; } > logs/out 2> logs/err < /dev/null";
    const int status = std::system(line.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), text("logs/out"), text("logs/err")};
  }
  Outcome tool(const std::string& arguments) const { return shell("\"$MENISCUS\" " + arguments); }

  fs::path path(const std::string& name) const { return directory_ / name; }
  std::string text(const std::string& name) const { return read_file(path(name)); }
  json report(const std::string& name) const { return json::parse(text(name)); }
  MeshData mesh(const std::string& name) const { return read_mesh(path(name)); }
  void write(const std::string& name, const std::string& contents) const {
    std::ofstream(path(name), std::ios::binary) << contents;
  }
  void write(const std::string& name, const Mesh& mesh) const { write_mesh(path(name), to_mesh_data(mesh)); }

  /// The names in a directory, sorted; without the logs.
  std::vector<std::string> names(const std::string& directory = ".") const {
    std::vector<std::string> all;
    for (const auto& entry : fs::directory_iterator(path(directory)))
      if (entry.path().filename() != "logs") all.push_back(entry.path().filename().string());
    std::sort(all.begin(), all.end());
    return all;
  }

  fs::path directory_;
};

inline bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

inline Mesh sphere(double radius = 0.2, double edge = 0.06) {
  return make_sphere(Eigen::Vector3d::Zero(), radius, edge);
}

/// A sphere without its first triangle.
inline MeshData open_sphere() {
  MeshData data = to_mesh_data(sphere());
  data.triangles.erase(data.triangles.begin());
  return data;
}

/// Two meshes in one.
inline MeshData joined(const Mesh& a, const Mesh& b) {
  MeshData data = to_mesh_data(a);
  const MeshData other = to_mesh_data(b);
  const auto first = static_cast<std::uint32_t>(data.points.size());
  data.points.insert(data.points.end(), other.points.begin(), other.points.end());
  for (const auto& [i, j, k] : other.triangles) data.triangles.push_back({first + i, first + j, first + k});
  return data;
}

/// The volume, by the divergence theorem.
inline double volume_of(const MeshData& data) {
  double volume = 0;
  for (const auto& triangle : data.triangles) {
    const Eigen::Vector3d a(data.points[triangle[0]].data()), b(data.points[triangle[1]].data()),
        c(data.points[triangle[2]].data());
    volume += a.x() * (b.y() * c.z() - b.z() * c.y()) / 6 + a.y() * (b.z() * c.x() - b.x() * c.z()) / 6 +
              a.z() * (b.x() * c.y() - b.y() * c.x()) / 6;
  }
  return volume;
}

inline void expect_check_fields(const json& file) {
  for (const char* field :
       {"file", "vertices", "faces", "components", "genus", "closed", "manifold", "outward", "self_intersecting",
        "bounds_volume", "sound", "volume", "area", "edge_length", "angle_deg", "defects"})
    EXPECT_TRUE(file.contains(field)) << field;
  for (const char* field : {"min", "mean", "max"}) EXPECT_TRUE(file["edge_length"].contains(field)) << field;
  for (const char* field : {"min", "max"}) EXPECT_TRUE(file["angle_deg"].contains(field)) << field;
}

inline void expect_report_fields(const json& report, const std::vector<std::string>& counts) {
  EXPECT_EQ(report["status"], "ok");
  ASSERT_FALSE(report["inputs"].empty());
  ASSERT_FALSE(report["outputs"].empty());
  for (const auto& file : report["inputs"]) expect_check_fields(file);
  for (const auto& file : report["outputs"]) expect_check_fields(file);
  EXPECT_TRUE(report["seconds"].is_number());
  for (const std::string& count : counts) EXPECT_TRUE(report.contains(count)) << count;
}

}  // namespace meniscus
