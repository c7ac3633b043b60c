// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/core/mesh_data.h"

#include "meniscus/core/error.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace meniscus {
namespace {

MeshData tetrahedron() {
  MeshData data;
  data.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  data.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  return data;
}

/// A second tetrahedron that shares `shared` vertices (the first ones) with the first.
MeshData two_tetrahedra(std::uint32_t shared) {
  MeshData data = tetrahedron();
  const auto row = [&](std::uint32_t v) { return v < shared ? v : v + 4 - shared; };
  for (std::uint32_t v = shared; v < 4; ++v) data.points.push_back({-1.0 - v, -2.0, 0.5 * v});
  for (const auto& [a, b, c] : tetrahedron().triangles) data.triangles.push_back({row(a), row(b), row(c)});
  return data;
}

TEST(MeshData, RoundTripKeepsPointsTrianglesAndAttributes) {
  MeshData data = tetrahedron();
  data.attributes.push_back({"heat", ScalarType::float32, {1, 2, 3, 4}});
  const MeshData back = to_mesh_data(to_mesh(data), data.attributes);
  EXPECT_EQ(back.points, data.points);
  ASSERT_EQ(back.triangles.size(), 4u);
  for (std::size_t t = 0; t < 4; ++t) {
    auto triangle = back.triangles[t];
    while (triangle[0] != data.triangles[t][0]) std::rotate(triangle.begin(), triangle.begin() + 1, triangle.end());
    EXPECT_EQ(triangle, data.triangles[t]);
  }
  ASSERT_NE(back.attribute("heat"), nullptr);
  EXPECT_EQ(back.attribute("heat")->values, data.attributes[0].values);
}

TEST(MeshData, OpenMeshesPass) {
  MeshData data = tetrahedron();
  data.triangles.pop_back();
  EXPECT_EQ(to_mesh(data).number_of_faces(), 3u);
}

TEST(MeshData, PinchedVertexIsNamed) {
  try {
    to_mesh(two_tetrahedra(1));
    FAIL();
  } catch (const GeometryError& error) {
    EXPECT_EQ(error.vertices(), std::vector<std::size_t>{0});
    EXPECT_NE(std::string(error.what()).find("pinched"), std::string::npos);
  }
}

TEST(MeshData, EdgeWithFourFacesIsNamed) {
  try {
    to_mesh(two_tetrahedra(2));
    FAIL();
  } catch (const GeometryError& error) {
    EXPECT_EQ(error.faces().size(), 2u);
    EXPECT_EQ(error.vertices().size(), 2u);
  }
}

TEST(MeshData, NeighboursThatDisagreeOnTheOutsideAreNamed) {
  MeshData data = tetrahedron();
  std::swap(data.triangles[2][0], data.triangles[2][1]);
  EXPECT_THROW(to_mesh(data), GeometryError);
}

TEST(MeshData, BadIndicesAreNamedAsTheFileCountsFaces) {
  MeshData data = tetrahedron();
  data.source_face = {0, 0, 7, 8};
  data.triangles[2][1] = 99;
  try {
    to_mesh(data);
    FAIL();
  } catch (const GeometryError& error) {
    EXPECT_EQ(error.faces(), std::vector<std::size_t>{7});
  }
  data.triangles[2] = {1, 1, 2};
  EXPECT_THROW(to_mesh(data), GeometryError);
}

}  // namespace
}  // namespace meniscus
