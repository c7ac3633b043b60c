// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/drop.h"

#include <vector>

namespace meniscus {

/// What a change of a drop's elements (merge, split, remesh) keeps, for a liquid of density 1, so that
/// mass and volume are one. The ledgers of drops that become one add up.
struct Ledger {
  double volume = 0;                                           ///< V, enclosed, cm^3
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();            ///< V X_cm, cm^4
  Eigen::Vector3d momentum = Eigen::Vector3d::Zero();          ///< P, cm^4/s
  Eigen::Vector3d angular_momentum = Eigen::Vector3d::Zero();  ///< L about the origin, cm^5/s

  Eigen::Vector3d center() const { return moment / volume; }  ///< X_cm, cm; V > 0
  Ledger& operator+=(const Ledger& other);
};

/// A drop's ledger as its surface tells it: the enclosed volume and its centre; P = surface_momentum about
/// X_cm; L = X_cm x P + I omega with the enclosed volume's moment of inertia I and the rotation omega of
/// fit_rigid_motion. All zero without enclosed volume.
Ledger measure_ledger(const Drop& drop);

/// Moves and accelerates the drop so that measure_ledger gives `ledger`:
/// 1. vertices off solids go along their normals until the volume fits;
/// 2. all of the drop goes to X_cm;
/// 3. u += c + s n at vertices off solids, with c and s such that the flux is 0 and P fits;
/// 4. u += (omega - omega_fit) x (x - X_cm), which has no flux and no P.
/// For a drop on a solid 1 is all: the solid holds it and takes its momentum (a flat puddle has hardly a motion
/// without flux that carries any, and would be torn to have it). Exact to rounding, but for the
/// volume (secants, 1e-12). Where nothing is free to move, or the volume is not positive, it does nothing.
/// Where 3, or 4, would leave a vertex more than twice as fast about the mean motion as the fastest was before (a knot
/// of a few faces hardly has a motion that carries P and L), velocities stay as they were before it.
/// Writes positions and velocities; the target volume stays. Without `with_volume`, 1 is left out: the volume is
/// put right later, and until then the drop has as much less, or more, of P and L.
void restore_ledger(Drop& drop, const Ledger& ledger, bool with_volume = true);

/// The same for a drop that fell into pieces: what the pieces' own ledgers do not sum up to is shared
/// among them by volume.
void restore_ledger(std::vector<Drop>& pieces, const Ledger& ledger, bool with_volume = true);

/// How a drop moves as a whole: the enclosed volume (cm^3) and P/V (cm/s), of the P of measure_ledger. Zero without
/// enclosed volume.
struct MeanMotion {
  double volume = 0;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
};
MeanMotion mean_motion(const Drop& drop);

/// Gives a piece that was just torn off a velocity that it can have. In a flow without vortices the centre of mass is
/// nowhere faster than the surface (each component of u is harmonic); but the velocities of a thin piece, whose sides
/// moved each for itself, may tell of a momentum many times that. If P/V is further from the mean of the vertices'
/// velocities than any of them, all of the piece moves with the mean. Returns whether it did.
bool calm_torn_piece(Drop& piece);

/// The centre of mass of the enclosed volume (cm); zero if the volume vanishes.
Eigen::Vector3d volume_centroid(const Drop& drop);

/// The linear momentum that the velocities on the surface tell of, rho oint (x - c) (u.n) dS about the
/// point c: per face (A/12) sum_ij (1 + delta_ij) (x_i - c) (u_j.n), exact for velocities and positions
/// that are linear on faces (g cm/s). For a flow that keeps the volume it is the integral of rho u
/// and does not depend on c.
Eigen::Vector3d surface_momentum(const Drop& drop, double density, const Eigen::Vector3d& c);

}  // namespace meniscus
