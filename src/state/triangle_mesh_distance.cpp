// SPDX-License-Identifier: GPL-3.0-or-later
#include "triangle_mesh_distance.h"

#include "meniscus/core/error.h"
#include "meniscus/geometry/inspect.h"
#include "near_triangles.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace meniscus {
namespace {

using Eigen::Vector3d;
using TreeKernel = CGAL::Simple_cartesian<double>;  // distances need no exact predicates
using TreeTriangles = std::vector<TreeKernel::Triangle_3>;
using TreePrimitive = CGAL::AABB_triangle_primitive<TreeKernel, TreeTriangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<TreeKernel, TreePrimitive>>;

TreeKernel::Point_3 tree_point(const Vector3d& x) { return {x.x(), x.y(), x.z()}; }

/// Where on a triangle a point is: 0-2 at that corner, 3-5 on the side from corner k - 3 to the next, 6 inside.
struct TrianglePoint {
  Vector3d point;
  int feature;
};
constexpr int on_face = 6;

/// The point of triangle p nearest to x: within a side's or a corner's region if the plane's point
/// lies outside, after the signs of the barycentric coordinates and of the sides' parameters.
TrianglePoint nearest_on_triangle(const std::array<Vector3d, 3>& p, const Vector3d& x) {
  const Vector3d normal = (p[1] - p[0]).cross(p[2] - p[0]);
  const double square = normal.squaredNorm();
  bool inside = square > 0;
  for (int k = 0; k < 3 && inside; ++k) inside = normal.dot((p[(k + 1) % 3] - p[k]).cross(x - p[k])) > 0;
  if (inside) return {x - normal * (normal.dot(x - p[0]) / square), on_face};
  TrianglePoint best{p[0], 0};
  double least = (x - p[0]).squaredNorm();
  for (int k = 0; k < 3; ++k) {
    const Vector3d side = p[(k + 1) % 3] - p[k];
    const double length = side.squaredNorm(), along = (x - p[k]).dot(side);
    TrianglePoint candidate{p[k], k};
    if (along >= length)
      candidate = {p[(k + 1) % 3], (k + 1) % 3};
    else if (along > 0)
      candidate = {p[k] + side * (along / length), 3 + k};
    const double distance = (x - candidate.point).squaredNorm();
    if (distance < least) least = distance, best = candidate;
  }
  return best;
}

/// How far a point is from a triangle at least: the quick answer for those that are not the nearest.
class TriangleBound {
 public:
  explicit TriangleBound(const std::array<Vector3d, 3>& p) : corner_(p) {
    normal_ = (p[1] - p[0]).cross(p[2] - p[0]).stableNormalized();
    for (int k = 0; k < 3; ++k) inward_[k] = normal_.cross(p[(k + 1) % 3] - p[k]).stableNormalized();
  }
  const std::array<Vector3d, 3>& corners() const { return corner_; }

  /// The square of at most the distance: from the plane, and from the strip along the side that x is beyond. `rounding`
  /// is what dot products of differences may be off by (cm).
  double squared_distance(const Vector3d& x, double rounding) const {
    double beyond = 0;
    for (int k = 0; k < 3; ++k) beyond = std::max(beyond, -inward_[k].dot(x - corner_[k]));
    const double height = std::max(0.0, std::abs(normal_.dot(x - corner_[0])) - rounding);
    beyond = std::max(0.0, beyond - rounding);
    return height * height + beyond * beyond;
  }

 private:
  std::array<Vector3d, 3> corner_, inward_;  // unit vectors in the plane, off the sides into the triangle
  Vector3d normal_;                          // zero, as those, without area
};

void check_mesh(const MeshData& data) {
  const Inspection inspection = inspect(data);
  if (inspection.bounds_volume) return;
  for (const auto& defect : inspection.defects)
    if (defect.kind != DefectKind::isolated_vertex && defect.kind != DefectKind::degenerate_face)
      throw GeometryError(
          fmt::format("a solid's mesh must bound a volume, but: {} ({})", defect.message, name(defect.kind)),
          defect.faces, defect.vertices);
  throw GeometryError("a solid's mesh must bound a volume");
}

}  // namespace

struct TriangleMeshDistance::Parts {
  explicit Parts(const MeshData& data) {
    for (const auto& p : data.points) points.push_back(Vector3d::Map(p.data()));
    triangles = data.triangles;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      const auto& [a, b, c] = triangles[t];
      const std::array<Vector3d, 3> p{points[a], points[b], points[c]};
      for (const auto& x : p) box.extend(x);
      tree_triangles.emplace_back(tree_point(p[0]), tree_point(p[1]), tree_point(p[2]));
      bounds.emplace_back(p);
    }
    add_normals();
    tree.insert(tree_triangles.begin(), tree_triangles.end());
    tree.build();
    tree.accelerate_distance_queries();
    add_near_triangles();
  }
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;
  ~Parts() = default;

  void add_near_triangles() {
    std::vector<NearTriangles::Candidate> balls;
    double edges = 0;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      const auto p = corners(t);
      const Vector3d center = (p[0] + p[1] + p[2]) / 3;
      double radius = 0;
      for (const auto& x : p) radius = std::max(radius, (x - center).norm());
      balls.push_back({static_cast<std::uint32_t>(t), center, radius * (1 + 1e-12)});
      edges += (p[1] - p[0]).norm();
    }
    near = std::make_unique<const NearTriangles>(
        box, std::move(balls), edges / static_cast<double>(triangles.size()),
        [this](const Vector3d& x) { return contact(x, nearest_in_tree(x)).distance; },
        [this](const Vector3d& x, double distance, std::vector<std::uint32_t>& found) {
          std::vector<TreeTriangles::const_iterator> all;
          tree.all_intersected_primitives(CGAL::Bbox_3(x[0] - distance, x[1] - distance, x[2] - distance,
                                                       x[0] + distance, x[1] + distance, x[2] + distance),
                                          std::back_inserter(all));
          for (const auto& t : all) found.push_back(static_cast<std::uint32_t>(t - tree_triangles.begin()));
        },
        [this](const Vector3d& x, std::uint32_t t) { return (nearest_on_triangle(corners(t), x).point - x).norm(); });
  }

  /// The nearest triangle to x, and the point on it.
  struct Nearest {
    std::size_t triangle;
    TrianglePoint on_it;
  };

  Nearest nearest_in_tree(const Vector3d& x) const {
    const auto found = tree.closest_point_and_primitive(tree_point(x)).second;
    const auto t = static_cast<std::size_t>(found - tree_triangles.begin());
    return {t, nearest_on_triangle(corners(t), x)};
  }

  Nearest nearest(const Vector3d& x) const {
    const NearTriangles::Cell* cell = near->at(x);
    if (cell == nullptr || cell->candidates.empty()) return nearest_in_tree(x);
    Nearest best{0, {Vector3d::Zero(), on_face}};
    double least2 = std::numeric_limits<double>::infinity(), least = least2;
    const double rounding = 1e-12 * (x.cwiseAbs().maxCoeff() + box.sizes().maxCoeff());
    const double off_middle = (x - cell->middle).norm() + rounding;
    for (const auto& [t, center, radius, from_middle] : cell->candidates) {
      if (from_middle > least + off_middle) break;
      const double apart = least + radius;
      if ((x - center).squaredNorm() >= apart * apart) continue;
      if (bounds[t].squared_distance(x, rounding) >= least2) continue;
      const TrianglePoint candidate = nearest_on_triangle(corners(t), x);
      const double distance2 = (x - candidate.point).squaredNorm();
      if (distance2 >= least2) continue;
      least2 = distance2;
      least = std::sqrt(distance2);
      best = {t, candidate};
    }
    return best;
  }

  SolidContact contact(const Vector3d& x, const Nearest& nearest) const {
    const Vector3d& pseudonormal = normals[nearest.triangle][static_cast<std::size_t>(nearest.on_it.feature)];
    const Vector3d away = x - nearest.on_it.point;
    const double distance = away.norm();
    const double side = away.dot(pseudonormal) < 0 ? -1 : 1;
    // At corners and sides the gradient is the direction itself, unless it is but rounding.
    const bool is_reliable = distance > 1e-9 * (x.cwiseAbs().maxCoeff() + box.sizes().maxCoeff());
    const bool use_direction = nearest.on_it.feature != on_face && is_reliable;
    return {side * distance, nearest.on_it.point, use_direction ? Vector3d(side / distance * away) : pseudonormal};
  }

  const std::array<Vector3d, 3>& corners(std::size_t t) const { return bounds[t].corners(); }

  /// Face normals; their sum at an edge; their sum weighted by the angle at a vertex. Only the
  /// direction counts. Faces without area have no say.
  void add_normals() {
    std::vector<Vector3d> vertex_normal(points.size(), Vector3d::Zero());
    std::map<std::array<std::uint32_t, 2>, Vector3d> edge_normal;
    const auto edge = [&](std::size_t t, int k) -> Vector3d& {
      const std::uint32_t a = triangles[t][k], b = triangles[t][(k + 1) % 3];
      return edge_normal.try_emplace({std::min(a, b), std::max(a, b)}, Vector3d::Zero()).first->second;
    };
    normals.resize(triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      const auto p = corners(t);
      const Vector3d normal = (p[1] - p[0]).cross(p[2] - p[0]).stableNormalized();
      normals[t][on_face] = normal;
      for (int k = 0; k < 3; ++k) {
        const Vector3d u = p[(k + 1) % 3] - p[k], w = p[(k + 2) % 3] - p[k];
        vertex_normal[triangles[t][k]] += std::atan2(u.cross(w).norm(), u.dot(w)) * normal;
        edge(t, k) += normal;
      }
    }
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) {
        normals[t][k] = vertex_normal[triangles[t][k]].stableNormalized();
        normals[t][3 + k] = edge(t, k).stableNormalized();
      }
  }

  std::vector<Vector3d> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::array<Vector3d, 7>> normals;  ///< of each triangle's corners, sides and face
  Eigen::AlignedBox3d box;
  std::vector<TriangleBound> bounds;
  TreeTriangles tree_triangles;
  Tree tree;
  std::unique_ptr<const NearTriangles> near;
};

TriangleMeshDistance::TriangleMeshDistance(const MeshData& data) {
  check_mesh(data);
  parts_ = std::make_unique<const Parts>(data);
}

TriangleMeshDistance::~TriangleMeshDistance() = default;

const Eigen::AlignedBox3d& TriangleMeshDistance::bounds() const { return parts_->box; }

SolidContact TriangleMeshDistance::query(const Vector3d& x) const { return parts_->contact(x, parts_->nearest(x)); }

bool TriangleMeshDistance::is_near(const Vector3d& x, double margin) const {
  if (parts_->box.exteriorDistance(x) > margin) return false;
  const NearTriangles::Cell* cell = parts_->near->at(x);
  return cell == nullptr || cell->clearance <= margin;
}

}  // namespace meniscus
