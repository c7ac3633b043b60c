// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats.h"
#include "text_numbers.h"

namespace meniscus::io {

std::string write_off(const MeshData& data) {
  std::string out = "OFF\n";
  append_line(out, std::array{data.points.size(), data.triangles.size(), std::size_t{0}});
  for (const auto& point : data.points) append_line(out, point);
  for (const auto& triangle : data.triangles) {
    out += "3 ";
    append_line(out, triangle);
  }
  return out;
}

}  // namespace meniscus::io
