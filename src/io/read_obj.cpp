// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats.h"
#include "soup_builder.h"
#include "text_scanner.h"

#include <fmt/format.h>

#include <algorithm>

namespace meniscus::io {
namespace {

/// The integer that a non-empty text is; throws otherwise.
std::int64_t parse_integer(const TextScanner& in, std::string_view text, std::string_view corner) {
  std::int64_t value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || stop != text.data() + text.size())
    in.fail(fmt::format("{} is no corner of a face; write v, v/t, v//n or v/t/n", quote(corner)));
  return value;
}

/// The vertex, from 0, that a corner v, v/t, v//n or v/t/n of `face` names.
std::int64_t parse_corner(const TextScanner& in, std::string_view corner, std::size_t face, std::size_t num_vertices) {
  const auto slash = corner.find('/');
  const std::int64_t index = parse_integer(in, corner.substr(0, slash), corner);
  int parts = 1;
  for (auto rest = corner.substr(std::min(slash, corner.size())); !rest.empty(); ++parts) {
    rest.remove_prefix(1);
    const auto part = rest.substr(0, rest.find('/'));
    if (!part.empty()) parse_integer(in, part, corner);
    rest.remove_prefix(part.size());
  }
  if (parts > 3) in.fail(fmt::format("{} is no corner of a face; write v, v/t, v//n or v/t/n", quote(corner)));
  if (index == 0) in.fail(fmt::format("face {} names vertex 0, but OBJ counts from 1; correct the face", face));
  if (index > 0) return index - 1;
  if (index < -static_cast<std::int64_t>(num_vertices))
    in.fail(fmt::format("face {} names vertex {}, but only {} vertices stand before it; correct the face", face, index,
                        num_vertices));
  return static_cast<std::int64_t>(num_vertices) + index;
}

}  // namespace

MeshData read_obj(const Source& source) {
  refuse_nul_bytes(source);
  TextScanner in(source, {'#', true});
  SoupBuilder soup(source, Place::Kind::line, 1);
  std::vector<std::int64_t> corners;
  while (in.next_line()) {
    const std::string_view keyword = in.word();
    if (keyword == "v") {
      const auto x = in.number<double>("x"), y = in.number<double>("y"), z = in.number<double>("z");
      soup.data.points.push_back({x, y, z});
      in.skip_numbers();
    } else if (keyword == "f") {
      corners.clear();
      for (auto word = in.word(); !word.empty(); word = in.word())
        corners.push_back(parse_corner(in, word, soup.num_faces(), soup.data.points.size()));
      check_list_length(source, in.place(), static_cast<std::int64_t>(corners.size()));
      soup.add_face(corners, in.place().number);
    }
  }
  if (soup.data.points.empty()) in.fail("no line of the file begins with v; is this an OBJ file?");
  return std::move(soup).finish();
}

}  // namespace meniscus::io
