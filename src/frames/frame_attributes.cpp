// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame_attributes.h"

#include "meniscus/core/error.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <cmath>

namespace meniscus {
namespace {

constexpr const char* components[] = {"vx", "vy", "vz"};

}  // namespace

bool is_velocity(const VertexAttribute& attribute) {
  return attribute.name == components[0] || attribute.name == components[1] || attribute.name == components[2];
}

std::vector<double> velocities(const MeshData& data) {
  const VertexAttribute* v[3];
  for (int k = 0; k < 3; ++k)
    if (!(v[k] = data.attribute(components[k]))) return {};
  std::vector<double> all;
  all.reserve(3 * data.points.size());
  for (std::size_t i = 0; i < data.points.size(); ++i)
    for (const VertexAttribute* component : v) all.push_back(component->values[i]);
  return all;
}

std::vector<std::array<float, 3>> vertex_normals(const MeshData& data) {
  using Eigen::Vector3d;
  std::vector<Vector3d> sum(data.points.size(), Vector3d::Zero());
  for (const auto& [a, b, c] : data.triangles) {
    const Eigen::Map<const Vector3d> p(data.points[a].data()), q(data.points[b].data()), r(data.points[c].data());
    const Vector3d area = (q - p).cross(r - p);
    for (const std::uint32_t v : {a, b, c}) sum[v] += area;
  }
  std::vector<std::array<float, 3>> normals;
  normals.reserve(sum.size());
  for (const Vector3d& n : sum) {
    const double length = n.norm();
    const Vector3d unit = length > 0 ? Vector3d(n / length) : Vector3d(Vector3d::UnitZ());
    normals.push_back({static_cast<float>(unit.x()), static_cast<float>(unit.y()), static_cast<float>(unit.z())});
  }
  return normals;
}

void check_finite(const MeshData& data) {
  for (std::size_t v = 0; v < data.points.size(); ++v)
    for (const double x : data.points[v])
      if (!std::isfinite(static_cast<float>(x)))
        throw GeometryError(
            fmt::format("vertex {} is at {:g}, which is no finite number in the single precision of this format", v, x),
            {}, {v});
  for (const VertexAttribute& attribute : data.attributes)
    for (std::size_t v = 0; v < attribute.values.size() && is_velocity(attribute); ++v)
      if (!std::isfinite(attribute.values[v]))
        throw GeometryError(fmt::format("the velocity of vertex {} is not finite", v), {}, {v});
  for (std::size_t t = 0; t < data.triangles.size(); ++t)
    for (const std::uint32_t v : data.triangles[t])
      if (v >= data.points.size())
        throw GeometryError(fmt::format("face {} names vertex {}, but there are only {} vertices", data.face_in_file(t),
                                        v, data.points.size()),
                            {data.face_in_file(t)});
}

}  // namespace meniscus
