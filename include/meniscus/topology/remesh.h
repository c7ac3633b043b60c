// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/drop.h"
#include "meniscus/state/parameters.h"

#include <cstddef>
#include <memory>
#include <optional>

namespace meniscus {

/// How edges are brought into the band (Section 5 of the paper). Lengths in cm, angles in radians.
struct RemeshOptions {
  EdgeBand band;
  int max_passes = 3;                   ///< rounds of split, collapse and flip; fewer if nothing changes, >= 1
  double smoothing = 0;                 ///< share of the tangential way to the ring's centroid, a pass; [0, 1], 0: none
  std::optional<double> feature_angle;  ///< edges whose faces' normals differ by more are kept sharp
  bool cut_necks = true;                ///< cut at 3-cycles that forbid a collapse (Section 5.2)
  double max_normal_turn = 1.0472;      ///< a collapse or split may turn a face's normal by at most this
  /// Edges flip where the cotangents of the angles opposite to them sum to less (twice their weight). Below zero, so
  /// that cocircular quadrangles rest; further below where the mesh moves, or they flip to and fro.
  double flip_below = -1e-4;
  double max_flip_dihedral = 0.61;  ///< edges whose faces' normals differ by more are not flipped
  /// Whether no operation may make the surface meet itself, anywhere; else that is seen to near watched vertices
  /// (Drop::seam_watch) and on solids alone.
  bool guard_everywhere = false;
  std::size_t min_faces = 4;  ///< a mesh of so many faces is not made coarser
  double max_faces = 50e6;    ///< a band that needs more faces is refused
};

/// Why an edge stayed out of the band: one entry an edge.
struct RefusedEdges {
  std::size_t link_condition = 0;     ///< a 3-cycle that is no face, and no cut was possible
  std::size_t would_invert = 0;       ///< a face's normal would turn too far or two faces would fold together
  std::size_t would_be_sliver = 0;    ///< a face would have next to no area
  std::size_t would_be_long = 0;      ///< an edge would be longer than edge_max
  std::size_t valence = 0;            ///< a vertex would have fewer than 3 or too many neighbours
  std::size_t feature = 0;            ///< a sharp edge or corner would be lost
  std::size_t contact_line = 0;       ///< the contact line would be pinched
  std::size_t near_intersection = 0;  ///< remesh_to_band keeps away from where the surface met itself
};

/// What remesh did. After it, changed() == false means that the mesh is as it was.
struct RemeshReport {
  std::size_t splits = 0, collapses = 0, flips = 0;
  std::size_t cuts = 0;     ///< necks cut and capped; split_components tells whether the drop fell apart
  std::size_t lifts = 0;    ///< vertices taken off a solid, or moved along it, where faces lay on each other
  std::size_t deleted = 0;  ///< remesh_to_band only: tetrahedra and inside-out specks that cuts left
  int passes = 0;
  int retries = 0;  ///< remesh_to_band only: runs thrown away because the surface met itself
  std::size_t edges_below = 0, edges_above = 0;  ///< edges left out of the band
  RefusedEdges refused;                          ///< and why: the fields sum to edges_below + edges_above

  bool changed() const { return splits + collapses + flips + cuts + lifts > 0; }
};

/// Throws UsageError unless 0 < edge_min, 2 edge_min < edge_max, all finite, the wetted weight in
/// (0, 1], the refinement at least 1, the smoothing in [0, 1] and max_passes >= 1.
void check_options(const RemeshOptions& options);

/// Splits, collapses and flips until edges lie in the band, keeping its working arrays from call to
/// call. One object a thread.
///
/// Splits edges longer than edge_max, longest first, at the curved midpoint
/// (a + b)/2 - ((e.n_a) n_a - (e.n_b) n_b)/8, e = b - a; collapses edges shorter than edge_min,
/// shortest first, to the point that keeps the volume; flips edges of negative cotangent weight, but
/// none of the contact line. Inside the wetted area lengths count times band.wetted_weight. Where an edge in the
/// middle of the band would turn the free surface's normal by more than 0.5 radians, lengths count times as much
/// more, at most band.refinement times. A collapse that a 3-cycle forbids cuts the drop along that cycle and caps both
/// sides.
///
/// At a sharp edge, or a vertex that features keep, the midpoint's correction is left out. On solids,
/// no operation makes a face of three colliding vertices that does not face its solid; where moving
/// the contact line has made one, wetted vertices that the line overtook join it, and a film of no
/// thickness above the wetted area is lifted by 0.02 edge_min.
///
/// An edge is split where that makes shorter ones, as the band counts lengths; else it waits for a longer side of its
/// faces. None is split where an apex lies already.
///
/// It ends: no collapse or flip makes an edge too long, and no flip makes one too short, so the only
/// new work is short edges made by splits, and each collapse takes a vertex away. max_passes bounds
/// what smoothing may undo.
///
/// Reads and writes mesh, velocity, displacement, contact state and every other vertex map of
/// numbers or vectors (interpolated linearly; integers from the nearer end); sets poor_quality to 1
/// beside edges left out of the band and corners under 10 degrees, else 0. The target volume stays.
/// A mesh in the band costs one pass over its faces and no allocation.
class Remesher {
 public:
  Remesher();
  ~Remesher();
  Remesher(Remesher&&) noexcept;
  Remesher& operator=(Remesher&&) noexcept;

  /// Precondition: options pass check_options. Throws GeometryError if edges are so long for the band that
  /// more than max_faces faces would be made (a sign of a diverged simulation).
  RemeshReport remesh(Drop& drop, const RemeshOptions& options);

  struct Scratch;

 private:
  std::unique_ptr<Scratch> scratch_;
};

/// The same with working arrays of its own.
RemeshReport remesh(Drop& drop, const RemeshOptions& options);

/// For meshes from files: as remesh, with as many sweeps of tangential smoothing and flips as the
/// options ask, then a check that the surface meets itself nowhere that it did not before. Where it
/// would, it starts again and leaves those places alone, at most `max_retries` times. Components of
/// one tetrahedron, or inside out, that cuts made are deleted (after remesh, split_components does it).
/// Throws UsageError as check_options does and for a band that needs more than max_faces faces;
/// GeometryError ("refused: ...") with the faces at fault when the retries are used up; the drop is
/// then as it was.
RemeshReport remesh_to_band(Drop& drop, const RemeshOptions& options, int max_retries = 4);

}  // namespace meniscus
