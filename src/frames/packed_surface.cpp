// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/frames/packed_surface.h"

#include "frame_attributes.h"
#include "meniscus/core/error.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace meniscus {
namespace {

constexpr double num_steps = 65535;

std::string deflated(const std::string& bytes) {
  uLongf size = ::compressBound(bytes.size());
  std::string out(size, '\0');
  if (::compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                  bytes.size(), Z_DEFAULT_COMPRESSION) != Z_OK)
    throw std::bad_alloc();
  out.resize(size);
  return out;
}

/// Small numbers of either sign as small numbers without one.
std::uint32_t zigzag(std::int64_t value) { return static_cast<std::uint32_t>(value < 0 ? -2 * value - 1 : 2 * value); }

void append_varint(std::string& out, std::int64_t difference) {
  std::uint32_t value = zigzag(difference);
  for (; value >= 128; value >>= 7) out += static_cast<char>((value & 127U) | 128U);
  out += static_cast<char>(value);
}

void measure_box(const MeshData& data, PackedSurface& packed) {
  for (std::size_t axis = 0; axis < 3 && !data.points.empty(); ++axis) {
    const auto less = [axis](const auto& p, const auto& q) { return p[axis] < q[axis]; };
    const auto [low, high] = std::minmax_element(data.points.begin(), data.points.end(), less);
    packed.min[axis] = (*low)[axis];
    packed.step[axis] = ((*high)[axis] - (*low)[axis]) / num_steps;
  }
}

void append_positions(std::string& out, const MeshData& data, const PackedSurface& packed) {
  const std::size_t n = data.points.size();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double min = packed.min[axis], step = packed.step[axis];
    std::string low;
    low.reserve(n);
    std::uint16_t last = 0;
    for (const auto& point : data.points) {
      const auto number =
          static_cast<std::uint16_t>(step > 0 ? std::min(std::round((point[axis] - min) / step), num_steps) : 0);
      const auto difference = static_cast<std::int16_t>(static_cast<std::uint16_t>(number - last));
      const std::uint32_t bits = zigzag(difference);
      out += static_cast<char>(bits >> 8U);
      low += static_cast<char>(bits & 255U);
      last = number;
    }
    out += low;
  }
}

std::vector<double> speeds(const MeshData& data) {
  std::vector<double> all(data.points.size(), 0.0);
  const std::vector<double> v = velocities(data);
  for (std::size_t k = 0; k + 2 < v.size(); k += 3) all[k / 3] = std::hypot(v[k], v[k + 1], v[k + 2]);
  return all;
}

void append_speeds(std::string& out, const MeshData& data, PackedSurface& packed) {
  const std::vector<double> speed = speeds(data);
  for (const double s : speed) packed.speed = std::max(packed.speed, s);
  for (const double s : speed) out += static_cast<char>(packed.speed > 0 ? std::lround(255 * s / packed.speed) : 0);
}

void append_contact(std::string& out, const MeshData& data) {
  const VertexAttribute* contact = data.attribute("contact");
  for (std::size_t v = 0; v < data.points.size(); ++v) {
    const double value = contact ? contact->values[v] : 0;
    out += static_cast<char>(value == 1 ? 1 : value == 2 ? 2 : 0);
  }
}

void append_drops(std::string& out, const MeshData& data) {
  const VertexAttribute* drop = data.attribute("drop");
  std::int64_t last = 0;
  for (std::size_t v = 0; v < data.points.size(); ++v) {
    const double value = drop ? drop->values[v] : 0;
    const std::int64_t id = std::isfinite(value) ? static_cast<std::int64_t>(std::clamp(value, 0.0, 1e9)) : 0;
    append_varint(out, id - last);
    last = id;
  }
}

}  // namespace

PackedSurface pack_surface(const MeshData& data) {
  if (data.points.size() > std::numeric_limits<std::int32_t>::max())
    throw GeometryError(fmt::format("{} vertices are too many for the page", data.points.size()));
  check_finite(data);
  PackedSurface packed;
  packed.num_vertices = static_cast<std::uint32_t>(data.points.size());
  packed.num_triangles = static_cast<std::uint32_t>(data.triangles.size());
  measure_box(data, packed);
  std::string bytes;
  bytes.reserve(10 * data.points.size());
  append_positions(bytes, data, packed);
  append_speeds(bytes, data, packed);
  append_contact(bytes, data);
  append_drops(bytes, data);
  packed.vertices = deflated(bytes);
  bytes.clear();
  std::int64_t last = 0;
  for (const auto& triangle : data.triangles)
    for (const std::uint32_t v : triangle) {
      append_varint(bytes, std::int64_t{v} - last);
      last = v;
    }
  packed.triangles = deflated(bytes);
  return packed;
}

}  // namespace meniscus
