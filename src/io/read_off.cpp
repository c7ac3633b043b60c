// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats.h"
#include "soup_builder.h"
#include "text_scanner.h"

#include <fmt/format.h>

namespace meniscus::io {
namespace {

struct Counts {
  std::int64_t vertices, faces;
};

/// Whether the word is OFF behind any of ST, C and N, in this order.
bool is_off_header(std::string_view word) {
  for (const std::string_view prefix : {"ST", "C", "N"})
    if (word.substr(0, prefix.size()) == prefix) word.remove_prefix(prefix.size());
  return word == "OFF";
}

/// The header's word, and on the same or the next line the counts of vertices, faces and maybe edges.
Counts read_header(TextScanner& in) {
  const bool found = in.next_line();
  const std::string_view word = in.word();
  if (!found || !is_off_header(word))
    in.fail(fmt::format("begins with {}, not OFF; is this an OFF file of three dimensions?", quote(word)));
  if (in.at_line_end() && !in.next_line()) in.fail("the file ends before its counts; it is truncated");
  if (in.rest_of_line().substr(0, 6) == "BINARY") in.fail("binary OFF is not supported; write it as text, or as PLY");
  const auto vertices = in.number<std::int64_t>("the number of vertices");
  const auto faces = in.number<std::int64_t>("the number of faces");
  if (!in.at_line_end()) in.number<std::int64_t>("the number of edges");
  in.expect_line_end("the counts");
  return {vertices, faces};
}

void next_element(TextScanner& in, std::int64_t done, std::int64_t count, const char* what) {
  if (!in.next_line())
    in.fail(fmt::format("the file ends after {} of {} {}; it is truncated or the count is wrong", done, count, what));
}

}  // namespace

MeshData read_off(const Source& source) {
  refuse_nul_bytes(source);
  TextScanner in(source, {'#', false});
  const Counts counts = read_header(in);
  // The shortest lines are "0 0 0" and "3 0 1 2"; only the last one may lack its end.
  const auto room = take_room(source, in.place(), "vertex", counts.vertices, 6, in.bytes_left() + 1);
  take_room(source, in.place(), "face", counts.faces, 2, room);

  SoupBuilder soup(source, Place::Kind::line);
  soup.data.points.reserve(static_cast<std::size_t>(counts.vertices));
  for (std::int64_t v = 0; v < counts.vertices; ++v) {
    next_element(in, v, counts.vertices, "vertices");
    const auto x = in.number<double>("x"), y = in.number<double>("y"), z = in.number<double>("z");
    soup.data.points.push_back({x, y, z});
    in.skip_numbers();
  }
  soup.reserve_faces(static_cast<std::size_t>(counts.faces));
  std::vector<std::int64_t> corners;
  for (std::int64_t f = 0; f < counts.faces; ++f) {
    next_element(in, f, counts.faces, "faces");
    const auto n = in.number<std::int64_t>("the number of corners");
    check_list_length(source, in.place(), n);
    corners.clear();
    for (std::int64_t i = 0; i < n; ++i) corners.push_back(in.number<std::int64_t>("a vertex index"));
    soup.add_face(corners, in.place().number);
    in.skip_numbers();
  }
  if (in.next_line())
    in.fail(fmt::format("the file goes on after its {} faces; correct the counts in the header", counts.faces));
  return std::move(soup).finish();
}

}  // namespace meniscus::io
