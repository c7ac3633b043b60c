// SPDX-License-Identifier: GPL-3.0-or-later
#include "io_test_helpers.h"

#include <random>

namespace meniscus::test {
namespace {

/// One to four changes: a byte set or flipped, a part cut out, doubled or cut off, bytes put in.
std::string mutate(std::string bytes, std::mt19937_64& random) {
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  for (std::size_t changes = 1 + below(4); changes > 0 && !bytes.empty(); --changes) {
    const std::size_t at = below(bytes.size());
    switch (below(6)) {
      case 0:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
        break;
      case 1:
        bytes[at] = "0123456789-+.eE \n\r\t/#\\nf\0\xFF"[below(26)];
        break;
      case 2:
        bytes.resize(at);
        break;
      case 3:
        bytes.erase(at, 1 + below(8));
        break;
      case 4:
        bytes.insert(at, bytes.substr(below(bytes.size()), below(16)));
        break;
      default:
        bytes.insert(at, 1 + below(12), "09 \n-\xFF"[below(6)]);
    }
  }
  return bytes;
}

void check_mutations(MeshFormat format, const std::string& valid) {
  ASSERT_NO_THROW(parse(format, valid));
  std::mt19937_64 random(20240607);
  int refused = 0;
  for (int i = 0; i < 2000; ++i) {
    const std::string bytes = mutate(valid, random);
    try {
      const MeshData data = parse(format, bytes);
      for (const auto& triangle : data.triangles)
        for (const auto v : triangle) ASSERT_LT(v, data.points.size()) << "mutation " << i;
      for (const auto& attribute : data.attributes) ASSERT_EQ(attribute.values.size(), data.points.size());
      ASSERT_TRUE(data.source_face.empty() || data.source_face.size() == data.triangles.size());
    } catch (const FileError& error) {
      ++refused;
      ASSERT_EQ(std::string(error.what()).substr(0, 3), "in:") << error.what();
    } catch (const std::exception& error) {
      FAIL() << "mutation " << i << ": " << error.what() << '\n' << bytes;
    }
  }
  EXPECT_GT(refused, 500);
}

MeshData with_attributes() {
  MeshData data = tetrahedron();
  data.comments = {"a comment"};
  data.attributes = {{"drop", ScalarType::int32, {1, 2, 3, 4}}, {"vx", ScalarType::float64, {0.1, 0.2, 0.3, 0.4}}};
  return data;
}

TEST(Mutation, Off) {
  check_mutations(MeshFormat::off, print(MeshFormat::off, tetrahedron()));
  check_mutations(MeshFormat::off, "OFF\n6 1 0\n0 0 0\n2 0 0\n1 .5 0\n2 2 0\n0 2 1e-1\n.5 1 0\n6 0 1 2 3 4 5 # a\n");
}
TEST(Mutation, Obj) {
  check_mutations(MeshFormat::obj, "v 0 0 0\nv 4 -3 0\nv 0 5 0\nv -4 -3 0\nf 1 2 3 4\nf -1//2 \\\n-2/1 -3/1/2\n");
}
TEST(Mutation, StlText) { check_mutations(MeshFormat::stl, print(MeshFormat::stl, tetrahedron(), false)); }
TEST(Mutation, StlBinary) { check_mutations(MeshFormat::stl, print(MeshFormat::stl, tetrahedron())); }
TEST(Mutation, PlyAscii) { check_mutations(MeshFormat::ply, print(MeshFormat::ply, with_attributes(), false)); }
TEST(Mutation, PlyBinary) {
  const std::string little = print(MeshFormat::ply, with_attributes());
  check_mutations(MeshFormat::ply, little);
  std::string body(100, '\0');  // all zero: four vertices with a list of none, then a face that is none
  EXPECT_TRUE(has(parse_error(MeshFormat::ply,
                              "ply\nformat binary_big_endian 1.0\nelement vertex 4\nproperty list char int a\n"
                              "property float x\nproperty float y\nproperty float z\nelement face 1\n"
                              "property list uchar int vertex_index\nend_header\n" +
                                  body.substr(0, 4 * 13 + 1)),
                  "face 0 has 0 corners"));
}

}  // namespace
}  // namespace meniscus::test
