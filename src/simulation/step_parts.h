// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/simulation/step.h"
#include "meniscus/topology/merge.h"

#include <algorithm>
#include <cmath>

namespace meniscus {

/// Adds up seconds by stage, if there is a clock.
class StageClock {
 public:
  StageClock(double (*clock)(), StepReport& report) : clock_(clock), report_(report), last_(clock ? clock() : 0) {}
  void done(Stage stage) {
    if (!clock_) return;
    const double now = clock_();
    report_.stage_seconds[static_cast<std::size_t>(stage)] += now - last_;
    last_ = now;
  }

 private:
  double (*clock_)();
  StepReport& report_;
  double last_;
};

/// The radius of the ball of the drop's volume (cm).
inline double ball_radius(const Drop& drop) { return std::cbrt(drop.target_volume() * 0.75 / 3.14159265358979323846); }

/// Near a solid a drop moves at most this share of its ball's radius a substep, so that it meets the solid with its
/// front and not as a whole; and a step has at most so many substeps.
inline constexpr double largest_move = 0.5;
inline constexpr int most_substeps = 256;

/// Puts the first of the pieces in the drop's place and the others behind `cut_off`. Returns whether there was one.
bool replace_by_pieces(Drop& drop, std::vector<Drop>& cut_off, std::vector<Drop> pieces);

/// Gives a drop (nullptr: none), and what was cut off it from `first` on, together the velocity (cm/s) that they ought
/// to have.
void restore_velocity(Drop* drop, std::vector<Drop>& cut_off, std::size_t first, const Eigen::Vector3d& velocity);

/// What sources gave the drop (cm^3/s) goes to the one of its pieces that hangs from a source; to the first if none
/// does.
void keep_inflow(std::vector<Drop>& pieces, const std::vector<Solid>& solids, double inflow);

/// The solid that a drop is held by, if it touches any: of several that which most of its vertices lie on, of equals
/// the first.
const Solid* holder_of(const Drop& drop, const std::vector<Solid>& solids);

/// How drops merge in a step.
MergeOptions merge_options(const StepOptions& step);

/// The end of every substep of dt (s), at `time` (s): mends folds (`before`: the positions at its start), brings the
/// edges into the band, takes apart what that cut, and rounds off specks that meet themselves. `cut_off` and what is
/// returned are as those of step_in_place.
bool remesh_and_split(Drop& drop, std::vector<Drop>& cut_off, const ConstColumns& before,
                      const std::vector<Solid>& solids, double time, double dt, const StepOptions& options,
                      Remesher& remesher, StageClock& clock, StepReport& report);

/// step_in_place at Level::pressure: substeps as long as the motion allows, each tried and taken back if it was
/// too long.
bool step_by_pressure(Drop& drop, std::vector<Drop>& cut_off, const std::vector<Solid>& solids, double time, double dt,
                      const StepOptions& options, Remesher& remesher, StepReport& report);

}  // namespace meniscus
