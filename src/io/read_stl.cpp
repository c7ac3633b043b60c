// SPDX-License-Identifier: GPL-3.0-or-later
#include "byte_order.h"
#include "formats.h"
#include "point_welder.h"
#include "soup_builder.h"
#include "text_scanner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace meniscus::io {
namespace {

constexpr std::size_t kHeader = 84, kRecord = 50;  // bytes

/// 80 bytes of anything, the count, then a normal, three corners and two spare bytes a triangle.
bool has_binary_size(std::string_view bytes) {
  return bytes.size() >= kHeader && bytes.size() == kHeader + kRecord * std::size_t{load<std::uint32_t>(&bytes[80])};
}

/// A binary file may begin with "solid" too, so a word that follows it in text is asked for.
bool is_text(std::string_view bytes) {
  if (bytes.substr(0, 3) == "\xEF\xBB\xBF") bytes.remove_prefix(3);
  std::string start(bytes.substr(0, 1000));
  std::transform(start.begin(), start.end(), start.begin(), [](unsigned char c) { return std::tolower(c); });
  const auto solid = start.find_first_not_of(" \t\r\n");
  if (solid == std::string::npos || start.compare(solid, 5, "solid") != 0) return false;
  return start.find("facet") != std::string::npos || start.find("endsolid") != std::string::npos;
}

MeshData read_binary(const Source& source) {
  if (!has_binary_size(source.bytes)) {
    if (source.bytes.size() < kHeader)
      fail(source, {Place::Kind::byte, source.bytes.size()},
           "the file ends before its count and does not begin as STL text does; it is truncated or no STL file");
    const auto count = load<std::uint32_t>(&source.bytes[80]);
    fail(source, {Place::Kind::byte, 80},
         fmt::format("{} triangles take {} bytes, but the file has {}; it is truncated or no STL file", count,
                     kHeader + kRecord * std::size_t{count}, source.bytes.size()));
  }
  const std::size_t count = (source.bytes.size() - kHeader) / kRecord;
  MeshData data;
  PointWelder welder;
  welder.reserve(count / 2 + 2);
  data.triangles.reserve(count);
  for (std::size_t t = 0; t < count; ++t) {
    const char* corner = &source.bytes[kHeader + kRecord * t];
    auto& triangle = data.triangles.emplace_back();
    for (auto& index : triangle) {
      corner += 12;
      index = welder.index_of({load<float>(corner), load<float>(corner + 4), load<float>(corner + 8)});
    }
  }
  data.points = std::move(welder.points());
  return data;
}

/// The lines of an STL text: solid { facet { outer loop { vertex } endloop } endfacet } endsolid.
class TextReader {
 public:
  explicit TextReader(const Source& source) : source_(source), in_(source), soup_(source, Place::Kind::line) {}

  MeshData read() {
    while (next_keyword()) read_solid();
    soup_.data.points = std::move(welder_.points());
    return std::move(soup_).finish();
  }

 private:
  bool next_keyword() {
    if (!in_.next_line()) return false;
    keyword_ = in_.word();
    std::transform(keyword_.begin(), keyword_.end(), keyword_.begin(), [](unsigned char c) { return std::tolower(c); });
    return true;
  }
  void need_keyword(const char* expected) {
    if (!next_keyword()) in_.fail(fmt::format("the file ends where \"{}\" should stand; it is truncated", expected));
  }
  void check_keyword(const char* expected) {
    if (keyword_ != expected)
      in_.fail(fmt::format("{} stands where \"{}\" should; correct the line", quote(keyword_), expected));
  }

  void read_solid() {
    check_keyword("solid");
    for (need_keyword("facet or endsolid"); keyword_ != "endsolid"; need_keyword("facet or endsolid")) {
      check_keyword("facet");
      read_facet();
    }
  }
  void read_facet() {
    const std::size_t line = in_.place().number;
    need_keyword("outer loop");
    check_keyword("outer");
    corners_.clear();
    for (need_keyword("vertex"); keyword_ != "endloop"; need_keyword("vertex or endloop")) {
      check_keyword("vertex");
      const auto x = in_.number<double>("x"), y = in_.number<double>("y"), z = in_.number<double>("z");
      in_.expect_line_end("the vertex");
      corners_.push_back(welder_.index_of({x, y, z}));
    }
    check_list_length(source_, in_.place(), static_cast<std::int64_t>(corners_.size()));
    need_keyword("endfacet");
    check_keyword("endfacet");
    soup_.add_face(corners_, line);
  }

  const Source& source_;
  TextScanner in_;
  SoupBuilder soup_;
  PointWelder welder_;
  std::string keyword_;
  std::vector<std::int64_t> corners_;
};

}  // namespace

MeshData read_stl(const Source& source) {
  if (has_binary_size(source.bytes) || !is_text(source.bytes)) return read_binary(source);
  refuse_nul_bytes(source);
  return TextReader(source).read();
}

}  // namespace meniscus::io
