// SPDX-License-Identifier: GPL-3.0-or-later
#include "byte_order.h"
#include "formats.h"
#include "meniscus/core/error.h"
#include "meniscus/core/types.h"
#include "point_welder.h"
#include "text_numbers.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <cmath>

namespace meniscus::io {
namespace {

/// The unit normal, or zero where there is none.
std::array<double, 3> unit_normal(const MeshData& data, const std::array<std::uint32_t, 3>& triangle) {
  const Eigen::Vector3d a(data.points[triangle[0]].data()), b(data.points[triangle[1]].data()),
      c(data.points[triangle[2]].data());
  const Eigen::Vector3d n = (b - a).cross(c - a);
  const double length = n.norm();
  if (!(length > 0) || !std::isfinite(length)) return {0, 0, 0};
  return {n.x() / length, n.y() / length, n.z() / length};
}

std::string write_text(const MeshData& data) {
  std::string out = "solid meniscus\n";
  for (const auto& triangle : data.triangles) {
    out += "facet normal ";
    append_line(out, unit_normal(data, triangle));
    out += "outer loop\n";
    for (const auto v : triangle) {
      out += "vertex ";
      append_line(out, data.points[v]);
    }
    out += "endloop\nendfacet\n";
  }
  return out + "endsolid meniscus\n";
}

/// Throws if float32 cannot hold the points or tell them apart.
void check_fits_float32(const MeshData& data, const std::string& name) {
  constexpr const char* kRemedy = "write STL as text, or PLY";
  PointWelder exact, rounded;
  std::vector<std::uint32_t> exact_of_rounded;
  for (std::size_t v = 0; v < data.points.size(); ++v) {
    std::array<double, 3> point = data.points[v];
    for (double& x : point) {
      const auto x32 = static_cast<float>(x);
      if (std::isfinite(x) && !std::isfinite(x32))
        throw FileError(fmt::format("{}: vertex {}: {} does not fit float32; {}", name, v, x, kRemedy));
      x = x32;
    }
    const auto i = exact.index_of(data.points[v]), j = rounded.index_of(point);
    if (j == exact_of_rounded.size())
      exact_of_rounded.push_back(i);
    else if (exact_of_rounded[j] != i && !std::isnan(point[0] + point[1] + point[2]))
      throw FileError(
          fmt::format("{}: vertex {} coincides with another once rounded to float32; {}", name, v, kRemedy));
  }
}

std::string write_binary(const MeshData& data, const std::string& name) {
  check_fits_float32(data, name);
  std::string out = "meniscus";  // anything but "solid"
  out.reserve(84 + 50 * data.triangles.size());
  out.resize(80, ' ');
  append_binary(out, static_cast<std::uint32_t>(data.triangles.size()));
  for (const auto& triangle : data.triangles) {
    for (const double x : unit_normal(data, triangle)) append_binary(out, static_cast<float>(x));
    for (const auto v : triangle)
      for (const double x : data.points[v]) append_binary(out, static_cast<float>(x));
    append_binary(out, std::uint16_t{0});
  }
  return out;
}

}  // namespace

std::string write_stl(const MeshData& data, bool binary, const std::string& name) {
  return binary ? write_binary(data, name) : write_text(data);
}

}  // namespace meniscus::io
