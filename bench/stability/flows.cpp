// SPDX-License-Identifier: GPL-3.0-or-later
#include "flows.h"

#include "meniscus/core/error.h"
#include "meniscus/geometry/flow_matrix.h"
#include "meniscus/operators/mean_curvature_flow.h"

#include <CGAL/boost/graph/Euler_operations.h>
#include <Eigen/Sparse>

#include <cmath>
#include <deque>

namespace meniscus::bench {
namespace {

using Eigen::Vector3d;

/// The cotangent of the angle opposite to side a of a triangle of sides a, b, c.
double cotangent(double a, double b, double c) {
  const double s = 0.5 * (a + b + c), area = std::sqrt(std::max(0.0, s * (s - a) * (s - b) * (s - c)));
  return area > 0 ? (b * b + c * c - a * a) / (4 * area) : 0;
}

/// A surface as a halfedge mesh with lengths instead of positions: its edges can be flipped within the surface.
class IntrinsicTriangulation {
 public:
  explicit IntrinsicTriangulation(const Mesh& mesh) : mesh_(mesh), length_(mesh.num_edges()) {
    for (const auto e : mesh.edges())
      length_[e] = (to_eigen(mesh.point(mesh.vertex(e, 0))) - to_eigen(mesh.point(mesh.vertex(e, 1)))).norm();
  }

  /// Flips until no edge has a negative weight (or, for input beyond rounding, a bound is met).
  void flip_to_delaunay() {
    std::deque<Mesh::Edge_index> queue(mesh_.edges().begin(), mesh_.edges().end());
    std::vector<bool> queued(mesh_.num_edges(), true);
    for (std::size_t budget = 50 * queue.size(); !queue.empty() && budget > 0; --budget) {
      const auto e = queue.front();
      queue.pop_front();
      queued[e] = false;
      if (weight(e) >= -1e-9 || !flip(e)) continue;
      const auto h = mesh_.halfedge(e);
      for (const auto near :
           {mesh_.next(h), mesh_.prev(h), mesh_.next(mesh_.opposite(h)), mesh_.prev(mesh_.opposite(h))})
        if (const auto edge = mesh_.edge(near); !queued[edge]) {
          queued[edge] = true;
          queue.push_back(edge);
        }
    }
  }

  /// (cot alpha + cot beta)/2.
  double weight(Mesh::Edge_index e) const {
    const auto h = mesh_.halfedge(e);
    return 0.5 * (opposite_cotangent(h) + opposite_cotangent(mesh_.opposite(h)));
  }

  const Mesh& mesh() const { return mesh_; }

 private:
  double length(Mesh::Halfedge_index h) const { return length_[mesh_.edge(h)]; }
  double opposite_cotangent(Mesh::Halfedge_index h) const {
    return cotangent(length(h), length(mesh_.next(h)), length(mesh_.prev(h)));
  }
  double corner(double opposite, double a, double b) const {  // the angle between a and b
    return std::acos(std::clamp((a * a + b * b - opposite * opposite) / (2 * a * b), -1.0, 1.0));
  }
  bool flip(Mesh::Edge_index e) {
    const auto h = mesh_.halfedge(e), o = mesh_.opposite(h);
    if (mesh_.degree(mesh_.source(h)) < 3 || mesh_.degree(mesh_.target(h)) < 3) return false;
    const double l = length(h), a = length(mesh_.next(h)), b = length(mesh_.prev(h));
    const double c = length(mesh_.next(o)),
                 d = length(mesh_.prev(o));  // c leaves the source of h, d ends at its target
    const double at_source = corner(a, l, b) + corner(d, l, c);
    const double flipped = std::sqrt(std::max(0.0, b * b + c * c - 2 * b * c * std::cos(at_source)));
    if (!(flipped > 0)) return false;
    CGAL::Euler::flip_edge(h, mesh_);
    length_[mesh_.edge(h)] = flipped;
    return true;
  }

  Mesh mesh_;
  std::vector<double> length_;
};

void step_intrinsic(Drop& drop, double s) {
  IntrinsicTriangulation intrinsic(drop.mesh());
  intrinsic.flip_to_delaunay();
  SurfaceGeometry geometry;
  geometry.compute(std::as_const(drop).positions(), drop.connectivity());
  const auto n = static_cast<Eigen::Index>(drop.num_rows());
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index i = 0; i < n; ++i) entries.emplace_back(i, i, geometry.lumped_area(static_cast<std::uint32_t>(i)));
  for (const auto e : intrinsic.mesh().edges()) {
    const auto i = static_cast<Eigen::Index>(intrinsic.mesh().vertex(e, 0));
    const auto j = static_cast<Eigen::Index>(intrinsic.mesh().vertex(e, 1));
    const double w = s * intrinsic.weight(e);
    if (i == j) continue;
    entries.emplace_back(i, i, w);
    entries.emplace_back(j, j, w);
    entries.emplace_back(i, j, -w);
    entries.emplace_back(j, i, -w);
  }
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(matrix);
  if (factor.info() != Eigen::Success) throw NumericsError("the intrinsic matrix is not positive definite");
  Columns x = drop.positions();
  Eigen::MatrixX3d right(n, 3);
  for (Eigen::Index i = 0; i < n; ++i)
    right.row(i) = geometry.lumped_area(static_cast<std::uint32_t>(i)) * x.col(i).transpose();
  x = factor.solve(right).transpose();
}

/// Flips edges of negative weight where that makes no edge twice.
void flip_extrinsically(Drop& drop) {
  Mesh& mesh = drop.mesh();
  bool any = false;
  for (int pass = 0; pass < 10; ++pass) {
    const IntrinsicTriangulation lengths(mesh);
    std::vector<bool> touched(mesh.num_faces(), false);
    bool flipped = false;
    for (const auto e : mesh.edges()) {
      const auto h = mesh.halfedge(e), o = mesh.opposite(h);
      if (lengths.weight(e) >= 0 || touched[mesh.face(h)] || touched[mesh.face(o)]) continue;
      const auto a = mesh.target(mesh.next(h)), b = mesh.target(mesh.next(o));
      if (mesh.halfedge(a, b) != Mesh::null_halfedge() || mesh.degree(mesh.source(h)) < 4 ||
          mesh.degree(mesh.target(h)) < 4)
        continue;
      touched[mesh.face(h)] = touched[mesh.face(o)] = true;
      CGAL::Euler::flip_edge(h, mesh);
      flipped = any = true;
    }
    if (!flipped) break;
  }
  if (!any) return;
  drop.connectivity().rebuild(mesh);
  drop.topology_changed();
}

void step_explicit(Drop& drop, const SurfaceGeometry& geometry, double s) {
  Workspace& work = drop.workspace();
  assemble_flow_matrix(drop.connectivity(), geometry, s, false, work.matrix);
  work.rhs.resize(drop.num_rows());
  Columns x = drop.positions();
  curvature_right_hand_side(drop.connectivity(), work.matrix, x, work.rhs.data());
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i) x.col(i) += to_eigen(work.rhs[i]) / geometry.lumped_area(i);
}

}  // namespace

void PureFlow::step_fixed(Drop& drop) {
  const SurfaceGeometry& geometry = drop.workspace().geometry;
  if (!has_first_) assemble_flow_matrix(drop.connectivity(), geometry, s_, false, first_);
  has_first_ = true;
  Workspace& work = drop.workspace();
  work.matrix = first_;
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i) {
    double sum = 0;
    const int degree = drop.connectivity().degree(i);
    const double* const row = ring_weights(first_, drop.connectivity(), i);
    for (int k = 0; k < degree; ++k) sum += row[k];
    work.matrix.diagonal[i] = geometry.lumped_area(i) + sum;
  }
  Columns x = drop.positions();
  work.rhs.resize(drop.num_rows());
  work.solution.assign(drop.num_rows(), Lanes{});
  curvature_right_hand_side(drop.connectivity(), work.matrix, x, work.rhs.data());
  const SolveReport report = work.solver.solve(drop.connectivity(), work.matrix, work.rhs.data(), work.solution.data(),
                                               nullptr, false, SolverOptions());
  if (!report.converged) throw NumericsError("the fixed stiffness' solve did not converge");
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i) x.col(i) += to_eigen(work.solution[i]);
}

void PureFlow::step(Drop& drop) {
  if (flow_ == Flow::extrinsic_delaunay) flip_extrinsically(drop);
  SurfaceGeometry& geometry = drop.workspace().geometry;
  geometry.compute(std::as_const(drop).positions(), drop.connectivity());
  if (flow_ == Flow::explicit_euler) return step_explicit(drop, geometry, s_);
  if (flow_ == Flow::intrinsic_delaunay) return step_intrinsic(drop, s_);
  if (flow_ == Flow::fixed_stiffness) return step_fixed(drop);
  MeanCurvatureFlowOptions options;
  options.coefficient = s_;
  options.clamp_negative_weights = flow_ == Flow::clamped;
  flow_by_mean_curvature(drop, geometry, 1, options);
}

}  // namespace meniscus::bench
