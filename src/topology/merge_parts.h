// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "face_grid.h"
#include "meniscus/state/ledger.h"
#include "meniscus/topology/merge.h"
#include "watched_region.h"

#include <Eigen/Geometry>

namespace meniscus {

/// Calls of mend_folds for which the surface near a seam is watched.
inline constexpr std::uint8_t watched_calls = 30;
/// The same for a violent face.
inline constexpr std::uint8_t violent_watched_calls = 5;

/// Counts the watch of every vertex down; it does not end where another sheet of the surface is close.
void count_down_watch(Drop& drop, const EdgeBand& band);

/// What was taken back rushed into a fold and was stopped: its momentum is given to nobody. Each mending would make the
/// rest of a torn film faster, up to 40,000 cm/s (the drop's velocity as a whole is kept from step to step). Sets the
/// ledger's momenta, about its own centre, to those `after`, of a surface that is sound again.
void take_momentum(Ledger& ledger, const Ledger& after);

enum class Momentum { of_ledger, of_surface };

/// The drop that a Boolean result of a and b (or of a with itself) describes, its seam remeshed, with the given
/// ledger and target volume; Momentum::of_surface: with momenta of its own, see take_momentum.
std::vector<Drop> rebuild(const Drop& a, const Drop& b, BooleanResult result, Ledger ledger, Momentum momentum,
                          double target_volume, const MergeOptions& options, Remesher& remesher, MergeReport& report);

/// Moves the free vertices that are not `held` along their normals until the drop encloses `volume` (cm^3), those near
/// held ones by less. Where faces of the region then meet, more vertices are held. What is left of the way then is
/// left: the faces of the region do not meet if they did not before.
void offset_around(Drop& drop, std::vector<std::uint32_t> held, double volume, const WatchedRegion& region);

/// unite_with_itself of some faces, sorted by index, given which faces meet each other elsewhere than in what they
/// share.
BooleanResult unite_with_itself(const MeshView& mesh, const std::vector<FaceBox>& faces,
                                const std::vector<FacePair>& meeting, bool keep_cavities);

}  // namespace meniscus
