// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "attribute_maps.h"
#include "meniscus/topology/remesh.h"
#include "sheet_guard.h"

#include <Eigen/Geometry>

#include <array>
#include <optional>
#include <vector>

/// What the edge operations share. Each operation lies in a file of its own, with its predicates.
namespace meniscus {

/// Why an operation was not done.
enum class Refusal {
  none,  ///< it was done
  link_condition,
  would_invert,
  would_be_sliver,
  would_be_long,
  valence,
  feature,
  contact_line,
  near_intersection,
  not_wanted,  ///< the edge is in the band, or its weight is not negative
};

struct QueuedEdge {
  double squared_length;
  EdgeIndex edge;
};

/// A ball (cm) in which nothing is touched.
struct ForbiddenBall {
  Eigen::Vector3d center;
  double radius;
};

struct Remesher::Scratch {
  std::vector<QueuedEdge> splits, collapses;  ///< heaps: longest first, shortest first
  std::vector<QueuedEdge> splits_now;         ///< the heap of the round
  std::vector<EdgeIndex> flips;               ///< sorted within a round
  std::vector<EdgeIndex> flips_now;
  std::vector<std::uint8_t> in_flips;      ///< by edge
  std::vector<std::uint8_t> marked_faces;  ///< those that scan looks at again
  std::vector<std::pair<EdgeIndex, Refusal>> refused;
  std::vector<VertexIndex> changed;   ///< vertices whose faces changed, with repeats
  std::vector<Eigen::Vector3d> ring;  ///< points of a ring, relative to a centre
  std::vector<VertexIndex> around;    ///< vertices of the rings of an edge
  std::vector<HalfedgeIndex> cycle;
  AttributeMaps attributes;
  std::vector<ForbiddenBall> forbidden;
  std::optional<SheetGuard> guard;  ///< where sheets are close together
  std::vector<SheetGuard::NewFace> new_faces;
  int max_valence = 8;  ///< of a vertex that two others became
};

/// One call of remesh.
struct RemeshState {
  RemeshState(Drop& d, const RemeshOptions& o, Remesher::Scratch& s)
      : drop(d), mesh(d.mesh()), connectivity(d.connectivity()), options(o), scratch(s) {}

  Drop& drop;
  Mesh& mesh;
  Connectivity& connectivity;
  const RemeshOptions& options;
  Remesher::Scratch& scratch;
  RemeshReport report;
  bool has_contact = false;       ///< some vertex is colliding
  bool has_sharp_angle = false;   ///< some corner is under 30 degrees: smoothing has something to do
  bool has_films = false;         ///< somewhere next to the contact line the liquid is too thin to show
  bool has_slits = false;         ///< somewhere two parts of the contact line have come together but for a slit
  bool has_bends = false;         ///< some edge of a face of three colliding vertices has another wetted weight
  bool has_turned_faces = false;  ///< some face of three colliding vertices does not face its solid, or hardly

  Eigen::Vector3d point(VertexIndex v) const { return to_eigen(mesh.point(v)); }
  bool colliding(VertexIndex v) const { return has_contact && is_colliding(drop.contact()[v]); }
  bool on_line(VertexIndex v) const { return has_contact && drop.contact()[v] == Contact::line; }
  VertexIndex apex(HalfedgeIndex h) const { return mesh.target(mesh.next(h)); }
  Ring ring(VertexIndex v) const { return connectivity.ring(v); }

  /// Outward area vector of the face left of h.
  Eigen::Vector3d area_vector(HalfedgeIndex h) const;
  /// Unit normal at a vertex, area weighted; zero if its faces have no area.
  Eigen::Vector3d normal(VertexIndex v) const;
  /// The three vertices of the face left of h are colliding.
  bool is_colliding_face(HalfedgeIndex h) const {
    return colliding(mesh.source(h)) && colliding(mesh.target(h)) && colliding(apex(h));
  }
  /// The solid's outward unit normal at a colliding vertex.
  Eigen::Vector3d contact_normal(VertexIndex v) const { return std::as_const(drop).contact_normals().col(v); }
  /// The mean of the contact normals of the face left of h: over an edge of the solid, one alone will not do.
  Eigen::Vector3d solid_normal(HalfedgeIndex h) const;
  /// The part of the area vector of the face left of h that faces into its solid, in
  /// squares of its longest side: 0.43 at most, negative if it faces away.
  double facing_solid(HalfedgeIndex h) const;
  /// The face left of h lies on a solid: its vertices are colliding, and it faces into the solid.
  bool is_wet_face(HalfedgeIndex h) const;
  /// Both faces of the edge are wet.
  bool inside_wetted_area(HalfedgeIndex h) const;
  /// One face is wet, the other is not.
  bool is_contact_line(HalfedgeIndex h) const;
  /// Squared length as the band sees it: weighted inside the wetted area, and where the free surface curves.
  double squared_length(HalfedgeIndex h) const;
  /// band.wetted_weight inside the wetted area, or more, up to 1, where the solid turns by more than a quarter of a
  /// radian from one end of the edge to the other: there a long edge would lie far from the solid.
  double wetted_weight(HalfedgeIndex h) const;
  /// The same for an edge between two points that would be made, with the solid's normals there.
  double wetted_weight(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& normal_a,
                       const Eigen::Vector3d& normal_b) const;
  /// The factor, 1 to band.refinement, by which an edge in the middle of the band turns the normal by more than
  /// most_turn.
  double curvature_weight(HalfedgeIndex h) const;
  bool is_long(double squared_length) const;
  bool is_short(double squared_length) const { return squared_length < options.band.edge_min * options.band.edge_min; }
  bool is_forbidden(const Eigen::Vector3d& p) const;

  /// Angle between the normals of the edge's faces exceeds feature_angle.
  bool is_feature(HalfedgeIndex h) const;
  /// 0 smooth, 1 on a sharp edge, 2 a corner.
  int feature_rank(VertexIndex v) const;

  /// The faces in scratch.new_faces, in place of those that hold one of `replaced` or are `removed`, would meet
  /// another sheet of the surface. False where there is no guard.
  bool would_meet_sheet(const std::vector<std::uint32_t>& replaced, const std::vector<std::uint32_t>& removed) const {
    return scratch.guard && scratch.guard->would_meet(scratch.new_faces, replaced, removed);
  }

  /// The same for the faces about v with v at x; for those that stay about a and b when both come to x; for the four
  /// about a new vertex at m on an edge.
  bool star_would_meet(VertexIndex v, const Eigen::Vector3d& x) const;
  bool collapse_would_meet(VertexIndex a, VertexIndex b, const Eigen::Vector3d& x) const;
  bool split_would_meet(HalfedgeIndex h, const Eigen::Vector3d& m) const;

  /// Queues an edge for whatever its length or weight asks.
  void queue(EdgeIndex e);
  void queue_flip(EdgeIndex e);
  void queue_ring(VertexIndex v);  ///< its spokes for everything, its rim for flips
  /// Brings connectivity up to date for a vertex, and its contact state in line with its neighbours.
  void update(VertexIndex v);
  void update_contact(VertexIndex v);
};

/// facing_solid of a triangle on a solid whose outward normal there is n.
double facing(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, const Eigen::Vector3d& n);

/// A face of three colliding vertices whose facing_solid is less is turned over, or nearly so.
constexpr double hardly_facing = 0.01;

/// Unit normals of a solid further apart than this turn too much for band.wetted_weight.
inline bool is_bend(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  constexpr double flat = 0.0625;  // a quarter of a radian
  return (a - b).squaredNorm() > flat;
}

/// Along an edge of the free surface the normal turns by no more than this (radians), as far as the band allows.
constexpr double most_turn = 0.5;

/// How far a vertex is lifted off a solid where the liquid has no thickness, in lengths of edge_min.
constexpr double lift_in_edges = 0.02;

/// An edge runs between the two vertices.
inline bool are_joined(const Mesh& mesh, VertexIndex v, VertexIndex w) { return mesh.halfedge(v, w).is_valid(); }

/// (cot a + cot b) of the angles opposite to the edge: twice its weight.
double cotangent_sum(const RemeshState& state, HalfedgeIndex h);
/// The same for the edge between two vertices; o and p are the third corners of its faces.
double cotangent_sum(const RemeshState& state, VertexIndex from, VertexIndex to, VertexIndex o, VertexIndex p);

/// Fills the queues with what is out of the band or has a negative weight, and marks poor quality.
void scan(RemeshState& state);
/// Marks anew the vertices that changed, and those of edges left out of the band.
void mark_poor_quality(RemeshState& state);

Refusal try_split(RemeshState& state, HalfedgeIndex h);
Refusal try_collapse(RemeshState& state, HalfedgeIndex h);
Refusal try_flip(RemeshState& state, HalfedgeIndex h);
/// Near a seam, takes a vertex out and triangulates its ring anew as well as it can be. Not on solids. Returns
/// false if nothing was done.
bool try_remove_vertex(RemeshState& state, VertexIndex v);
/// Cuts at a 3-cycle through the edge that is no face, if there is one (Section 5.2), but not near a seam.
Refusal try_cut(RemeshState& state, HalfedgeIndex h);
/// Mends what moving vertices along a solid did to faces of three colliding vertices: folds in the
/// wetted area, and air faces that lie flat on it (a film of no thickness).
void mend_contact(RemeshState& state);

/// Next to the contact line the air face f lies so low over the solid that the liquid in between is none.
bool is_film(const RemeshState& state, FaceIndex f);
/// Takes such faces off the solid: the contact line passes over them, one edge a call.
void dewet(RemeshState& state);

/// Whether parts of the contact line that are watched form a slit: a wedge of less than 30 degrees that stays dry.
bool has_slits(const RemeshState& state);
/// The contact line passes over the ends of slits, one edge a call.
void close_slits(RemeshState& state);

/// Splits the edge of h at m, where the contact state is `contact`, unasked. Returns the new vertex.
VertexIndex split_at(RemeshState& state, HalfedgeIndex h, const Eigen::Vector3d& m, Contact contact);
/// Collapses the edge of h (a to b) to x with the attributes of (1 - t) a + t b, unasked.
/// Precondition: is_collapse_ok.
void collapse_to(RemeshState& state, HalfedgeIndex h, const Eigen::Vector3d& x, double t);
/// The mesh stays a closed 2-manifold when the edge of h collapses (link condition).
bool is_collapse_ok(const RemeshState& state, HalfedgeIndex h);

/// Moves every vertex `factor` of the way to its ring's centroid, in the plane that keeps the volume.
void smooth_tangentially(RemeshState& state, double factor);

/// Remesher::remesh with the given working arrays, keeping out of scratch.forbidden.
RemeshReport remesh_with(Remesher::Scratch& scratch, Drop& drop, const RemeshOptions& options);
/// Rounds of split, collapse and flip over the queues that scan filled.
void run_passes(RemeshState& state);

}  // namespace meniscus
