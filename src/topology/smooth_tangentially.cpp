// SPDX-License-Identifier: GPL-3.0-or-later
#include "remesh_state.h"

#include <cmath>

namespace meniscus {
namespace {

/// What a vertex's ring says about where it should go.
struct RingMoments {
  Eigen::Vector3d area_vector = Eigen::Vector3d::Zero();  // sum of the faces' area vectors, times 2
  Eigen::Vector3d to_centroid = Eigen::Vector3d::Zero();  // from the vertex, area weighted
};

RingMoments ring_moments(const Point* points, const Ring& r, const Eigen::Vector3d& x) {
  RingMoments m;
  double area = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d previous = to_eigen(points[r.neighbour[r.degree - 1]]) - x;
  for (int k = 0; k < r.degree; ++k) {
    const Eigen::Vector3d next = to_eigen(points[r.neighbour[k]]) - x;
    const Eigen::Vector3d n = previous.cross(next);
    const double a = n.norm();
    m.area_vector += n;
    sum += (a / 3) * (previous + next);
    area += a;
    previous = next;
  }
  if (area > 0) m.to_centroid = sum / area;
  return m;
}

/// No face of the ring turns by more than 60 degrees or becomes much thinner. Faces that are folded
/// over already, against the ring's area vector, do not count: smoothing unfolds them.
bool is_safe(const Point* points, const Ring& r, const Eigen::Vector3d& x, const Eigen::Vector3d& step,
             const Eigen::Vector3d& area_vector) {
  Eigen::Vector3d previous = to_eigen(points[r.neighbour[r.degree - 1]]) - x;
  for (int k = 0; k < r.degree; ++k) {
    const Eigen::Vector3d next = to_eigen(points[r.neighbour[k]]) - x;
    const Eigen::Vector3d n = previous.cross(next), m = (previous - step).cross(next - step);
    const double dot = n.dot(m), n2 = n.squaredNorm(), m2 = m.squaredNorm();
    previous = next;
    if (n.dot(area_vector) < 0) continue;
    if (!(dot > 0 && 4 * dot * dot > n2 * m2) || m2 < 0.04 * n2) return false;
  }
  return true;
}

/// Attributes where the step leads: linear in the face of the ring that it enters.
void carry_attributes(RemeshState& state, const Point* points, VertexIndex v, const Ring& r, const Eigen::Vector3d& x,
                      const Eigen::Vector3d& step, const Eigen::Vector3d& n) {
  for (int k = 0; k < r.degree; ++k) {
    const auto p = r.neighbour[k], q = r.neighbour[k + 1 == r.degree ? 0 : k + 1];
    const Eigen::Vector3d u = to_eigen(points[p]) - x, w = to_eigen(points[q]) - x;
    const double all = n.dot(u.cross(w)), s = n.dot(step.cross(w)), t = n.dot(u.cross(step));
    if (all > 0 && s >= 0 && t >= 0 && s + t <= all) {
      state.scratch.attributes.shift(v, VertexIndex(p), s / all, VertexIndex(q), t / all);
      return;
    }
  }
}

}  // namespace

void smooth_tangentially(RemeshState& state, double factor) {
  Mesh& mesh = state.mesh;
  if (!state.scratch.attributes.is_bound()) state.scratch.attributes.bind(mesh);
  const auto rows = static_cast<std::uint32_t>(state.drop.num_rows());
  Point* const points = rows == 0 ? nullptr : &mesh.point(VertexIndex(0));
  for (std::uint32_t i = 0; i < rows; ++i) {
    const VertexIndex v(i);
    const Ring r = state.ring(v);
    if (r.degree <= 3 || state.on_line(v)) continue;  // a tetrahedron's corners have no tangent plane
    if (state.options.feature_angle && state.feature_rank(v) > 0) continue;
    const Eigen::Vector3d x = to_eigen(points[i]);
    if (!state.scratch.forbidden.empty() && state.is_forbidden(x)) continue;
    const RingMoments m = ring_moments(points, r, x);
    const double n2 = m.area_vector.squaredNorm();
    if (!(n2 > 0)) continue;
    // dV/dx = area vector / 6: a step at right angles to it keeps the volume exactly.
    const Eigen::Vector3d step = factor * (m.to_centroid - m.area_vector * (m.area_vector.dot(m.to_centroid) / n2));
    if (!is_safe(points, r, x, step, m.area_vector)) continue;
    carry_attributes(state, points, v, r, x, step, m.area_vector);
    points[i] = to_point(x + step);
  }
}

}  // namespace meniscus
