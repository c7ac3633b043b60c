// SPDX-License-Identifier: GPL-3.0-or-later
#include "remesh_state.h"

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

bool comes_later_as_split(const QueuedEdge& a, const QueuedEdge& b) {
  return a.squared_length != b.squared_length ? a.squared_length < b.squared_length : a.edge > b.edge;
}
bool comes_later_as_collapse(const QueuedEdge& a, const QueuedEdge& b) {
  return a.squared_length != b.squared_length ? a.squared_length > b.squared_length : a.edge > b.edge;
}

}  // namespace

Eigen::Vector3d RemeshState::area_vector(HalfedgeIndex h) const {
  const Eigen::Vector3d a = point(mesh.source(h)), b = point(mesh.target(h)), c = point(apex(h));
  return 0.5 * (b - a).cross(c - a);
}

Eigen::Vector3d RemeshState::normal(VertexIndex v) const {
  const Ring r = ring(v);
  const Eigen::Vector3d x = point(v);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d previous = point(VertexIndex(r.neighbour[r.degree - 1])) - x;
  for (int k = 0; k < r.degree; ++k) {
    const Eigen::Vector3d next = point(VertexIndex(r.neighbour[k])) - x;
    sum += previous.cross(next);
    previous = next;
  }
  const double length = sum.norm();
  return length > 0 ? Eigen::Vector3d(sum / length) : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

Eigen::Vector3d RemeshState::solid_normal(HalfedgeIndex h) const {
  return (contact_normal(mesh.source(h)) + contact_normal(mesh.target(h)) + contact_normal(apex(h))) / 3;
}

double RemeshState::facing_solid(HalfedgeIndex h) const {
  return facing(point(mesh.source(h)), point(mesh.target(h)), point(apex(h)), solid_normal(h));
}

bool RemeshState::is_wet_face(HalfedgeIndex h) const {
  return is_colliding_face(h) && area_vector(h).dot(solid_normal(h)) < 0;
}

bool RemeshState::inside_wetted_area(HalfedgeIndex h) const {
  return has_contact && is_wet_face(h) && is_wet_face(mesh.opposite(h));
}

bool RemeshState::is_contact_line(HalfedgeIndex h) const {
  return has_contact && is_wet_face(h) != is_wet_face(mesh.opposite(h));
}

double RemeshState::squared_length(HalfedgeIndex h) const {
  const double length2 = (point(mesh.target(h)) - point(mesh.source(h))).squaredNorm();
  double weight = 1;
  if (inside_wetted_area(h))
    weight = wetted_weight(h);
  else if (options.band.refinement > 1)
    weight = curvature_weight(h);
  return weight * weight * length2;
}

double RemeshState::wetted_weight(HalfedgeIndex h) const {
  const auto a = mesh.source(h), b = mesh.target(h);
  return wetted_weight(point(a), point(b), contact_normal(a), contact_normal(b));
}

double RemeshState::wetted_weight(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& normal_a,
                                  const Eigen::Vector3d& normal_b) const {
  const double least = options.band.wetted_weight;
  if (!is_bend(normal_a, normal_b)) return least;
  const double turn = (normal_b - normal_a).norm(), length = (b - a).norm();
  const double middle = 0.5 * (options.band.edge_min + options.band.edge_max);
  return length > 0 ? std::clamp(turn / length * middle / most_turn, least, 1.0) : 1;
}

double RemeshState::curvature_weight(HalfedgeIndex h) const {
  const auto a = mesh.source(h), b = mesh.target(h);
  if (colliding(a) || colliding(b)) return 1;  // the normal turns at the contact line for other reasons
  const double turn = (normal(b) - normal(a)).norm(), length = (point(b) - point(a)).norm();
  const double middle = 0.5 * (options.band.edge_min + options.band.edge_max);
  return length > 0 ? std::clamp(turn / length * middle / most_turn, 1.0, options.band.refinement) : 1;
}

bool RemeshState::is_long(double length2) const {
  return length2 > options.band.edge_max * options.band.edge_max && std::isfinite(length2);
}

bool RemeshState::is_forbidden(const Eigen::Vector3d& p) const {
  return std::any_of(scratch.forbidden.begin(), scratch.forbidden.end(), [&](const ForbiddenBall& ball) {
    return (p - ball.center).squaredNorm() < ball.radius * ball.radius;
  });
}

bool RemeshState::is_feature(HalfedgeIndex h) const {
  if (!options.feature_angle) return false;
  const Eigen::Vector3d n = area_vector(h), m = area_vector(mesh.opposite(h));
  return n.dot(m) < std::cos(*options.feature_angle) * n.norm() * m.norm();
}

int RemeshState::feature_rank(VertexIndex v) const {
  if (!options.feature_angle) return 0;
  int count = 0;
  std::array<Eigen::Vector3d, 2> directions;
  for (const auto h : CGAL::halfedges_around_target(mesh.halfedge(v), mesh))
    if (is_feature(h)) {
      if (count < 2) directions[count] = (point(mesh.source(h)) - point(v)).normalized();
      ++count;
    }
  if (count == 0) return 0;
  return count == 2 && directions[0].dot(directions[1]) < -0.7 ? 1 : 2;
}

bool RemeshState::star_would_meet(VertexIndex v, const Eigen::Vector3d& x) const {
  return collapse_would_meet(v, v, x);
}

bool RemeshState::collapse_would_meet(VertexIndex a, VertexIndex b, const Eigen::Vector3d& x) const {
  if (!scratch.guard) return false;
  auto& faces = scratch.new_faces;
  faces.clear();
  const auto add_faces_of = [&](VertexIndex v, VertexIndex other) {
    const Ring r = ring(v);
    for (int k = 0; k < r.degree; ++k) {
      const VertexIndex p(r.neighbour[k]), q(r.neighbour[k + 1 == r.degree ? 0 : k + 1]);
      if (p != other && q != other) faces.push_back({{a, p, q}, {x, point(p), point(q)}});
    }
  };
  add_faces_of(a, b);
  if (b != a) add_faces_of(b, a);
  return would_meet_sheet({a, b}, {});
}

bool RemeshState::split_would_meet(HalfedgeIndex h, const Eigen::Vector3d& m) const {
  if (!scratch.guard) return false;
  auto& faces = scratch.new_faces;
  faces.clear();
  const auto name = static_cast<std::uint32_t>(mesh.num_vertices());
  for (const auto side : {h, mesh.opposite(h)}) {
    const auto a = mesh.source(side), b = mesh.target(side), o = apex(side);
    faces.push_back({{a, name, o}, {point(a), m, point(o)}});
    faces.push_back({{name, b, o}, {m, point(b), point(o)}});
  }
  return would_meet_sheet({}, {mesh.face(h), mesh.face(mesh.opposite(h))});
}

void RemeshState::queue(EdgeIndex e) {
  const double length2 = squared_length(mesh.halfedge(e));
  if (is_long(length2)) {
    scratch.splits.push_back({length2, e});
    std::push_heap(scratch.splits.begin(), scratch.splits.end(), comes_later_as_split);
  } else if (is_short(length2)) {
    scratch.collapses.push_back({length2, e});
    std::push_heap(scratch.collapses.begin(), scratch.collapses.end(), comes_later_as_collapse);
  }
}

void RemeshState::queue_flip(EdgeIndex e) {
  if (scratch.in_flips.size() < mesh.num_edges()) scratch.in_flips.resize(mesh.num_edges(), 0);
  if (scratch.in_flips[e]) return;
  scratch.in_flips[e] = 1;
  scratch.flips.push_back(e);
}

void RemeshState::queue_ring(VertexIndex v) {
  for (const auto h : CGAL::halfedges_around_target(mesh.halfedge(v), mesh)) {
    queue(mesh.edge(h));
    queue_flip(mesh.edge(h));
    queue_flip(mesh.edge(mesh.prev(h)));
  }
}

void RemeshState::update(VertexIndex v) {
  connectivity.update_vertex(mesh, v);
  scratch.changed.push_back(v);
  if (!scratch.guard || mesh.is_removed(v)) return;
  const Ring r = ring(v);
  for (int k = 0; k < r.degree; ++k) scratch.guard->add(r.corner[k] / 3);
}

void RemeshState::update_contact(VertexIndex v) {
  if (!colliding(v)) return;
  const Ring r = ring(v);
  bool has_free_neighbour = false;
  for (int k = 0; k < r.degree; ++k) has_free_neighbour |= !colliding(VertexIndex(r.neighbour[k]));
  drop.contact()[v] = has_free_neighbour ? Contact::line : Contact::wetted;
}

double facing(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, const Eigen::Vector3d& n) {
  const double longest2 = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return longest2 > 0 ? -0.5 * (b - a).cross(c - a).dot(n) / longest2 : 0;
}

double cotangent_sum(const RemeshState& state, VertexIndex from, VertexIndex to, VertexIndex o, VertexIndex p) {
  const Eigen::Vector3d a = state.point(from), b = state.point(to);
  const auto cotangent = [&](VertexIndex apex) {
    const Eigen::Vector3d u = a - state.point(apex), w = b - state.point(apex);
    const double twice_area = u.cross(w).norm();
    return u.dot(w) / std::max(twice_area, 1e-12 * u.norm() * w.norm());
  };
  const double sum = cotangent(o) + cotangent(p);
  return std::isfinite(sum) ? sum : 0;
}

double cotangent_sum(const RemeshState& state, HalfedgeIndex h) {
  const Mesh& mesh = state.mesh;
  return cotangent_sum(state, mesh.source(h), mesh.target(h), state.apex(h), state.apex(mesh.opposite(h)));
}

}  // namespace meniscus
