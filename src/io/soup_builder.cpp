// SPDX-License-Identifier: GPL-3.0-or-later
#include "soup_builder.h"

#include "triangulate_polygon.h"

#include <fmt/format.h>

#include <numeric>
#include <utility>

namespace meniscus::io {

void SoupBuilder::reserve_faces(std::size_t count) {
  corners_.reserve(3 * count);
  begin_.reserve(count + 1);
  where_.reserve(count);
}

void SoupBuilder::add_face(const std::vector<std::int64_t>& corners, std::size_t place) {
  corners_.insert(corners_.end(), corners.begin(), corners.end());
  begin_.push_back(corners_.size());
  where_.push_back(place);
}

void SoupBuilder::append_face(std::size_t face, std::vector<std::uint32_t>& corners) {
  const auto n = static_cast<std::int64_t>(data.points.size());
  const auto fail = [&](const std::string& what) { io::fail(source_, {places_, where_[face]}, what); };
  corners.clear();
  for (std::size_t i = begin_[face]; i < begin_[face + 1]; ++i) {
    if (corners_[i] < 0 || corners_[i] >= n)
      fail(fmt::format("face {} names vertex {}, but the file has {} vertices, counted from {}; correct the face", face,
                       corners_[i] + first_index_, n, first_index_));
    corners.push_back(static_cast<std::uint32_t>(corners_[i]));
  }
  if (corners.size() < 3)
    fail(fmt::format("face {} has {} corners, but a face needs three; remove it", face, corners.size()));
  if (corners.size() == 3) {
    data.triangles.push_back({corners[0], corners[1], corners[2]});
  } else {
    if (!has_polygons_) {
      has_polygons_ = true;
      data.source_face.resize(face);
      std::iota(data.source_face.begin(), data.source_face.end(), 0U);
    }
    if (!triangulate_polygon(data.points, corners, data.triangles))
      fail(fmt::format("face {} is a polygon of {} corners that is not convex; cut it into triangles first", face,
                       corners.size()));
  }
  if (has_polygons_) data.source_face.resize(data.triangles.size(), static_cast<std::uint32_t>(face));
}

MeshData SoupBuilder::finish() && {
  if (data.points.size() >= UINT32_MAX || num_faces() >= UINT32_MAX)
    io::fail(source_, {places_, 0}, "has more vertices or faces than 32-bit indices allow; split the mesh");
  data.triangles.reserve(num_faces());
  std::vector<std::uint32_t> corners;
  for (std::size_t face = 0; face < num_faces(); ++face) append_face(face, corners);
  return std::move(data);
}

}  // namespace meniscus::io
