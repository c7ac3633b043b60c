// SPDX-License-Identifier: GPL-3.0-or-later
#include "byte_order.h"
#include "formats.h"
#include "meniscus/core/error.h"
#include "ply_header.h"
#include "text_numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace meniscus::io {
namespace {

bool is_one_word(const std::string& name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) { return c > ' ' || c < '\0'; });
}

/// Whether a value can be written as a Number and mean the same; floats may round but not overflow.
template <class Number>
bool fits(double value) {
  if constexpr (std::is_integral_v<Number>)
    return value >= std::numeric_limits<Number>::min() && value <= std::numeric_limits<Number>::max() &&
           value == std::trunc(value);
  else
    return !std::isfinite(value) || std::isfinite(static_cast<Number>(value));
}

void check_attributes(const MeshData& data, const std::string& file) {
  std::set<std::string> names{"x", "y", "z"};
  for (const auto& attribute : data.attributes) {
    const auto fail = [&](const std::string& what) {
      throw FileError(fmt::format("{}: attribute {}: {}", file, quote(attribute.name), what));
    };
    if (!is_one_word(attribute.name)) fail("the name is not one word; rename it");
    if (!names.insert(attribute.name).second) fail("the name is taken; rename it");
    if (attribute.values.size() != data.points.size())
      fail(
          fmt::format("has {} values for {} vertices; give one a vertex", attribute.values.size(), data.points.size()));
    visit_scalar(attribute.type, [&](auto number) {
      for (std::size_t v = 0; v < attribute.values.size(); ++v)
        if (!fits<decltype(number)>(attribute.values[v]))
          fail(fmt::format("{} at vertex {} does not fit its type {}; choose another type or round it",
                           attribute.values[v], v, ply_name(attribute.type)));
    });
  }
}

const char* index_type(const MeshData& data) {
  return data.points.size() > std::numeric_limits<std::int32_t>::max() ? "uint" : "int";
}

std::string header(const MeshData& data, bool binary) {
  std::string out = fmt::format("ply\nformat {} 1.0\n", binary ? "binary_little_endian" : "ascii");
  for (std::string comment : data.comments) {
    std::replace_if(
        comment.begin(), comment.end(), [](char c) { return c >= '\0' && c < ' '; }, ' ');
    out += comment.empty() ? "comment\n" : "comment " + comment + '\n';
  }
  out +=
      fmt::format("element vertex {}\nproperty double x\nproperty double y\nproperty double z\n", data.points.size());
  for (const auto& attribute : data.attributes)
    out += fmt::format("property {} {}\n", ply_name(attribute.type), attribute.name);
  return out + fmt::format("element face {}\nproperty list uchar {} vertex_indices\nend_header\n",
                           data.triangles.size(), index_type(data));
}

void append_binary_body(std::string& out, const MeshData& data) {
  for (std::size_t v = 0; v < data.points.size(); ++v) {
    for (const double x : data.points[v]) append_binary(out, x);
    for (const auto& attribute : data.attributes)
      visit_scalar(attribute.type,
                   [&](auto number) { append_binary(out, static_cast<decltype(number)>(attribute.values[v])); });
  }
  for (const auto& triangle : data.triangles) {
    append_binary(out, std::uint8_t{3});
    for (const auto v : triangle) append_binary(out, v);
  }
}

void append_text_body(std::string& out, const MeshData& data) {
  for (std::size_t v = 0; v < data.points.size(); ++v) {
    append_line(out, data.points[v]);
    for (const auto& attribute : data.attributes) {
      out.back() = ' ';
      visit_scalar(attribute.type,
                   [&](auto number) { append_text(out, static_cast<decltype(number)>(attribute.values[v])); });
      out += '\n';
    }
  }
  for (const auto& triangle : data.triangles) {
    out += "3 ";
    append_line(out, triangle);
  }
}

}  // namespace

std::string write_ply(const MeshData& data, bool binary, const std::string& name) {
  check_attributes(data, name);
  std::string out = header(data, binary);
  out.reserve(out.size() + (24 + 8 * data.attributes.size()) * data.points.size() + 13 * data.triangles.size());
  binary ? append_binary_body(out, data) : append_text_body(out, data);
  return out;
}

}  // namespace meniscus::io
