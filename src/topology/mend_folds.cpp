// SPDX-License-Identifier: GPL-3.0-or-later
#include "boolean_seam.h"
#include "face_grid.h"
#include "meniscus/core/chunks.h"
#include "meniscus/geometry/rigid_motion.h"
#include "meniscus/topology/self_union.h"
#include "merge_parts.h"
#include "sheet_guard.h"

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

std::array<double, 3> to_array(const Eigen::Vector3d& x) { return {x.x(), x.y(), x.z()}; }

/// A drop's points as they would be had it only moved as a rigid body since `before`; it did not move at all if a
/// solid holds it. Sets `velocity` to that of the same motion.
Eigen::Matrix3Xd carried_along(const Drop& drop, const Eigen::Matrix3Xd& before, RigidMotion& velocity) {
  velocity = RigidMotion();
  if (std::any_of(drop.contact(), drop.contact() + drop.num_rows(), is_colliding)) {
    velocity.translation = drop.velocities().rowwise().mean();
    return before;
  }
  SurfaceGeometry geometry;
  geometry.compute(drop.positions(), drop.connectivity());
  const Eigen::Matrix3Xd moved = drop.positions() - before;
  const RigidMotion motion = fit_rigid_motion(drop.positions(), ConstColumns(moved.data(), moved.cols()), geometry);
  velocity = fit_rigid_motion(drop.positions(), drop.velocities(), geometry);
  Eigen::Matrix3Xd carried = before;
  for (Eigen::Index i = 0; i < before.cols(); ++i) carried.col(i) += motion.at(drop.positions().col(i) - moved.col(i));
  return carried;
}

/// An edge that turns or stretches by more than this share of its length in a substep.
constexpr double large_change = 0.5;

/// What a folded surface encloses tells of the drop's place and momentum if it is off by no more than this.
constexpr double largest_volume_error = 0.2;

enum class Folds { between_neighbours, all };

bool share_a_vertex(const Triangle& s, const Triangle& t) {
  return std::any_of(s.begin(), s.end(), [&](std::uint32_t v) { return v == t[0] || v == t[1] || v == t[2]; });
}

/// Moves a vertex halfway to the mean of its neighbours, or less, if its faces then meet nothing.
void relax(Drop& drop, std::uint32_t v, SheetGuard& guard) {
  const Ring ring = drop.connectivity().ring(v);
  const Eigen::Vector3d x = drop.positions().col(v);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (int k = 0; k < ring.degree; ++k) mean += drop.positions().col(ring.neighbour[k]);
  mean /= ring.degree;
  std::vector<SheetGuard::NewFace> faces(static_cast<std::size_t>(ring.degree));
  for (const double share : {0.5, 0.1}) {
    const Eigen::Vector3d moved = x + share * (mean - x);
    for (int k = 0; k < ring.degree; ++k) {
      const std::uint32_t p = ring.neighbour[k], q = ring.neighbour[(k + 1) % ring.degree];
      faces[static_cast<std::size_t>(k)] = {{v, p, q}, {moved, drop.positions().col(p), drop.positions().col(q)}};
    }
    if (guard.would_meet(faces, {v}, {})) continue;
    drop.positions().col(v) = moved;
    for (int k = 0; k < ring.degree; ++k) guard.add(ring.corner[k] / 3);
    return;
  }
}

/// Relaxes vertices one after another.
void relax(Drop& drop, const std::vector<std::uint32_t>& vertices, const Eigen::AlignedBox3d& region, double cell) {
  if (vertices.empty()) return;
  SheetGuard guard(drop, region, cell);
  for (const auto v : vertices)
    if (!is_colliding(drop.contact()[v])) relax(drop, v, guard);
}

/// The faces of a drop that meet a region, and which of them meet each other elsewhere than in what they share.
class FoldFinder {
 public:
  FoldFinder(const Drop& drop, const Eigen::AlignedBox3d& region)
      : drop_(drop), faces_(faces_in(view_of(drop), region)), place_(drop.connectivity().triangles().size(), none) {
    for (std::uint32_t k = 0; k < faces_.size(); ++k) place_[faces_[k].face] = k;
    is_moved_.assign(faces_.size(), 1);
  }
  /// The vertex has another place now.
  void move(std::uint32_t v) {
    const Ring ring = drop_.connectivity().ring(v);
    for (int k = 0; k < ring.degree; ++k) {
      const std::uint32_t place = place_[ring.corner[k] / 3];
      if (place == none) continue;
      is_moved_[place] = 1;
      faces_[place].box.setEmpty();
      for (const auto w : drop_.connectivity().triangles()[faces_[place].face])
        faces_[place].box.extend(Eigen::Vector3d(drop_.positions().col(w)));
    }
  }
  /// Pairs of faces that meet, sorted. At the first call all are tested, then those that moved since.
  const std::vector<std::array<std::uint32_t, 2>>& find(Folds folds) {
    const MeshView mesh = view_of(drop_);
    const auto has_moved = [&](std::uint32_t face) { return is_moved_[place_[face]] != 0; };
    meeting_.erase(std::remove_if(meeting_.begin(), meeting_.end(),
                                  [&](const auto& pair) { return has_moved(pair[0]) || has_moved(pair[1]); }),
                   meeting_.end());
    const FaceGrid grid(faces_);
    for (std::uint32_t k = 0; k < faces_.size(); ++k) {
      if (is_moved_[k] == 0) continue;
      const std::uint32_t f = faces_[k].face;
      grid.for_each_meeting(faces_[k].box, [&](const FaceBox& other) {
        const std::uint32_t g = other.face;
        if (g == f || (g < f && has_moved(g))) return true;  // it itself, or seen from the other side
        if (folds == Folds::between_neighbours && !share_a_vertex(mesh.triangles[f], mesh.triangles[g])) return true;
        if (boolean_parts::faces_meet(mesh, f, g)) meeting_.push_back({std::min(f, g), std::max(f, g)});
        return true;
      });
    }
    std::fill(is_moved_.begin(), is_moved_.end(), std::uint8_t{0});
    std::sort(meeting_.begin(), meeting_.end());
    return meeting_;
  }

 private:
  static constexpr std::uint32_t none = ~std::uint32_t{0};
  const Drop& drop_;
  std::vector<FaceBox> faces_;
  std::vector<std::uint32_t> place_;  // of a face in the list
  std::vector<std::uint8_t> is_moved_;
  std::vector<std::array<std::uint32_t, 2>> meeting_;
};

/// Takes vertices back until no faces of the region meet; lists them. See mend_folds.
std::vector<std::uint32_t> take_back(Drop& drop, const Eigen::Matrix3Xd& before, const Eigen::AlignedBox3d& region,
                                     Folds folds) {
  constexpr int narrow_rounds = 6, most_rounds = 16;
  if (before.cols() != static_cast<Eigen::Index>(drop.num_rows())) return {};
  RigidMotion velocity;
  const Eigen::Matrix3Xd sound = carried_along(std::as_const(drop), before, velocity);
  FoldFinder finder(drop, region);
  std::vector<std::uint8_t> is_back(drop.num_rows(), 0);
  std::vector<std::uint32_t> taken;
  const auto take = [&](std::uint32_t v) {
    if (is_back[v] != 0 || drop.connectivity().degree(v) == 0) return;
    is_back[v] = 1;
    taken.push_back(v);
    drop.positions().col(v) = sound.col(v);
    if (!is_colliding(drop.contact()[v])) drop.velocities().col(v) = velocity.at(sound.col(v));
    drop.seam_watch()[v] = std::max(drop.seam_watch()[v], violent_watched_calls);
    finder.move(v);
  };
  for (int round = 0; round < most_rounds; ++round) {
    const auto& meeting = finder.find(folds);
    if (meeting.empty()) return taken;
    const std::size_t count = taken.size();
    for (const auto& pair : meeting)
      for (const auto face : pair)
        for (const auto v : drop.connectivity().triangles()[face]) take(v);
    if (taken.size() > count && round < narrow_rounds) continue;
    for (std::size_t k = 0, size = taken.size(); k < size; ++k) {
      const Ring ring = drop.connectivity().ring(taken[k]);
      for (int n = 0; n < ring.degree; ++n) take(ring.neighbour[n]);
    }
  }
  for (std::uint32_t v = 0; v < is_back.size(); ++v) take(v);
  return taken;
}

/// Counts the watch of every vertex down.
void count_down(Drop& drop) {
  std::uint8_t* watch = drop.seam_watch();
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i)
    if (watch[i] > 0) --watch[i];
}

}  // namespace

MeshData soup_in(const Drop& drop, const Eigen::AlignedBox3d& region) {
  MeshData soup;
  const ConstColumns x = drop.positions();
  for (Eigen::Index i = 0; i < x.cols(); ++i) soup.points.push_back(to_array(x.col(i)));
  for (const FaceBox& face : faces_in(view_of(drop), region))
    soup.triangles.push_back(drop.connectivity().triangles()[face.face]);
  return soup;
}

void watch_violent_faces(Drop& drop, const Eigen::Matrix3Xd& before) {
  const ConstColumns x = std::as_const(drop).positions();
  const auto& triangles = drop.connectivity().triangles();
  const auto is_violent = [&](const Triangle& t) {
    const auto& [a, b, c] = t;
    if (a == Connectivity::removed) return false;
    const Eigen::Vector3d p = before.col(b) - before.col(a), q = before.col(c) - before.col(a), r = q - p;
    const Eigen::Vector3d s = x.col(b) - x.col(a), t2 = x.col(c) - x.col(a), u = t2 - s;
    const auto changes_little = [](const Eigen::Vector3d& was, const Eigen::Vector3d& is) {
      return (is - was).squaredNorm() < large_change * large_change * was.squaredNorm();
    };
    return !(changes_little(p, s) && changes_little(q, t2) && changes_little(r, u) && p.cross(q).dot(s.cross(t2)) > 0);
  };
  const auto count = sum_over_chunks(triangles.size(), std::size_t{0}, [&](std::size_t begin, std::size_t end) {
    return static_cast<std::size_t>(std::count_if(triangles.begin() + static_cast<std::ptrdiff_t>(begin),
                                                  triangles.begin() + static_cast<std::ptrdiff_t>(end), is_violent));
  });
  if (count == 0) return;
  std::uint8_t* const watch = drop.seam_watch();
  for (const Triangle& t : triangles)
    if (is_violent(t))
      for (const auto v : t) watch[v] = std::max(watch[v], violent_watched_calls);
}

bool may_fold(const Drop& drop, const MergeOptions& options) {
  const std::uint8_t* watch = drop.seam_watch();
  return drop.num_rows() > 0 &&
         (options.self_merge || std::any_of(watch, watch + drop.num_rows(), [](std::uint8_t w) { return w != 0; }));
}

std::optional<std::vector<Drop>> mend_folds(Drop& drop, const Eigen::Matrix3Xd& before, const MergeOptions& options,
                                            Remesher& remesher, MergeReport& report) {
  const Eigen::AlignedBox3d region =
      options.self_merge ? bounding_box(drop) : SheetGuard::region_of(drop, options.remesh.band.edge_max);
  if (region.isEmpty()) return std::nullopt;
  const auto unite = [&] { return unite_with_itself(view_of(std::as_const(drop)), region, options.keep_air); };
  BooleanResult result = unite();
  if (result.ok() && result.outcome == BooleanOutcome::disjoint) {
    count_down(drop);
    return std::nullopt;
  }
  const Ledger ledger = measure_ledger(drop);
  std::vector<std::uint32_t> taken;
  if (!result.ok()) {  // perhaps for the sake of a few faces that fold over their neighbours
    taken = take_back(drop, before, region, Folds::between_neighbours);
    result = unite();
  }
  if (!result.ok()) {
    const std::vector<std::uint32_t> more = take_back(drop, before, region, Folds::all);
    taken.insert(taken.end(), more.begin(), more.end());
  }
  report.taken_back += taken.size();
  if (!result.ok() || result.outcome == BooleanOutcome::disjoint) {
    if (taken.empty()) count_down(drop);
    relax(drop, taken, region, options.remesh.band.edge_max);
    const bool is_measurable = std::abs(ledger.volume / drop.target_volume() - 1) < largest_volume_error;
    if (!taken.empty() && is_measurable) restore_ledger(drop, ledger, false);
    return std::nullopt;
  }
  ++report.folds;
  report.overlap += ledger.volume - result.volume;
  return rebuild(drop, drop, result, ledger, drop.target_volume(), options, remesher, report);
}

}  // namespace meniscus
