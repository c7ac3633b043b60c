// SPDX-License-Identifier: GPL-3.0-or-later
#include "io_test_helpers.h"

/// What each reader takes beyond what our writers write.
namespace meniscus::test {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;
using Points = std::vector<std::array<double, 3>>;

const Points kPoints{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
const Triangles kOneTriangle{{0, 1, 2}};

void expect_one_triangle(MeshFormat format, const std::string& text) {
  const MeshData data = parse(format, text);
  EXPECT_EQ(data.points, kPoints) << text;
  EXPECT_EQ(data.triangles, kOneTriangle) << text;
  EXPECT_TRUE(data.source_face.empty());
}

TEST(Off, TakesCommentsExtrasAndCountsAnywhere) {
  for (const char* text : {
           "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
           "OFF 3 1 3\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2",
           "OFF 3 1\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2\r\n\r\n",
           "\xEF\xBB\xBFOFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
           "# a\nOFF # b\n\n# c\n3 1 0# d\n0 0 0 # e\n\n  1 0 0\n\t0 1 0\n3 0 1 2 # f\n# g\n",
           "COFF\n3 1 0\n0 0 0 1 0 0 1\n1 0 0 1 0 0 1\n0 1 0 255 255 255 0\n3 0 1 2 0.5 0.5 0.5\n",
           "STCNOFF\n3 1 0\n0 0 0 0 0 1 1 1 1 1 0 0\n1 0 0 0 0 1 1 1 1 1 0 0\n0 1 0 0 0 1 1 1 1 1 0 0\n3 0 1 2\n",
           "NOFF\n3 1 0\n0 0 0 0 0 1\n1. .0 0e5 0 0 1\n+0 +1 -0e-3 0 0 1\n3 0 1 2\n",
       })
    expect_one_triangle(MeshFormat::off, text);
}

TEST(Obj, TakesEveryFormOfCornerAndContinuedLines) {
  for (const char* text : {
           "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
           "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf 1/1 2/1 3/1\n",
           "v 0 0 0 1.0\nv 1 0 0 1.0\nv 0 1 0 1.0\nf 1//1 2//1 3//1",
           "mtllib a\no b\ng c\nusemtl d\ns off\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1/1 2/1/1 3/-1/-1\nl 1 2\n",
           "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n",
           "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n",
           "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 \\\r\n2\\\r\n 3\r\n",
           "v 0 \\\n0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 \\\n",
           "# made in c:\\models\\\nv 0 0 0 # a\nv 1 0 0\nv 0 1 0\nf 1 2 3# b\n",
       })
    expect_one_triangle(MeshFormat::obj, text);
}

TEST(Obj, CountsNegativeIndicesFromWhereTheyStand) {
  const MeshData data =
      parse(MeshFormat::obj, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 0 0\nv 6 0 0\nv 5 1 0\nf -3 -2 -1\n");
  EXPECT_EQ(data.triangles, (Triangles{{0, 1, 2}, {3, 4, 5}}));
}

TEST(Obj, LineNumbersCountContinuedLines) {
  EXPECT_TRUE(has(parse_error(MeshFormat::obj, "v 0 \\\n0 0\nv 1 0 x\n"), "in:3: \"x\""));
}

TEST(Stl, TextOfSeveralSolidsInEitherCase) {
  const std::string facet =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 -0.0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
  expect_one_triangle(MeshFormat::stl, "solid\n" + facet + "endsolid\n");
  expect_one_triangle(MeshFormat::stl,
                      "\xEF\xBB\xBF SOLID a b\r\n FACET NORMAL 0 0 1\r\nOUTER LOOP\r\nVERTEX 0 0 0\r\n"
                      "VERTEX 1 0 0\r\nVERTEX 0 1 0\r\nENDLOOP\r\nENDFACET\r\nENDSOLID a b\r\n");
  const MeshData two = parse(MeshFormat::stl, "solid a\n" + facet + "endsolid a\nsolid b\n" + facet + "endsolid b\n");
  EXPECT_EQ(two.points, kPoints);
  EXPECT_EQ(two.triangles, (Triangles{{0, 1, 2}, {0, 1, 2}}));
}

TEST(Stl, BinaryMayBeginWithSolid) {
  std::string bytes = print(MeshFormat::stl, tetrahedron());
  ASSERT_EQ(bytes.size(), 84U + 4 * 50);
  bytes.replace(0, 20, "solid facet endsolid");
  EXPECT_EQ(parse(MeshFormat::stl, bytes).triangles.size(), 4U);
}

TEST(Stl, WritesOutwardUnitNormals) {
  const std::string text = print(MeshFormat::stl, tetrahedron(), false);
  EXPECT_TRUE(has(text, "facet normal 0 0 -1\n")) << text;
  EXPECT_TRUE(has(text, "facet normal 0.5773502691896")) << text;
}

TEST(Stl, RefusesToJoinPointsByRounding) {
  MeshData data = tetrahedron();
  data.points[1] = {1e-60, 0, 0};  // 0 in float32
  const std::string error = file_error([&] { print(MeshFormat::stl, data); });
  EXPECT_TRUE(has(error, "output: vertex 1 ")) << error;
  EXPECT_EQ(parse(MeshFormat::stl, print(MeshFormat::stl, data, false)).points.size(), 4U);
  data.points[1] = {1e60, 0, 0};
  EXPECT_TRUE(has(file_error([&] { print(MeshFormat::stl, data); }), "vertex 1: 1e+60 does not fit float32"));
}

template <class Number>
void append(std::string& out, Number value, bool is_big_endian) {
  std::string bytes(reinterpret_cast<const char*>(&value), sizeof value);
  if (is_big_endian) std::reverse(bytes.begin(), bytes.end());
  out += bytes;
}

/// All scalar types, in odd order, with lists, elements and properties that nobody asked for.
std::string rich_ply(bool is_big_endian) {
  std::string out = std::string("ply\r\nformat binary_") + (is_big_endian ? "big" : "little") +
                    "_endian 1.0\r\n"
                    "comment  two spaces\r\ncomment\r\nobj_info forgotten\r\n"
                    "element material 2\r\nproperty uint8 red\r\nproperty list ushort double weights\r\n"
                    "element nothing 5\r\n"
                    "element face 1\r\nproperty short flag\r\nproperty list int8 int16 vertex_index\r\n"
                    "property list uchar float uv\r\n"
                    "element vertex 3\r\nproperty int8 a\r\nproperty float z\r\nproperty uint16 b\r\n"
                    "property list uchar char skipped\r\nproperty int32 x\r\nproperty uint c\r\nproperty double y\r\n"
                    "property float32 d\r\nend_header\r\n";
  const auto put = [&](auto value) { append(out, value, is_big_endian); };
  for (const int n : {0, 3}) {
    put(std::uint8_t{255});
    put(static_cast<std::uint16_t>(n));
    for (int i = 0; i < n; ++i) put(1.5);
  }
  put(std::int16_t{-7});
  put(std::int8_t{3});
  for (const std::int16_t corner : {0, 1, 2}) put(corner);
  put(std::uint8_t{1});
  put(2.5F);
  for (const auto& [x, y, z] : kPoints) {
    put(std::int8_t{-100});
    put(static_cast<float>(z));
    put(std::uint16_t{65535});
    put(std::uint8_t{2});
    put('p');
    put('q');
    put(static_cast<std::int32_t>(x));
    put(std::uint32_t{4294967295U});
    put(y);
    put(0.1F);
  }
  return out;
}

TEST(Ply, TakesAnyOrderTypeAndByteOrder) {
  for (const bool is_big_endian : {false, true}) {
    const MeshData data = parse(MeshFormat::ply, rich_ply(is_big_endian));
    EXPECT_EQ(data.points, kPoints);
    EXPECT_EQ(data.triangles, kOneTriangle);
    EXPECT_EQ(data.comments, (std::vector<std::string>{" two spaces", ""}));
    ASSERT_EQ(data.attributes.size(), 4U);
    const std::pair<const char*, double> expected[] = {
        {"a", -100}, {"b", 65535}, {"c", 4294967295.0}, {"d", static_cast<double>(0.1F)}};
    for (const auto& [name, value] : expected) {
      ASSERT_NE(data.attribute(name), nullptr);
      EXPECT_EQ(data.attribute(name)->values, std::vector<double>(3, value)) << name;
    }
    EXPECT_EQ(data.attribute("c")->type, ScalarType::uint32);
  }
}

TEST(Ply, EveryTruncationIsRefused) {
  const std::string whole = rich_ply(true);
  for (std::size_t n = 0; n < whole.size(); ++n)
    EXPECT_THROW(parse(MeshFormat::ply, whole.substr(0, n)), FileError) << n << " of " << whole.size();
}

TEST(Ply, AsciiTakesExtrasToo) {
  const MeshData data = parse(MeshFormat::ply,
                              "ply\nformat ascii 1.0\nelement vertex 3\nproperty float y\nproperty float x\n"
                              "property uchar red\nproperty float z\nproperty float32 w\nelement edge 1\n"
                              "property list int int ends\nproperty int n\nelement face 1\n"
                              "property list uchar uint vertex_indices\nproperty double area\nend_header\n"
                              "0 0 255 0 0.1\n0 1 255 0 nan\n\n1 0 255 0 -inf\n2 0 1 9\n3 0 1 2 0.5\n\n");
  EXPECT_EQ(data.points, kPoints);
  EXPECT_EQ(data.triangles, kOneTriangle);
  EXPECT_EQ(data.attribute("red")->values, std::vector<double>(3, 255.0));
  EXPECT_EQ(data.attribute("w")->values[0], static_cast<double>(0.1F));
}

TEST(Ply, AsciiCoordinatesKeepAllTheirDigits) {
  const MeshData data = parse(MeshFormat::ply,
                              "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                              "property float z\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n"
                              "0.1 0.2 0.30000000000000004\n");
  EXPECT_EQ(data.points[0], (std::array{0.1, 0.2, 0.1 + 0.2}));
}

TEST(Ply, RefusesAttributesThatDoNotFit) {
  const auto error_with = [](VertexAttribute attribute) {
    MeshData data = tetrahedron();
    data.attributes.push_back(std::move(attribute));
    return file_error([&] { print(MeshFormat::ply, data); });
  };
  EXPECT_TRUE(has(error_with({"drop", ScalarType::uint8, {0, 1, 256, 0}}), "attribute \"drop\": 256 at vertex 2"));
  EXPECT_TRUE(has(error_with({"drop", ScalarType::int32, {0, 0.5, 0, 0}}), "0.5 at vertex 1"));
  EXPECT_TRUE(has(error_with({"drop", ScalarType::uint32, {-1, 0, 0, 0}}), "-1 at vertex 0"));
  EXPECT_TRUE(has(error_with({"drop", ScalarType::int8, {0, 0, 0, std::nan("")}}), "nan at vertex 3"));
  EXPECT_TRUE(has(error_with({"drop", ScalarType::float32, {0, 0, 0, 1e39}}), "1e+39 at vertex 3"));
  EXPECT_TRUE(has(error_with({"drop", ScalarType::int32, {0}}), "1 values for 4 vertices"));
  for (const char* name : {"", "two words", "new\nline", "y"})
    EXPECT_TRUE(has(error_with({name, ScalarType::int32, {0, 0, 0, 0}}), "rename")) << name;
}

TEST(Ply, CommentsCannotBreakTheHeader) {
  MeshData data = tetrahedron();
  data.comments = {std::string("a\nend_header\r\0b", 15), "\xC3\xA9"};
  const MeshData back = parse(MeshFormat::ply, print(MeshFormat::ply, data));
  EXPECT_EQ(back.comments, (std::vector<std::string>{"a end_header  b", "\xC3\xA9"}));
}

TEST(Write, RefusesTrianglesOfMissingVertices) {
  MeshData data = tetrahedron();
  data.triangles[2][1] = 4;
  for (const auto format : {MeshFormat::ply, MeshFormat::off, MeshFormat::obj, MeshFormat::stl})
    EXPECT_TRUE(has(file_error([&] { print(format, data); }), "triangle 2 names vertex 4"));
}

}  // namespace
}  // namespace meniscus::test
