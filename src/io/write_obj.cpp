// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats.h"
#include "text_numbers.h"

namespace meniscus::io {

std::string write_obj(const MeshData& data) {
  std::string out;
  for (const auto& point : data.points) {
    out += "v ";
    append_line(out, point);
  }
  for (const auto& [a, b, c] : data.triangles) {
    out += "f ";
    append_line(out, std::array{a + 1, b + 1, c + 1});
  }
  return out;
}

}  // namespace meniscus::io
