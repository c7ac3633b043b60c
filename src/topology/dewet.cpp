// SPDX-License-Identifier: GPL-3.0-or-later
#include "merge_parts.h"
#include "remesh_state.h"

#include <CGAL/boost/graph/Euler_operations.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace meniscus {
namespace {

using Eigen::Vector3d;

/// A film thinner than this, in lengths of edge_min, is none: the contact line passes over it.
constexpr double least_film = 0.1;

/// The edge of the contact line in an air face of two colliding vertices and a free one; null if it has none.
HalfedgeIndex line_edge(const RemeshState& state, FaceIndex f) {
  for (const auto h : CGAL::halfedges_around_face(state.mesh.halfedge(f), state.mesh))
    if (!state.colliding(state.apex(h)) && state.colliding(state.mesh.source(h)) &&
        state.colliding(state.mesh.target(h)) && state.is_wet_face(state.mesh.opposite(h)))
      return h;
  return Mesh::null_halfedge();
}

/// How high v lies over the solid, as the tangent planes at a and b tell; infinite where they differ: over an edge of
/// the solid.
double height_over(const RemeshState& state, VertexIndex v, VertexIndex a, VertexIndex b) {
  constexpr double same_direction = 0.97;
  const Vector3d m = state.contact_normal(a), n = state.contact_normal(b), x = state.point(v);
  if (!(m.dot(n) > same_direction)) return std::numeric_limits<double>::infinity();
  return 0.5 * ((x - state.point(a)).dot(m) + (x - state.point(b)).dot(n));
}

double height_of_apex(const RemeshState& state, HalfedgeIndex h) {
  return height_over(state, state.apex(h), state.mesh.source(h), state.mesh.target(h));
}

/// Far below the tangent plane is beside a solid that falls off there.
bool is_film_of(const RemeshState& state, double height) {
  return std::abs(height) < least_film * state.options.band.edge_min;
}

/// The faces that come of it: those about v, but for the film, with v at x, and two wet ones in place of the one
/// below the film.
void list_new_faces(RemeshState& state, HalfedgeIndex h, const Vector3d& x) {
  const Mesh& mesh = state.mesh;
  const auto a = mesh.source(h), b = mesh.target(h), v = state.apex(h), w = state.apex(mesh.opposite(h));
  auto& faces = state.scratch.new_faces;
  faces.clear();
  const Ring ring = state.ring(v);
  for (int k = 0; k < ring.degree; ++k) {
    const VertexIndex p(ring.neighbour[k]), q(ring.neighbour[k + 1 == ring.degree ? 0 : k + 1]);
    if ((p == a && q == b) || (p == b && q == a)) continue;
    faces.push_back({{v, p, q}, {x, state.point(p), state.point(q)}});
  }
  faces.push_back({{a, w, v}, {state.point(a), state.point(w), x}});
  faces.push_back({{b, v, w}, {state.point(b), x, state.point(w)}});
}

/// Twice the area by which a triangle faces into the solid of normal n.
double wet_area(const Vector3d& p, const Vector3d& q, const Vector3d& r, const Vector3d& n) {
  return -(q - p).cross(r - p).dot(n);
}

/// Both wet faces have room: v lies well within the face below the film, or just beyond.
bool have_room(const RemeshState& state, HalfedgeIndex h, const Vector3d& x, const Vector3d& n) {
  constexpr double thin = 0.1;
  const Mesh& mesh = state.mesh;
  const Vector3d a = state.point(mesh.source(h)), b = state.point(mesh.target(h)),
                 w = state.point(state.apex(mesh.opposite(h)));
  const double longest2 = std::max({(w - a).squaredNorm(), (w - b).squaredNorm(), (b - a).squaredNorm()});
  return wet_area(a, w, x, n) > thin * longest2 && wet_area(b, x, w, n) > thin * longest2;
}

/// Another face about the apex of h has two vertices on the solid: with the apex there, it would lie flat on the wetted
/// area.
bool has_other_film(const RemeshState& state, HalfedgeIndex h) {
  const Ring ring = state.ring(state.apex(h));
  int films = 0;
  for (int k = 0; k < ring.degree; ++k)
    films += state.colliding(VertexIndex(ring.neighbour[k])) &&
             state.colliding(VertexIndex(ring.neighbour[k + 1 == ring.degree ? 0 : k + 1]));
  return films > 1;
}

/// The line moves from the edge h to its apex v: v comes down on the solid, and the film between, which lies flat on
/// the wet face below it, goes with that face by a flip.
bool try_dewet(RemeshState& state, HalfedgeIndex h) {
  Mesh& mesh = state.mesh;
  const auto a = mesh.source(h), b = mesh.target(h), v = state.apex(h), w = state.apex(mesh.opposite(h));
  const Vector3d n = (state.contact_normal(a) + state.contact_normal(b)).stableNormalized();
  const double height = height_of_apex(state, h);
  if (!is_film_of(state, height)) return false;
  if (v == w || are_joined(mesh, v, w)) return false;
  if (state.connectivity.degree(a) < 4 || state.connectivity.degree(b) < 4) return false;
  const Vector3d x = state.point(v) - height * n;
  if (has_other_film(state, h) || !have_room(state, h, x, n) || state.is_forbidden(x)) return false;
  list_new_faces(state, h, x);
  if (state.would_meet_sheet({v}, {mesh.face(mesh.opposite(h))})) return false;

  Drop& drop = state.drop;
  drop.contact()[v] = Contact::line;
  drop.contact_solid()[v] = drop.contact_solid()[a];
  drop.contact_normals().col(v) = n;
  mesh.point(v) = to_point(x);
  CGAL::Euler::flip_edge(h, mesh);
  for (const auto u : {a, b, v, w}) state.update(u);
  for (const auto u : {a, b, v, w}) state.update_contact(u);
  state.queue_ring(v);
  ++state.report.flips;
  return true;
}

}  // namespace

bool is_film(const RemeshState& state, FaceIndex f) {
  const auto& t = state.connectivity.triangles()[f];
  for (int k = 0; k < 3; ++k) {  // most are far too high, and that is seen without a walk over the mesh
    const VertexIndex apex(t[k]), a(t[(k + 1) % 3]), b(t[(k + 2) % 3]);
    if (!state.colliding(apex) && !is_film_of(state, height_over(state, apex, a, b))) return false;
  }
  return line_edge(state, f) != Mesh::null_halfedge();
}

void dewet(RemeshState& state) {
  const auto faces = static_cast<std::uint32_t>(state.mesh.num_faces());
  for (std::uint32_t f = 0; f < faces; ++f) {
    if (state.mesh.is_removed(FaceIndex(f))) continue;
    const auto h = line_edge(state, FaceIndex(f));
    if (h == Mesh::null_halfedge() || !is_film_of(state, height_of_apex(state, h)) || try_dewet(state, h)) continue;
    std::uint8_t* watch = state.drop.seam_watch();  // it lies on the wetted area, or will soon
    for (const auto v : {state.mesh.source(h), state.mesh.target(h), state.apex(h)})
      watch[v] = std::max(watch[v], violent_watched_calls);
  }
}

}  // namespace meniscus
