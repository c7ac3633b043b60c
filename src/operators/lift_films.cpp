// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/operators/lift_films.h"

#include "meniscus/state/contact_line.h"
#include "within_triangle.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>

namespace meniscus {
namespace {

using Eigen::Vector3d;

constexpr double film_thickness = 0.02, largest_sagitta = 0.25;  // of the mean length of a vertex' edges

/// The faces of a drop that lie on solids.
class WettedFaces {
 public:
  /// Those of three vertices for which `is_wet` holds.
  template <class IsWet>
  WettedFaces(const Drop& drop, IsWet is_wet) : drop_(drop) {
    const ConstColumns x = drop.positions();
    for (const auto& [a, b, c] : drop.connectivity().triangles()) {
      if (a == Connectivity::removed || !is_wet(a) || !is_wet(b) || !is_wet(c)) continue;
      faces_.push_back({{a, b, c}, {}});
      for (const auto v : faces_.back().vertices) faces_.back().box.extend(Vector3d(x.col(v)));
    }
  }
  bool empty() const { return faces_.empty(); }

  /// Whether a point p of a solid of normal n lies below a vertex' film: within a face that is not at the vertex.
  bool cover(const Vector3d& p, const Vector3d& n, std::uint32_t vertex) const {
    const ConstColumns x = drop_.positions();
    return std::any_of(faces_.begin(), faces_.end(), [&](const Face& face) {
      const auto [a, b, c] = face.vertices;
      if (a == vertex || b == vertex || c == vertex) return false;
      if (face.box.squaredExteriorDistance(p) > 0.25 * face.box.diagonal().squaredNorm()) return false;
      const Vector3d p_a = x.col(a), p_b = x.col(b), p_c = x.col(c);
      return (p_b - p_a).cross(p_c - p_a).dot(n) < 0 && is_within(p, p_a, p_b, p_c, n);
    });
  }

 private:
  struct Face {
    std::array<std::uint32_t, 3> vertices;
    Eigen::AlignedBox3d box;
  };
  const Drop& drop_;
  std::vector<Face> faces_;
};

/// What velocity a vertex has into a solid of normal n ends.
void stop(Drop& drop, std::uint32_t v, const Vector3d& n, const Vector3d& solid_velocity) {
  Columns u = drop.velocities();
  u.col(v) -= std::min(0.0, (u.col(v) - solid_velocity).dot(n)) * n;
}

/// How high above p, on a solid of normal n, the faces about a vertex want it (cm): a share of its edges, and what
/// they cut below their vertices where the solid curves away; `least` of that is known.
double film_height(const Drop& drop, std::uint32_t v, const Vector3d& p, const Vector3d& n, double least) {
  const ConstColumns x = drop.positions();
  const Ring ring = drop.connectivity().ring(v);
  double length = 0, lowest = 0;
  for (int k = 0; k < ring.degree; ++k) {
    const Vector3d edge = x.col(ring.neighbour[k]) - p;
    length += edge.norm() / ring.degree;
    lowest = std::min(lowest, edge.dot(n));
  }
  return film_thickness * length + std::max(least, std::min(-0.25 * lowest, largest_sagitta * length));
}

/// Puts a vertex at a height over p, on a solid of normal n, and stops it.
void lift(Drop& drop, std::uint32_t v, double height, const Vector3d& p, const Vector3d& n,
          const Vector3d& solid_velocity) {
  drop.positions().col(v) = p + height * n;
  stop(drop, v, n, solid_velocity);
}

/// Within this distance of the solids that it touches (cm) a drop's film may be lower than its faces need: nought on a
/// plane, a share of the wetted edges where normals differ.
double reach_of_sagittas(const Drop& drop) {
  constexpr double share = 0.1, same = 1e-3;
  if (!contact_normals_differ(drop, same)) return 0;
  const ConstColumns x = drop.positions();
  double length = 0;
  int edges = 0;
  for (std::uint32_t v = 0; v < drop.num_rows(); ++v) {
    if (!is_colliding(drop.contact()[v])) continue;
    const Ring ring = drop.connectivity().ring(v);
    for (int k = 0; k < ring.degree; ++k) length += (x.col(ring.neighbour[k]) - x.col(v)).norm();
    edges += ring.degree;
  }
  return share * length / std::max(edges, 1);
}

/// A free vertex near a solid.
struct NearVertex {
  std::uint32_t vertex;
  SolidContact below;
};

/// Those within reach of it, or in it; behind a source's disc, which liquid passes, those within reach.
std::vector<NearVertex> vertices_near(const Drop& drop, const Solid& solid, double time, double reach) {
  std::vector<NearVertex> near;
  for (std::uint32_t v = 0; v < drop.num_rows(); ++v) {
    if (drop.connectivity().degree(v) == 0 || is_colliding(drop.contact()[v])) continue;
    const Vector3d x = drop.positions().col(v);
    if (!solid.is_near(x, time, reach)) continue;
    const SolidContact below = solid.query(x, time);
    if (below.distance <= reach && !(solid.inflow && below.distance < -reach)) near.push_back({v, below});
  }
  return near;
}

/// How high vertices must be for the solid not to come through their edges, one a row (cm). Over an edge of length l
/// the solid rises by l^2/(8 R), which is a quarter of what the edge's end lies below the tangent plane of its start;
/// an edge whose ends are at g and h clears it where sqrt(g) + sqrt(h) >= 2 sqrt(rise), and a face asks for a third
/// more.
std::vector<double> least_heights(const Drop& drop, const std::vector<NearVertex>& near) {
  constexpr double within_face = 4.0 / 3;  // the rise in the middle of a triangle of equal sides, in those of its sides
  std::vector<double> height(drop.num_rows(), -1), least(drop.num_rows(), 0);
  for (const auto& [v, below] : near) height[v] = std::max(0.0, below.distance);
  for (const auto& [v, below] : near) {
    const Ring ring = drop.connectivity().ring(v);
    for (int k = 0; k < ring.degree; ++k) {
      const std::uint32_t w = ring.neighbour[k];
      if (height[w] < 0) continue;
      const double rise = 0.25 * (height[w] - (drop.positions().col(w) - below.point).dot(below.normal));
      const double root = 2 * std::sqrt(std::max(0.0, within_face * rise)) - std::sqrt(height[w]);
      if (root > 0) least[v] = std::max(least[v], root * root);
    }
  }
  return least;
}

}  // namespace

void lift_films(Drop& drop, const std::vector<Solid>& solids, double time, double low) {
  std::vector<std::uint8_t>& films = drop.workspace().films;
  films.clear();
  if (!touches_solid(drop)) return;
  const Eigen::AlignedBox3d box = bounding_box(drop);
  const double reach_of_curved = reach_of_sagittas(drop), reach = std::max(low, reach_of_curved);
  std::optional<WettedFaces> wetted;
  for (const Solid& solid : solids) {
    if (!solid.is_near(box, time, reach)) continue;
    const std::vector<NearVertex> near = vertices_near(drop, solid, time, reach);
    std::vector<double> least;
    if (reach_of_curved > 0 && !near.empty()) least = least_heights(drop, near);
    for (const auto& [v, below] : near) {
      const double needed = least.empty() ? 0 : least[v];
      if (below.distance > std::max(low, needed)) continue;
      if (!wetted) wetted.emplace(drop, [&](std::uint32_t w) { return is_colliding(drop.contact()[w]); });
      if (!wetted->cover(below.point, below.normal, v)) continue;
      if (films.empty()) films.assign(drop.num_rows(), 0);
      films[v] = 1;
      const Vector3d solid_velocity = solid.velocity(time);
      if (below.distance > std::max(needed, touching_distance))
        stop(drop, v, below.normal, solid_velocity);
      else
        lift(drop, v, film_height(drop, v, below.point, below.normal, needed), below.point, below.normal,
             solid_velocity);
    }
  }
}

void stop_at_discs(Drop& drop, const std::vector<Solid>& solids, double time,
                   const std::function<Vector3d(std::uint32_t)>& before) {
  if (std::none_of(solids.begin(), solids.end(), [](const Solid& solid) { return solid.inflow.has_value(); })) return;
  constexpr double rounding = 1e-9;
  const Eigen::AlignedBox3d box = bounding_box(drop);
  for (const Solid& solid : solids) {
    if (!solid.inflow || !solid.is_near(box, time, 0)) continue;
    const double least_height = -rounding * solid.inflow->radius;
    for (std::uint32_t v = 0; v < drop.num_rows(); ++v) {
      if (drop.connectivity().degree(v) == 0 || is_colliding(drop.contact()[v])) continue;
      const Vector3d x = drop.positions().col(v);
      if (!solid.is_near(x, time, 0)) continue;
      const SolidContact contact = solid.query(x, time);
      if (contact.distance >= 0) continue;
      const bool was_in_front = contact.normal.dot(before(v) - contact.point) >= least_height;
      if (was_in_front) drop.positions().col(v) = contact.point;
    }
  }
}

void lift_landed(Drop& drop, const std::vector<Solid>& solids, double time, const std::vector<std::uint32_t>& landed,
                 const std::vector<std::uint8_t>& was_wetted) {
  if (landed.empty()) return;
  const WettedFaces wetted(drop, [&](std::uint32_t v) { return was_wetted[v] != 0; });
  if (wetted.empty()) return;
  for (const std::uint32_t v : landed) {
    std::int32_t& solid = drop.contact_solid()[v];
    const Solid& below = solids[static_cast<std::size_t>(solid)];
    const Vector3d p = drop.positions().col(v), n = drop.contact_normals().col(v);
    if (!wetted.cover(p, n, v)) continue;
    lift(drop, v, film_height(drop, v, p, n, 0), p, n, below.velocity(time));
    drop.contact()[v] = Contact::free;
    solid = -1;
  }
}

}  // namespace meniscus
