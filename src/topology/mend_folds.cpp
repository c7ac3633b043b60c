// SPDX-License-Identifier: GPL-3.0-or-later
#include "boolean_seam.h"
#include "fold_finder.h"
#include "meniscus/geometry/rigid_motion.h"
#include "meniscus/state/contact_line.h"
#include "merge_parts.h"
#include "sheet_guard.h"

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

/// A drop's points as they would be had it only moved as a rigid body since it was last sound: with the solid, if one
/// holds it. Sets `velocity` to that of the same motion; on a solid to half of the mean against it, so that a drop that
/// is taken back again and again comes to rest there.
Eigen::Matrix3Xd carried_along(const Drop& drop, const LastSound& last, RigidMotion& velocity) {
  const ConstColumns before = last.positions;
  velocity = RigidMotion();
  if (touches_solid(drop)) {
    velocity.translation = 0.5 * (last.solid_velocity + mean_over_vertices(drop, drop.velocities()));
    return before.colwise() + last.solid_moved;
  }
  SurfaceGeometry geometry;
  geometry.compute(drop.positions(), drop.connectivity());
  const Eigen::Matrix3Xd moved = drop.positions() - before;
  const RigidMotion motion = fit_rigid_motion(drop.positions(), moved, geometry);
  velocity = fit_rigid_motion(drop.positions(), drop.velocities(), geometry);
  Eigen::Matrix3Xd carried = before;
  for (Eigen::Index i = 0; i < before.cols(); ++i) carried.col(i) += motion.at(drop.positions().col(i) - moved.col(i));
  return carried;
}

/// What a folded surface encloses tells of the drop's place and momentum if it is off by no more than this.
constexpr double largest_volume_error = 0.2;

/// If a drop that was taken back in part holds this much more or less than it ought to, the rest is taken back, too:
/// else it would go further off with every substep.
constexpr double most_left_off = 0.05;

enum class Folds { between_neighbours, all };

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
void relax(Drop& drop, const std::vector<std::uint32_t>& vertices, const WatchedRegion& region) {
  if (vertices.empty()) return;
  SheetGuard guard(drop, region);
  for (const auto v : vertices)
    if (!is_colliding(drop.contact()[v])) relax(drop, v, guard);
}

/// Takes vertices of a drop back to where they were before the substep.
class TakeBack {
 public:
  /// What goes back to further than `edge_min` (cm) above the solid that it has just met is free again: else it would
  /// be put onto the solid at the next substep, however short.
  TakeBack(Drop& drop, const LastSound& before, FoldFinder& finder, double edge_min)
      : drop_(drop),
        finder_(finder),
        edge_min_(edge_min),
        solid_velocity_(before.solid_velocity),
        before_(before.positions),
        sound_(carried_along(std::as_const(drop), before, velocity_)),
        is_back_(drop.num_rows(), 0) {}

  /// Until no faces that `folds` speaks of meet. See mend_folds.
  void run(Folds folds) {
    constexpr int narrow_rounds = 6, most_rounds = 16;
    for (int round = 0; round < most_rounds; ++round) {
      const std::vector<FacePair> meeting = of_kind(folds);
      if (meeting.empty()) return;
      const std::size_t count = taken_.size();
      for (const auto& pair : meeting)
        for (const auto face : pair)
          for (const auto v : drop_.connectivity().triangles()[face]) take(v);
      if (taken_.size() > count && round < narrow_rounds) continue;
      for (std::size_t k = 0, size = taken_.size(); k < size; ++k) {
        const Ring ring = drop_.connectivity().ring(taken_[k]);
        for (int n = 0; n < ring.degree; ++n) take(ring.neighbour[n]);
      }
    }
    for (std::uint32_t v = 0; v < is_back_.size(); ++v) take(v);
    if (of_kind(folds).empty()) return;
    // Sheets that touch but for rounding may not bear to be carried along.
    sound_ = before_;
    drop_.positions() = before_;
    for (const auto v : taken_) finder_.move(v);
  }
  const std::vector<std::uint32_t>& taken() const { return taken_; }
  bool has_let_go() const { return has_let_go_; }

  /// The whole drop, whatever was done with what was taken back since, if that brings its volume nearer to the target.
  void take_all() {
    const double now = drop_.volume(), target = drop_.target_volume();
    const Eigen::Matrix3Xd left = drop_.positions();
    drop_.positions() = sound_;
    const double sound = drop_.volume();
    drop_.positions() = left;
    if (std::abs(sound - target) >= std::abs(now - target)) return;
    for (std::uint32_t v = 0; v < is_back_.size(); ++v) {
      take(v);
      if (is_back_[v] != 0) drop_.positions().col(v) = sound_.col(v);
    }
    if (has_let_go_) mark_contact_line(drop_);
  }

 private:
  std::vector<FacePair> of_kind(Folds folds) {
    std::vector<FacePair> meeting = finder_.meeting();
    const auto& triangles = drop_.connectivity().triangles();
    if (folds == Folds::between_neighbours)
      meeting.erase(std::remove_if(meeting.begin(), meeting.end(),
                                   [&](const auto& p) {
                                     return !boolean_parts::share_a_vertex(triangles[p[0]], triangles[p[1]]);
                                   }),
                    meeting.end());
    return meeting;
  }
  void let_go(std::uint32_t v) {
    drop_.contact()[v] = Contact::free;
    drop_.contact_solid()[v] = -1;
    has_let_go_ = true;
  }
  void take(std::uint32_t v) {
    if (is_back_[v] != 0 || drop_.connectivity().degree(v) == 0) return;
    is_back_[v] = 1;
    taken_.push_back(v);
    if (is_colliding(drop_.contact()[v]) &&
        drop_.contact_normals().col(v).dot(sound_.col(v) - drop_.positions().col(v)) > edge_min_)
      let_go(v);
    drop_.positions().col(v) = sound_.col(v);
    if (is_colliding(drop_.contact()[v]))
      drop_.velocities().col(v) =  // else one that rushes into a fold does so again and again
          0.5 * (solid_velocity_ + drop_.velocities().col(v));
    else
      drop_.velocities().col(v) = velocity_.at(sound_.col(v));
    drop_.seam_watch()[v] = std::max(drop_.seam_watch()[v], violent_watched_calls);
    finder_.move(v);
  }

  Drop& drop_;
  FoldFinder& finder_;
  const double edge_min_;
  bool has_let_go_ = false;
  RigidMotion velocity_;
  const Eigen::Vector3d solid_velocity_;
  const ConstColumns before_;
  Eigen::Matrix3Xd sound_;  // where what is taken goes
  std::vector<std::uint8_t> is_back_;
  std::vector<std::uint32_t> taken_;
};

}  // namespace

std::optional<std::vector<Drop>> mend_folds(Drop& drop, const LastSound& before, const MergeOptions& options,
                                            Remesher& remesher, MergeReport& report) {
  WatchedRegion region = options.self_merge ? WatchedRegion() : watched_region(drop, options.remesh.band.edge_max);
  if (region.empty()) return std::nullopt;
  region.add(contact_slab(drop));  // what is taken back is offset elsewhere, and films must not come through
  FoldFinder finder(drop, region.faces_of(drop));
  if (finder.meeting().empty()) {
    count_down_watch(drop, options.remesh.band);
    return std::nullopt;
  }
  Ledger ledger = measure_ledger(drop);
  std::optional<TakeBack> take_back;
  if (before.positions.cols() == static_cast<Eigen::Index>(drop.num_rows()))
    take_back.emplace(drop, before, finder, options.remesh.band.edge_min);
  if (take_back) take_back->run(Folds::between_neighbours);  // no union mends these
  BooleanResult result;
  if (!finder.meeting().empty()) {
    result = unite_with_itself(view_of(std::as_const(drop)), region.faces_of(drop), finder.meeting(), options.keep_air);
    if (!result.ok() && take_back) take_back->run(Folds::all);
  }
  const std::vector<std::uint32_t> taken = take_back ? take_back->taken() : std::vector<std::uint32_t>();
  report.taken_back += taken.size();
  if (take_back && take_back->has_let_go()) mark_contact_line(drop);
  if (!result.ok() || result.outcome != BooleanOutcome::crossing) {
    if (taken.empty())
      count_down_watch(drop, options.remesh.band);
    else if (!options.self_merge)
      region = guarded_region(drop, options.remesh.band.edge_max);  // it reaches where they are now
    relax(drop, taken, region);
    const bool is_measurable = std::abs(ledger.volume / drop.target_volume() - 1) < largest_volume_error;
    if (!taken.empty() && is_measurable) {
      offset_around(drop, taken, ledger.volume, region);
      if (!touches_solid(drop)) {
        take_momentum(ledger, measure_ledger(drop));
        restore_ledger(drop, ledger, false);
      }
    }
    if (!taken.empty() && std::abs(drop.volume() / drop.target_volume() - 1) > most_left_off) take_back->take_all();
    return std::nullopt;
  }
  ++report.folds;
  report.overlap += ledger.volume - result.volume;
  const Momentum momentum = taken.empty() ? Momentum::of_ledger : Momentum::of_surface;
  return rebuild(drop, drop, result, ledger, momentum, drop.target_volume(), options, remesher, report);
}

}  // namespace meniscus
