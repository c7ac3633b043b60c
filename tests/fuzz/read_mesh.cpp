// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/io/read_mesh.h"
#include "fuzz.h"
#include "meniscus/core/error.h"
#include "meniscus/io/write_mesh.h"
#include "meniscus/state/drop.h"

#include <cstring>
#include <sstream>

/// One of the mesh readers: MENISCUS_FUZZ_FORMAT says which.
namespace meniscus {
namespace {

constexpr MeshFormat format = MeshFormat::MENISCUS_FUZZ_FORMAT;

bool is_same(const std::vector<std::array<double, 3>>& a, const std::vector<std::array<double, 3>>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
}

/// What a reader lets through can be used, and what PLY holds comes back.
void check(const MeshData& data) {
  for (const auto& triangle : data.triangles)
    for (const auto v : triangle) fuzz::require(v < data.points.size());
  for (const auto& attribute : data.attributes) fuzz::require(attribute.values.size() == data.points.size());
  fuzz::require(data.source_face.empty() || data.source_face.size() == data.triangles.size());
  try {
    std::stringstream file;
    write_mesh(file, MeshFormat::ply, data);
    const MeshData again = read_mesh(file, MeshFormat::ply, "written");
    fuzz::require(is_same(data.points, again.points) && data.triangles == again.triangles);
  } catch (const FileError&) {  // an attribute's name may be none that PLY can hold
  }
  try {
    to_drops(data);
  } catch (const GeometryError&) {
  }
}

}  // namespace
}  // namespace meniscus

void meniscus::fuzz::run(std::string_view input) {
  std::istringstream stream{std::string(input)};
  MeshData data;
  try {
    data = read_mesh(stream, format, "fuzz");
  } catch (const FileError&) {
    return;
  }
  check(data);
}
