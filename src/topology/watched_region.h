// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "face_grid.h"
#include "meniscus/state/drop.h"

#include <Eigen/Geometry>

#include <array>
#include <vector>

namespace meniscus {

/// Where the faces are that a drop has on solids: the box of its colliding vertices, below their highest along the mean
/// of the solid's normals. A face that does not reach into it meets none of them.
struct ContactSlab {
  Eigen::AlignedBox3d box;  ///< empty if no vertex is colliding
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  double top = 0;  ///< up . x, cm

  bool reaches_into(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) const;
};

ContactSlab contact_slab(const Drop& drop);

/// Where sheets of a drop's surface may be close together: all within one to two `reach` of a watched vertex
/// (Drop::seam_watch), as cells of a grid over the box of these vertices.
class WatchedRegion {
 public:
  /// `reach` in cm: some edges long.
  WatchedRegion(const Drop& drop, double reach);
  /// All of space.
  WatchedRegion() : is_everywhere_(true) {}

  /// What reaches into the slab belongs to it, too.
  void add(const ContactSlab& slab) { slab_ = slab; }

  bool empty() const { return !is_everywhere_ && cells_.empty() && slab_.box.isEmpty(); }
  /// Whether x is near a watched vertex.
  bool covers(const Eigen::Vector3d& x) const {
    if (cells_.empty()) return is_everywhere_;
    const Eigen::Array3d at = cell(x);
    return ((at >= 0) && (at < size_)).all() && cells_[index(at)] != 0;
  }
  /// Any of its corners is, or it reaches into the slab.
  bool covers(const std::array<Eigen::Vector3d, 3>& face) const {
    return covers(face[0]) || covers(face[1]) || covers(face[2]) || slab_.reaches_into(face[0], face[1], face[2]);
  }
  /// The faces that it covers, in the order of their indices.
  std::vector<FaceBox> faces_of(const Drop& drop) const;

 private:
  Eigen::Array3d cell(const Eigen::Vector3d& x) const { return (x.array() * per_length_).floor() - low_; }
  std::size_t index(const Eigen::Array3d& at) const {
    return static_cast<std::size_t>(at[0] + size_[0] * (at[1] + size_[1] * at[2]));
  }

  bool is_everywhere_ = false;
  double per_length_ = 0;
  Eigen::Array3d low_ = Eigen::Array3d::Zero(), size_ = Eigen::Array3d::Zero();  // in cells: whole numbers
  std::vector<std::uint8_t> cells_;                                              // not 0: covered
  ContactSlab slab_;
};

/// The region near watched vertices that sheets may reach before it is looked at again.
WatchedRegion watched_region(const Drop& drop, double edge_max);

/// The same, and where the drop lies on solids: there films are close to the wetted area.
WatchedRegion guarded_region(const Drop& drop, double edge_max);

}  // namespace meniscus
