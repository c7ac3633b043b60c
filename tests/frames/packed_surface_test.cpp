// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/frames/packed_surface.h"

#include "meniscus/core/error.h"
#include "meniscus/geometry/shapes.h"
#include "meniscus/state/drop.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <zlib.h>

#include <cmath>
#include <limits>

namespace meniscus {
namespace {

std::string inflated(const std::string& bytes, std::size_t size) {
  std::string out(size, '\0');
  uLongf length = size;
  EXPECT_EQ(::uncompress(reinterpret_cast<Bytef*>(out.data()), &length, reinterpret_cast<const Bytef*>(bytes.data()),
                         bytes.size()),
            Z_OK);
  out.resize(length);
  return out;
}

/// Reads what the header's words say, with no look at how it was written.
struct Reader {
  std::string bytes;
  std::size_t at = 0;
  unsigned byte() { return static_cast<unsigned char>(bytes.at(at++)); }
  long varint() {
    unsigned long value = 0, weight = 1;
    for (;;) {
      const unsigned b = byte();
      value += weight * (b % 128);
      if (b < 128) break;
      weight *= 128;
    }
    return value % 2 == 0 ? static_cast<long>(value / 2) : -static_cast<long>(value / 2) - 1;
  }
};

struct Surface {
  std::vector<std::array<double, 3>> points;
  std::vector<double> speed, contact, drop;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

Surface unpack(const PackedSurface& packed) {
  const std::size_t n = packed.num_vertices;
  Surface surface;
  surface.points.resize(n);
  Reader in{inflated(packed.vertices, 13 * n + 64)};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t v = 0, last = 0; v < n; ++v) {
      const unsigned high = static_cast<unsigned char>(in.bytes.at(2 * n * axis + v));
      const unsigned low = static_cast<unsigned char>(in.bytes.at(2 * n * axis + n + v));
      const unsigned zigzag = 256 * high + low;
      const unsigned difference = zigzag % 2 == 0 ? zigzag / 2 : 65536 - (zigzag / 2 + 1);
      last = (last + difference) % 65536;
      surface.points[v][axis] = packed.min[axis] + packed.step[axis] * static_cast<double>(last);
    }
  in.at = 6 * n;
  for (std::size_t v = 0; v < n; ++v) surface.speed.push_back(packed.speed * in.byte() / 255);
  for (std::size_t v = 0; v < n; ++v) surface.contact.push_back(in.byte());
  long drop = 0;
  for (std::size_t v = 0; v < n; ++v) surface.drop.push_back(static_cast<double>(drop += in.varint()));
  EXPECT_EQ(in.at, in.bytes.size());
  Reader corners{inflated(packed.triangles, 15 * std::size_t{packed.num_triangles} + 64)};
  long corner = 0;
  surface.triangles.resize(packed.num_triangles);
  for (auto& triangle : surface.triangles)
    for (auto& v : triangle) v = static_cast<std::uint32_t>(corner += corners.varint());
  EXPECT_EQ(corners.at, corners.bytes.size());
  return surface;
}

void expect_same(const MeshData& data, const PackedSurface& packed) {
  const Surface surface = unpack(packed);
  ASSERT_EQ(surface.points.size(), data.points.size());
  for (std::size_t v = 0; v < data.points.size(); ++v)
    for (std::size_t axis = 0; axis < 3; ++axis)
      ASSERT_NEAR(surface.points[v][axis], data.points[v][axis],
                  (0.5 + 1e-6) * packed.step[axis] + 1e-12 * std::abs(data.points[v][axis]));
  EXPECT_EQ(surface.triangles, data.triangles);
}

MeshData two_moving_drops() {
  std::vector<Drop> drops;
  drops.emplace_back(make_sphere({0, 0, 1}, 0.2, 0.1));
  drops.emplace_back(make_sphere({40, 0, -3}, 0.1, 0.05));
  drops[0].set_id(70000);
  drops[1].set_id(3);
  drops[1].velocities().row(1).setConstant(-7);
  drops[0].velocities().col(5) = Eigen::Vector3d(3, 4, 12);
  drops[0].contact()[2] = Contact::line;
  drops[1].contact()[1] = Contact::wetted;
  return to_mesh_data(drops);
}

TEST(PackedSurface, ReadsBackToHalfAStepAndTheSameTriangles) {
  const MeshData data = two_moving_drops();
  const PackedSurface packed = pack_surface(data);
  expect_same(data, packed);
  EXPECT_NEAR(packed.step[0], (40.1 + 0.2) / 65535, 1e-9);
  EXPECT_DOUBLE_EQ(packed.speed, 13);
  const Surface surface = unpack(packed);
  EXPECT_EQ(surface.drop, data.attribute("drop")->values);
  EXPECT_EQ(surface.contact, data.attribute("contact")->values);
  EXPECT_DOUBLE_EQ(surface.speed[5], 13);
  EXPECT_NEAR(surface.speed.back(), 7, 13.0 / 255 / 2);
}

TEST(PackedSurface, NoDropsAFlatOneAndOneWithoutAttributes) {
  expect_same({}, pack_surface({}));
  MeshData flat;
  flat.points = {{1, 2, 3}, {2, 2, 3}, {1, 2, 5}, {1, 2, 3}};
  flat.triangles = {{0, 1, 2}, {3, 2, 1}};
  const PackedSurface packed = pack_surface(flat);
  EXPECT_EQ(packed.step[1], 0);
  EXPECT_EQ(packed.speed, 0);
  expect_same(flat, packed);
  EXPECT_EQ(unpack(packed).contact, std::vector<double>(4, 0));
}

TEST(PackedSurface, WhatHasNoPlaceIsRefused) {
  MeshData data = two_moving_drops();
  data.points[3][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(pack_surface(data), GeometryError);
  data = two_moving_drops();
  data.attributes[0].values[0] = std::numeric_limits<double>::infinity();
  EXPECT_THROW(pack_surface(data), GeometryError);
  data = two_moving_drops();
  data.triangles[0][2] = 1000000;
  EXPECT_THROW(pack_surface(data), GeometryError);
}

RC_GTEST_PROP(PackedSurface, AnySoupReadsBack, ()) {
  const auto coordinate = [] { return 1e-3 * *rc::gen::inRange(-1000000, 1000000); };
  MeshData data;
  data.points.resize(static_cast<std::size_t>(*rc::gen::inRange(0, 40)));
  for (auto& [x, y, z] : data.points) x = coordinate(), y = coordinate(), z = coordinate();
  if (!data.points.empty()) data.triangles.resize(static_cast<std::size_t>(*rc::gen::inRange(0, 60)));
  for (auto& triangle : data.triangles)
    for (auto& corner : triangle)
      corner = *rc::gen::inRange<std::uint32_t>(0, static_cast<std::uint32_t>(data.points.size()));
  expect_same(data, pack_surface(data));
  RC_ASSERT(!testing::Test::HasFailure());
}

}  // namespace
}  // namespace meniscus
