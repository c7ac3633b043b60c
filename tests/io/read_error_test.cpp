// SPDX-License-Identifier: GPL-3.0-or-later
#include "io_test_helpers.h"

#include <fstream>

namespace meniscus::test {
namespace {

struct Case {
  std::string bytes;
  std::string place;  ///< how the message begins
  std::string what;   ///< what it says further on
};

void check(MeshFormat format, const std::vector<Case>& cases) {
  for (const auto& [bytes, place, what] : cases) {
    const std::string error = parse_error(format, bytes);
    EXPECT_EQ(error.substr(0, place.size()), place) << error << "\nof\n" << bytes;
    EXPECT_TRUE(has(error, what)) << error << "\nwithout " << what;
    EXPECT_TRUE(has(error, ";") || has(error, "?")) << error << "\nwithout a remedy";
  }
}

TEST(ReadError, Off) {
  const std::string three = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n";
  const std::string nul(1, '\0');
  check(MeshFormat::off,
        {{"", "in: ", "empty"},
         {" \n\n", "in:2: ", "not OFF"},
         {"ply\n", "in:1: ", "begins with \"ply\""},
         {"4OFF\n", "in:1: ", "\"4OFF\""},
         {"OFF BINARY\n", "in:1: ", "not supported"},
         {"OFF\n", "in:1: ", "truncated"},
         {"OFF\n3\n", "in:2: ", "the line ends before the number of faces"},
         {"OFF\n3 x 0\n", "in:2: ", "\"x\" is not an integer"},
         {"OFF\n3 1 0 9\n", "in:2: ", "\"9\" follows the counts"},
         {"OFF\n-3 1 0\n", "in:2: ", "-3 is no number"},
         {"OFF\n1000000000000 1 0\n0 0 0\n", "in:2: ", "1000000000000 elements vertex cannot fit into the 7 bytes"},
         {"OFF\n1 1000000000000 0\n0 0 0\n", "in:2: ", "1000000000000 elements face cannot fit"},
         {"OFF\n99999999999999999999 1 0\n", "in:2: ", "out of range"},
         {"OFF\n3 1 0\n0 0 0\n1 0\n", "in:2: ", "cannot fit"},
         {"OFF\n3 1 0\n0 0 0\n1 0 0 0 0 0 0 0 0 0 0\n", "in:4: ", "the file ends after 2 of 3 vertices"},
         {"OFF\n3 0 0\n0 0 0\n1 0\n0 1 0 0 0\n", "in:4: ", "the line ends before z"},
         {"OFF\n3 1 0\n0 0 0\n1 0 0x\n0 1 0\n3 0 1 2\n", "in:4: ", "\"0x\" is not a number"},
         {"OFF\n3 1 0\n0 0 0\n1 0 1e999\n0 1 0\n3 0 1 2\n", "in:4: ", "\"1e999\" is out of range for z"},
         {"OFF\n3 1 0\n0 0 0 red\n1 0 0\n0 1 0\n3 0 1 2\n", "in:3: ", "\"red\" is not a number"},
         {"OFF\r\n# a\r\n\r\n3 1 0\r\n0 0 0\r\n1 0 0\r\n0 y 0\r\n3 0 1 2\r\n", "in:7: ", "\"y\""},
         {"OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "in:6: ", "the file ends after 1 of 2 faces"},
         {three + "3 0 1 2\n3 0 2 1\n", "in:7: ", "goes on after its 1 faces"},
         {three + "3 0 1 3\n", "in:6: ", "face 0 names vertex 3, but the file has 3 vertices, counted from 0"},
         {three + "3 0 1 -1\n", "in:6: ", "face 0 names vertex -1"},
         {three + "3 0 1 4294967297\n", "in:6: ", "face 0 names vertex 4294967297"},
         {three + "3 0 1\n", "in:6: ", "the line ends before a vertex index"},
         {three + "3 0 1 2.0\n", "in:6: ", "\"2.0\" is not an integer"},
         {three + "2 0 1\n", "in:6: ", "face 0 has 2 corners"},
         {three + "1 0 1\n", "in:6: ", "face 0 has 1 corners"},
         {three + "-3 0 1 2\n", "in:6: ", "-3 entries"},
         {three + "1000001 0 1 2\n", "in:6: ", "longer than 1000000"},
         {"OFF\n3 1 0\n0 0 0\n1 0" + nul + " 0\n0 1 0\n3 0 1 2\n", "in:4: ", "NUL"}});
}

TEST(ReadError, Obj) {
  const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  check(MeshFormat::obj,
        {{"hello world\n", "in:1: ", "begins with v"},
         {"v 0 0\n", "in:1: ", "the line ends before z"},
         {"v 0 0 0,5\n", "in:1: ", "\"0,5\""},
         {three + "f 1 2 4\n", "in:4: ", "face 0 names vertex 4, but the file has 3 vertices, counted from 1"},
         {three + "f 1 2 3\nf 1 2 0\n", "in:5: ", "face 1 names vertex 0"},
         {three + "f 1 2 -4\n", "in:4: ", "face 0 names vertex -4"},
         {three + "f 1 2\n", "in:4: ", "face 0 has 2 corners"},
         {three + "f\n", "in:4: ", "face 0 has 0 corners"},
         {three + "f 1 2 3x\n", "in:4: ", "\"3x\" is no corner"},
         {three + "f 1 2 3/a\n", "in:4: ", "\"3/a\" is no corner"},
         {three + "f 1 2 /1\n", "in:4: ", "\"/1\" is no corner"},
         {three + "f 1 2 3/1/1/1\n", "in:4: ", "\"3/1/1/1\" is no corner"},
         {three + "f 1 2 99999999999999999999\n", "in:4: ", "no corner"},
         {three + std::string("\0", 1), "in:4: ", "NUL"}});
}

TEST(ReadError, StlText) {
  const std::string loop = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n";
  check(MeshFormat::stl, {{loop, "in:5: ", "truncated"},
                          {loop + "vertex 0 1 0\nendloop\nendfacet\n", "in:8: ", "the file ends where"},
                          {loop + "endloop\nendfacet\nendsolid\n", "in:2: ", "face 0 has 2 corners"},
                          {loop + "vertex 0 1\n", "in:6: ", "the line ends before z"},
                          {loop + "vertex 0 1 0 0\n", "in:6: ", "\"0\" follows"},
                          {loop + "vertex 0 1 zero\n", "in:6: ", "\"zero\" is not a number"},
                          {loop + "facet\n", "in:6: ", "\"facet\" stands where \"vertex\" should"},
                          {"solid a\nfacet\nvertex 0 0 0\n", "in:3: ", "\"vertex\" stands where \"outer\" should"},
                          {"solid a\nendsolid\nmore\n", "in:3: ", "\"more\" stands where \"solid\" should"},
                          {loop + std::string("\0", 1), "in:6: ", "NUL"}});
}

TEST(ReadError, StlBinary) {
  const std::string whole = print(MeshFormat::stl, tetrahedron());
  check(MeshFormat::stl,
        {{"solid", "in: byte 5: ", "truncated"},
         {"hello\n", "in: byte 6: ", "no STL file"},
         {whole.substr(0, whole.size() - 1), "in: byte 80: ", "4 triangles take 284 bytes, but the file has 283"},
         {whole + '\n', "in: byte 80: ", "has 285"},
         {std::string(80, ' ') + "\xFF\xFF\xFF\xFF", "in: byte 80: ", "4294967295 triangles"}});
}

const std::string kVertexHeader = "element vertex 3\nproperty double x\nproperty double y\nproperty double z\n";
const std::string kFaceHeader = "element face 1\nproperty list uchar int vertex_indices\n";
const std::string kAscii = "ply\nformat ascii 1.0\n";

TEST(ReadError, PlyHeader) {
  const std::string format = "in:2: ";
  check(MeshFormat::ply,
        {{"OFF\n", "in:1: ", "begins with \"OFF\""},
         {"ply ply\n", "in:1: ", "not with a line"},
         {"ply\n", "in:1: ", "end_header"},
         {"ply\nformat binary_middle_endian 1.0\n", "in:2: ", "\"binary_middle_endian\" is not supported"},
         {"ply\nformat ascii 2.0\n", "in:2: ", "version \"2.0\""},
         {"ply\nformat ascii\n", "in:2: ", "version \"\""},
         {"ply\n" + kVertexHeader + kFaceHeader + "end_header\n", "in:8: ", "no format line"},
         {kAscii + "property int x\n", "in:3: ", "before any element"},
         {kAscii + "element vertex\n", "in:3: ", "the line ends before the number of elements"},
         {kAscii + "element\n", "in:3: ", "before a name"},
         {kAscii + "element vertex -1\nend_header\n", "in:3: ", "-1 is no number of elements"},
         {kAscii + "element vertex 3 4\n", "in:3: ", "\"4\" follows"},
         {kAscii + "element a 1\nelement a 1\n", "in:4: ", "declared twice"},
         {kAscii + "element a 1\nproperty int x\nproperty float x\n", "in:5: ", "declared twice"},
         {kAscii + "element a 1\nproperty quad x\n", "in:4: ", "\"quad\" is no PLY type"},
         {kAscii + "element a 1\nproperty list float int x\n", "in:4: ", "no integer"},
         {kAscii + "elephant 3\n", "in:3: ", "\"elephant\" is no word"},
         {kAscii + kVertexHeader + "end_header\n1 2 3 4 5 6 7 8 9\n", "in:7: ", "no element face"},
         {kAscii + kFaceHeader + "end_header\n3 0 1 2\n", "in:5: ", "no element vertex"},
         {kAscii + "element vertex 0\nproperty int x\nproperty int y\n" + kFaceHeader + "end_header\n3 0 1 2\n",
          "in:3: ", "lacks a number x, y or z"},
         {kAscii + "element vertex 0\nelement face 0\nproperty int vertex_indices\nend_header\n", "in:3: ", "lacks"},
         {kAscii + kVertexHeader +
              "element face 0\nproperty list uchar float vertex_indices\nend_header\n"
              "000000000000000000",
          "in:7: ", "lacks a list of integers"}});
}

TEST(ReadError, PlyAscii) {
  const std::string header = kAscii + kVertexHeader + kFaceHeader + "end_header\n";  // 9 lines
  const std::string three = header + "0 0 0\n1 0 0\n0 1 0\n";
  check(MeshFormat::ply,
        {{kAscii + "element vertex 1000000000000\nproperty int x\nproperty int y\nproperty int z\n" + kFaceHeader +
              "end_header\n0 0 0\n",
          "in:3: ", "1000000000000 elements \"vertex\" cannot fit into the 7 bytes"},
         {kAscii + kVertexHeader +
              "element face 5000000000\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n"
              "0 0 0\n0 0 0\n3 0 1 2\n",
          "in:7: ", "cannot fit"},
         {header + "0 0 0\n1 0 0 0 0 0 0 0 0 0 0\n", "in:11: ", "\"0\" follows the element's properties"},
         {header + "0 0 0\n1.0000000000000000 0 0\n", "in:11: ", "the file ends after 2 of 3 elements \"vertex\""},
         {header + "0 0 0\n1 0\n0 1 0\n3 0 1 2\n", "in:11: ", "the line ends before a coordinate"},
         {header + "0 0 0\n1 0 O\n0 1 0\n3 0 1 2\n", "in:11: ", "\"O\" is not a number"},
         {three + "3 0 1 2\n3 0 1 2\n", "in:14: ", "goes on"},
         {three + "3 0 1 3\n", "in:13: ", "face 0 names vertex 3"},
         {three + "3 0 1\n", "in:13: ", "the line ends before a value"},
         {three + "3 0 1 2 0\n", "in:13: ", "\"0\" follows"},
         {three + "256 0 1 2\n", "in:13: ", "256 does not fit"},
         {three + "-1 0 1 2\n", "in:13: ", "-1 does not fit"},
         {three + "3 0 1 4294967296\n", "in:13: ", "4294967296 does not fit"},
         {three + "2 0 1\n", "in:13: ", "face 0 has 2 corners"},
         {three + std::string("3 0\0 1 2\n", 9), "in:13: ", "NUL"}});
}

TEST(ReadError, PlyBinary) {
  const std::string whole = print(MeshFormat::ply, tetrahedron());
  const std::size_t body = whole.size() - 4 * 24 - 4 * 13, faces = body + 4 * 24;
  const auto place = [](std::size_t byte) { return "in: byte " + std::to_string(byte) + ": "; };
  std::string bad_index = whole, two_corners = whole, long_list = whole;
  bad_index[faces + 13 + 1] = 9;
  two_corners[faces] = 2;
  long_list[faces + 3 * 13] = 9;
  const std::string list_header = "ply\nformat binary_big_endian 1.0\n" + kVertexHeader +
                                  "element face 1\nproperty list int int vertex_indices\nend_header\n" +
                                  std::string(72, '\0');
  check(MeshFormat::ply,
        {{bad_index, place(faces + 13), "face 1 names vertex 9"},
         {two_corners, "in: byte ", "bytes follow"},
         {long_list, place(whole.size()), "the file ends in element \"face\" 3 of 4"},
         {whole.substr(0, whole.size() - 1), place(whole.size() - 1), "truncated"},
         {whole.substr(0, body + 90), "in:3: ", "4 elements \"vertex\" cannot fit into the 90 bytes"},
         {whole + "x", place(whole.size()), "1 bytes follow the last element"},
         {list_header + std::string("\x7F\xFF\xFF\xFF", 4), place(list_header.size()), "longer than 1000000"},
         {list_header + std::string("\xFF\xFF\xFF\xFF", 4), place(list_header.size()), "-1 entries"}});
}

TEST(ReadError, Files) {
  const TemporaryDirectory directory;
  const auto error_of = [&](const std::string& name) { return file_error([&] { read_mesh(directory / name); }); };
  const std::string missing = error_of("missing.ply");
  EXPECT_EQ(missing, (directory / "missing.ply").string() + ": there is no such file; check the name");
  std::filesystem::create_directory(directory / "folder.ply");
  EXPECT_TRUE(has(error_of("folder.ply"), "folder.ply: is a directory"));
  std::ofstream(directory / "empty.stl").close();
  EXPECT_TRUE(has(error_of("empty.stl"), "empty.stl: the file is empty"));
  std::ofstream(directory / "short.off") << "OFF\n1 0 0\n0 0\n0";
  EXPECT_TRUE(has(error_of("short.off"), "short.off:3: "));
  EXPECT_THROW(read_mesh(directory / "missing.xyz"), UsageError);
}

TEST(ReadError, StreamsHaveALimit) {
  const std::string text = print(MeshFormat::off, tetrahedron());
  std::istringstream enough(text), too_long(text);
  EXPECT_EQ(read_mesh(enough, MeshFormat::off, "stdin", text.size()).triangles.size(), 4U);
  const auto error = file_error([&] { read_mesh(too_long, MeshFormat::off, "stdin", text.size() - 1); });
  EXPECT_TRUE(has(error, "stdin: more than")) << error;
}

}  // namespace
}  // namespace meniscus::test
