// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/core/chunks.h"
#include "meniscus/core/error.h"
#include "meniscus/geometry/rigid_motion.h"
#include "meniscus/state/judge.h"
#include "meniscus/state/ledger.h"
#include "meniscus/topology/split.h"
#include "round_off.h"
#include "step_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace meniscus {
namespace {

/// Throws SoundnessError for a drop that a change of topology left unsound.
void verify_topology(const Drop& drop, const char* after) {
  std::string defect = judge::connectivity_defect(drop);
  if (defect.empty()) defect = judge::topology_defect(drop.mesh());
  if (!defect.empty()) throw SoundnessError(fmt::format("drop {} is unsound after {}: {}", drop.id(), after, defect));
}

/// A piece smaller than edges are long has no shape to change: of the violent motion of the neck that it was torn
/// from it keeps the translation. Its few vertices would turn it over otherwise.
void stiffen_speck(Drop& piece, const EdgeBand& band) {
  if (ball_radius(piece) > band.edge_max) return;
  SurfaceGeometry& geometry = piece.workspace().geometry;
  geometry.compute(std::as_const(piece).positions(), piece.connectivity());
  const Eigen::Vector3d mean = fit_rigid_motion(piece.positions(), piece.velocities(), geometry).translation;
  piece.velocities().colwise() = mean;
}

}  // namespace

void restore_velocity(Drop* drop, std::vector<Drop>& cut_off, std::size_t first, const Eigen::Vector3d& velocity) {
  double volume = 0;
  Eigen::Vector3d momentum = Eigen::Vector3d::Zero();
  const auto add = [&](const Drop& piece) {
    const MeanMotion motion = mean_motion(piece);
    volume += motion.volume;
    momentum += motion.volume * motion.velocity;
  };
  if (drop) add(*drop);
  std::for_each(cut_off.begin() + static_cast<std::ptrdiff_t>(first), cut_off.end(), add);
  if (!(volume > 0)) return;
  const Eigen::Vector3d missing = velocity - momentum / volume;
  const auto push = [&](Drop& piece) {
    Columns v = piece.velocities();
    for_each_chunk(piece.num_rows(), [&](std::size_t begin, std::size_t end) {
      const auto row = static_cast<Eigen::Index>(begin), count = static_cast<Eigen::Index>(end - begin);
      v.middleCols(row, count).colwise() += missing;
    });
  };
  if (drop) push(*drop);
  std::for_each(cut_off.begin() + static_cast<std::ptrdiff_t>(first), cut_off.end(), push);
}

void keep_inflow(std::vector<Drop>& pieces, const std::vector<Solid>& solids, double inflow) {
  if (inflow == 0 || pieces.empty()) return;
  for (Drop& piece : pieces) piece.set_inflow(0);
  const auto hangs_from_source = [&](const Drop& piece) {
    for (std::size_t s = 0; s < solids.size(); ++s)
      if (solids[s].inflow && hangs_from(piece, static_cast<std::int32_t>(s))) return true;
    return false;
  };
  const auto fed = std::find_if(pieces.begin(), pieces.end(), hangs_from_source);
  (fed != pieces.end() ? *fed : pieces.front()).set_inflow(inflow);
}

/// On drops at rest, caps with many cocircular quadrangles, half of the substeps flipped something at -1e-4. The flow
/// takes negative weights as zero: at -0.05 an edge lacks a twentieth of what an edge between equilateral triangles
/// has.
constexpr double flip_below = -0.05;

/// Those of the coarsest ball: a speck that became one (rounded_off) would collapse to a tetrahedron, be rounded off
/// again, and so on.
constexpr std::size_t ball_faces = 20;

RemeshOptions remesh_options(const StepOptions& step) {
  RemeshOptions options;
  options.band = step.band;
  options.cut_necks = step.split;
  options.flip_below = flip_below;
  options.guard_everywhere = step.self_merge;
  options.min_faces = ball_faces;
  return options;
}

MergeOptions merge_options(const StepOptions& step) {
  MergeOptions options;
  options.remesh = remesh_options(step);
  options.keep_air = step.keep_air;
  options.self_merge = step.self_merge;
  return options;
}

const Solid* holder_of(const Drop& drop, const std::vector<Solid>& solids) {
  std::vector<std::size_t> count(solids.size(), 0);
  for (std::size_t v = 0; v < drop.num_rows(); ++v)
    if (is_colliding(drop.contact()[v])) ++count[static_cast<std::size_t>(drop.contact_solid()[v])];
  const auto most = std::max_element(count.begin(), count.end());
  return most == count.end() || *most == 0 ? nullptr : &solids[static_cast<std::size_t>(most - count.begin())];
}

namespace {

/// What operators and remeshing leave of a drop's volume is given back here if it is more than this share; what is less
/// is left to the next volume correction.
constexpr double least_volume_error = 0.005;

void give_back_volume(Drop& drop, const StepOptions& options) {
  if (options.level == Level::paper || options.volume_correction == VolumeCorrectionMethod::none) return;
  const double target = drop.target_volume();
  if (drop.num_rows() == 0 || std::abs(drop.volume() - target) < least_volume_error * target) return;
  restore_volume(drop, target, options.band.edge_max);
  drop.set_slack(0);
}

/// After a look that found nothing vertices move by this share of edge_min before the next one.
constexpr double slack_share = 1e-3;

LastSound last_sound(const Drop& drop, const ConstColumns& positions, const std::vector<Solid>& solids, double time,
                     double dt) {
  LastSound last{positions};
  const Solid* const holder = holder_of(drop, solids);
  if (holder == nullptr) return last;
  last.solid_moved = holder->offset(time) - holder->offset(time - dt);
  last.solid_velocity = holder->velocity(time);
  return last;
}

/// Counts the substeps in a row after which most vertices had to be taken back.
void count_stuck(Drop& drop, std::size_t taken_back) {
  const bool is_stuck = taken_back > 0 && 2 * taken_back >= drop.mesh().number_of_vertices();
  drop.set_stuck_substeps(is_stuck ? drop.stuck_substeps() + 1 : 0);
}

/// remesh_and_split, before specks are looked at. `after` says for what a drop may be found unsound; nullptr: no
/// element changed.
bool change_topology(Drop& drop, std::vector<Drop>& cut_off, const ConstColumns& before,
                     const std::vector<Solid>& solids, double time, double dt, const StepOptions& options,
                     Remesher& remesher, StageClock& clock, StepReport& report, const char*& after) {
  const std::uint64_t version = drop.topology_version();
  after = nullptr;
  const bool has_to_look = options.remesh && !(drop.slack() > 0);
  if (has_to_look) {
    watch_faces(drop, drop.workspace().violent_faces);
    watch_bends(drop);
    watch_thin_sheets(drop, drop.workspace().geometry.area(), options.band);
  }
  const bool is_watched = has_to_look && may_fold(drop, merge_options(options));
  if (!is_watched) drop.set_stuck_substeps(0);
  if (is_watched) {
    MergeReport merge;
    auto mended = mend_folds(drop, last_sound(drop, before, solids, time, dt), merge_options(options), remesher, merge);
    report += merge;
    count_stuck(drop, merge.taken_back);
    clock.done(Stage::merge);
    if (mended) {
      for (Drop& piece : *mended) give_back_volume(piece, options);
      after = "a fold was united";
      return replace_by_pieces(drop, cut_off, *std::move(mended));
    }
  }
  RemeshReport remeshed;
  if (has_to_look) {
    remeshed = remesher.remesh(drop, remesh_options(options));
    if (!is_watched && !remeshed.changed()) drop.set_slack(slack_share * options.band.edge_min);
    if (drop.topology_version() != version) after = "remeshing";
  }
  // At Level::pressure nothing corrects the volume but the next substep. A substep that was not watched ended as
  // measured, and the worst of the step so far bounds what was measured.
  const bool may_be_left_off =
      options.level == Level::pressure && (is_watched || report.worst_volume_error >= least_volume_error);
  const bool may_be_off = remeshed.changed() || !drop.workspace().films.empty() || may_be_left_off;
  if (options.remesh && may_be_off && remeshed.cuts == 0) give_back_volume(drop, options);
  if (!remeshed.changed()) report.skip(Stage::remesh);
  report.edge_operations += remeshed.splits + remeshed.collapses + remeshed.flips + remeshed.lifts;
  report.cuts += remeshed.cuts;
  clock.done(Stage::remesh);
  if (remeshed.cuts == 0) {
    report.skip(Stage::split);
    clock.done(Stage::split);
    return true;
  }
  SplitReport split;
  std::vector<Drop> pieces = split_components(std::move(drop), split, least_volume(options.band.edge_min));
  report.deleted += split.deleted + split.deleted_empty;
  for (Drop& piece : pieces) {
    calm_torn_piece(piece);
    stiffen_speck(piece, options.band);
    give_back_volume(piece, options);
  }
  after = "a split";
  clock.done(Stage::split);
  return replace_by_pieces(drop, cut_off, std::move(pieces));
}

}  // namespace

bool replace_by_pieces(Drop& drop, std::vector<Drop>& cut_off, std::vector<Drop> pieces) {
  if (pieces.empty()) return false;
  drop = std::move(pieces.front());
  std::move(pieces.begin() + 1, pieces.end(), std::back_inserter(cut_off));
  return true;
}

bool remesh_and_split(Drop& drop, std::vector<Drop>& cut_off, const ConstColumns& before,
                      const std::vector<Solid>& solids, double time, double dt, const StepOptions& options,
                      Remesher& remesher, StageClock& clock, StepReport& report) {
  const std::uint64_t version = drop.topology_version();
  const std::size_t first = cut_off.size();
  const char* after = nullptr;
  if (!change_topology(drop, cut_off, before, solids, time, dt, options, remesher, clock, report, after)) return false;
  const auto finish = [&](Drop& piece) {
    const bool is_rounded = round_off_knot(piece, version, solids, time, options.band);
    report.rounded += is_rounded;
    if (is_rounded) after = "a drop was rounded off";
    if (options.verify != Verify::nothing && after != nullptr) verify_topology(piece, after);
  };
  finish(drop);
  std::for_each(cut_off.begin() + static_cast<std::ptrdiff_t>(first), cut_off.end(), finish);
  return true;
}

}  // namespace meniscus
