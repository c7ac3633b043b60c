// SPDX-License-Identifier: GPL-3.0-or-later
#include "io_test_helpers.h"

#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <set>

namespace meniscus::test {
namespace {

constexpr MeshFormat kFormats[] = {MeshFormat::ply, MeshFormat::off, MeshFormat::obj, MeshFormat::stl};

template <class Number, class Bits>
rc::Gen<double> finite_bits() {
  return rc::gen::map(rc::gen::suchThat(rc::gen::map(rc::gen::resize(rc::kNominalSize, rc::gen::arbitrary<Bits>()),
                                                     [](Bits bits) {
                                                       Number x;
                                                       std::memcpy(&x, &bits, sizeof x);
                                                       return x;
                                                     }),
                                        [](Number x) { return std::isfinite(x); }),
                      [](Number x) { return static_cast<double>(x); });
}

/// Any finite double: special values, small ones and random bits (subnormals too).
rc::Gen<double> any_double() {
  return rc::gen::oneOf(rc::gen::element(0.0, -0.0, 0.1, 1e-310, 5e-324, 1.7976931348623157e308, -1.0 / 3),
                        rc::gen::arbitrary<double>(), finite_bits<double, std::uint64_t>());
}

template <class Integer>
rc::Gen<double> any_integer() {
  using Limits = std::numeric_limits<Integer>;
  return rc::gen::oneOf(rc::gen::element<double>(Limits::min(), Limits::max()),
                        rc::gen::map(rc::gen::arbitrary<Integer>(), [](Integer i) { return static_cast<double>(i); }));
}

rc::Gen<double> any_value(ScalarType type) {
  switch (type) {
    case ScalarType::int8:
      return any_integer<std::int8_t>();
    case ScalarType::uint8:
      return any_integer<std::uint8_t>();
    case ScalarType::int16:
      return any_integer<std::int16_t>();
    case ScalarType::uint16:
      return any_integer<std::uint16_t>();
    case ScalarType::int32:
      return any_integer<std::int32_t>();
    case ScalarType::uint32:
      return any_integer<std::uint32_t>();
    case ScalarType::float32:
      return finite_bits<float, std::uint32_t>();
    case ScalarType::float64:
      break;
  }
  return any_double();
}

constexpr ScalarType kTypes[] = {ScalarType::int8,  ScalarType::uint8,  ScalarType::int16,   ScalarType::uint16,
                                 ScalarType::int32, ScalarType::uint32, ScalarType::float32, ScalarType::float64};

/// Any soup of at least one point, with an attribute of each type and comments.
MeshData any_mesh() {
  MeshData data;
  data.points = *rc::gen::nonEmpty(
      rc::gen::container<std::vector<std::array<double, 3>>>(rc::gen::container<std::array<double, 3>>(any_double())));
  const auto n = static_cast<std::uint32_t>(data.points.size());
  data.triangles = *rc::gen::container<std::vector<std::array<std::uint32_t, 3>>>(
      rc::gen::container<std::array<std::uint32_t, 3>>(rc::gen::inRange<std::uint32_t>(0, n)));
  for (const auto type : kTypes)
    data.attributes.push_back({"a" + std::to_string(static_cast<int>(type)), type,
                               *rc::gen::container<std::vector<double>>(n, any_value(type))});
  data.comments =
      *rc::gen::container<std::vector<std::string>>(rc::gen::container<std::string>(rc::gen::inRange<char>(' ', '~')));
  return data;
}

void check_ply_round_trip(bool binary) {
  const MeshData data = any_mesh();
  const MeshData back = parse(MeshFormat::ply, print(MeshFormat::ply, data, binary));
  RC_ASSERT(same_bits(back.points, data.points));
  RC_ASSERT(back.triangles == data.triangles);
  RC_ASSERT(back.comments == data.comments);
  RC_ASSERT(back.source_face.empty());
  RC_ASSERT(back.attributes.size() == data.attributes.size());
  for (std::size_t i = 0; i < data.attributes.size(); ++i) {
    RC_ASSERT(back.attributes[i].name == data.attributes[i].name);
    RC_ASSERT(back.attributes[i].type == data.attributes[i].type);
    RC_ASSERT(same_bits(back.attributes[i].values, data.attributes[i].values));
  }
}

RC_GTEST_PROP(RoundTrip, BinaryPlyKeepsEverything, ()) { check_ply_round_trip(true); }
RC_GTEST_PROP(RoundTrip, AsciiPlyKeepsEverything, ()) { check_ply_round_trip(false); }

RC_GTEST_PROP(RoundTrip, OffAndObjKeepPointsAndTriangles, ()) {
  const MeshData data = any_mesh();
  for (const auto format : {MeshFormat::off, MeshFormat::obj}) {
    const MeshData back = parse(format, print(format, data));
    RC_ASSERT(same_bits(back.points, data.points));
    RC_ASSERT(back.triangles == data.triangles);
  }
}

std::vector<std::array<double, 3>> corners(const MeshData& data, bool as_float32) {
  std::vector<std::array<double, 3>> found;
  for (const auto& triangle : data.triangles)
    for (const auto v : triangle) {
      auto point = data.points[v];
      for (double& x : point) x = (as_float32 ? static_cast<double>(static_cast<float>(x)) : x) + 0.0;
      found.push_back(point);
    }
  return found;
}

RC_GTEST_PROP(RoundTrip, AsciiStlKeepsTheCornersBits, ()) {
  const MeshData data = any_mesh();
  const MeshData back = parse(MeshFormat::stl, print(MeshFormat::stl, data, false));
  RC_ASSERT(same_bits(corners(back, false), corners(data, false)));
}

RC_GTEST_PROP(RoundTrip, BinaryStlKeepsTheCornersAsFloat32, ()) {
  MeshData data = any_mesh();
  for (auto& point : data.points)
    for (double& x : point) x = *finite_bits<float, std::uint32_t>();
  const MeshData back = parse(MeshFormat::stl, print(MeshFormat::stl, data, true));
  RC_ASSERT(same_bits(corners(back, false), corners(data, true)));
  const std::set<std::array<double, 3>> distinct(back.points.begin(), back.points.end());
  RC_ASSERT(distinct.size() == back.points.size());
}

TEST(RoundTrip, NonFiniteCoordinatesPass) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  MeshData data = tetrahedron();
  data.points[1] = {inf, -inf, nan};
  for (const auto format : kFormats)
    for (const bool binary : {false, true}) {
      const MeshData back = parse(format, print(format, data, binary));
      const auto it = std::find_if(back.points.begin(), back.points.end(), [&](const auto& p) { return p[0] == inf; });
      ASSERT_NE(it, back.points.end()) << format_name(format);
      EXPECT_EQ((*it)[1], -inf);
      EXPECT_TRUE(std::isnan((*it)[2]));
      EXPECT_EQ(back.triangles.size(), 4U);
    }
}

TEST(RoundTrip, EmptyMeshPassesWhereTheFormatCanSayIt) {
  for (const auto format : {MeshFormat::ply, MeshFormat::off, MeshFormat::stl})
    for (const bool binary : {false, true}) {
      const MeshData back = parse(format, print(format, MeshData{}, binary));
      EXPECT_TRUE(back.points.empty() && back.triangles.empty());
    }
}

TEST(RoundTrip, FilesOfEachFormat) {
  const TemporaryDirectory directory;
  for (const char* name : {"a.ply", "a.OFF", "a.obj", "a.Stl"}) {
    write_mesh(directory / name, tetrahedron());
    const MeshData back = read_mesh(directory / name);
    EXPECT_EQ(back.points.size(), 4U);
    EXPECT_EQ(corners(back, false), corners(tetrahedron(), false));
  }
}

TEST(Format, IsNamedByTheExtensionInEitherCase) {
  EXPECT_EQ(format_of("dir.off/drop.PLY"), MeshFormat::ply);
  EXPECT_EQ(format_of("a.b.off"), MeshFormat::off);
  for (const auto format : kFormats) EXPECT_EQ(parse_format(format_name(format)), format);
  for (const char* path : {"drop", "drop.", "drop.vtk", "drop.ply/", ".ply"}) EXPECT_THROW(format_of(path), UsageError);
  EXPECT_THROW(parse_format("vtk"), UsageError);
}

}  // namespace
}  // namespace meniscus::test
