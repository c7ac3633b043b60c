// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/mesh_data.h"
#include "source.h"

#include <cstdint>
#include <vector>

namespace meniscus::io {

/// Gathers a file's points and faces in any order, then checks the faces and cuts up its polygons.
class SoupBuilder {
 public:
  /// `first_index` is the file's number for the first vertex; messages use it.
  SoupBuilder(const Source& source, Place::Kind places, std::int64_t first_index = 0)
      : source_(source), places_(places), first_index_(first_index) {}

  void reserve_faces(std::size_t count);
  /// A face whose corners are indices from 0, not yet checked, and the place where it stands.
  void add_face(const std::vector<std::int64_t>& corners, std::size_t place);
  std::size_t num_faces() const { return where_.size(); }

  /// The mesh. Throws FileError if a face has fewer than three corners or one that is no point.
  MeshData finish() &&;

  MeshData data;  ///< points, attributes and comments: filled from outside

 private:
  void append_face(std::size_t face, std::vector<std::uint32_t>& corners);

  const Source& source_;
  Place::Kind places_;
  std::int64_t first_index_;
  std::vector<std::int64_t> corners_;
  std::vector<std::size_t> begin_{0}, where_;
  bool has_polygons_ = false;
};

}  // namespace meniscus::io
