// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/operators/damping.h"

#include "meniscus/core/error.h"
#include "meniscus/geometry/flow_matrix.h"
#include "meniscus/operators/collision_constraint.h"
#include "meniscus/state/free_rigid_motion.h"

#include <fmt/format.h>

#include <algorithm>

namespace meniscus {
namespace {

using Eigen::Vector3d;

/// The largest L_ii / M_ii (1/cm^2) of a matrix M + s L, times s.
double stiffest_row(const RingMatrix& matrix, const SurfaceGeometry& geometry) {
  double stiffest = 0;
  for (std::size_t i = 0; i < matrix.diagonal.size(); ++i) {
    const double mass = geometry.lumped_area(static_cast<std::uint32_t>(i));
    if (mass > 0) stiffest = std::max(stiffest, matrix.diagonal[i] / mass - 1);
  }
  return stiffest;
}

/// The change of velocity by viscosity over the step, eta dt Lap(v), into workspace.solution.
DampingReport viscous_change(Drop& drop, const SurfaceGeometry& geometry, const Columns& v, double dt,
                             const DampingOptions& options) {
  DampingReport report;
  Workspace& work = drop.workspace();
  const std::size_t n = drop.num_rows();
  work.rhs.resize(n);
  work.solution.resize(n);
  assemble_flow_matrix(drop.connectivity(), geometry, options.viscosity_coefficient * dt, true, work.matrix);
  curvature_right_hand_side(drop.connectivity(), work.matrix, v, work.rhs.data());
  report.implicit = stiffest_row(work.matrix, geometry) > 0.5;
  if (!report.implicit) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const double mass = geometry.lumped_area(i);
      work.solution[i] = mass > 0 ? work.rhs[i] / mass : Lanes{};
    }
    return report;
  }
  std::fill(work.solution.begin(), work.solution.end(), Lanes{});
  report.solve = work.solver.solve(drop.connectivity(), work.matrix, work.rhs.data(), work.solution.data(), nullptr,
                                   true, options.solver);
  if (!report.solve.converged)
    throw NumericsError(fmt::format("drop {}: the viscous solve did not converge in {} iterations (residual {:.1e})",
                                    drop.id(), report.solve.iterations, report.solve.relative_residual));
  return report;
}

/// The paper's extra viscosity: vertices of poor quality take on part of their neighbours' mean.
std::size_t smooth_poor_vertices(Drop& drop, Columns& v, double share) {
  const std::uint8_t* poor = drop.poor_quality();
  std::vector<Vector3d>& mean = drop.workspace().vectors;
  mean.resize(drop.num_rows());
  std::size_t smoothed = 0;
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i) {
    if (!poor[i]) continue;
    const Ring ring = drop.connectivity().ring(i);
    mean[i].setZero();
    for (int k = 0; k < ring.degree; ++k) mean[i] += v.col(ring.neighbour[k]);
    mean[i] /= std::max(ring.degree, 1);
  }
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i) {
    if (!poor[i] || drop.connectivity().degree(i) == 0) continue;
    v.col(i) += constrain_to_solid(drop, i, share * (mean[i] - v.col(i)));
    ++smoothed;
  }
  return smoothed;
}

}  // namespace

DampingReport apply_damping(Drop& drop, const SurfaceGeometry& geometry, double dt, const DampingOptions& options) {
  DampingReport report;
  Columns v = drop.velocities();
  const RigidMotion rigid = options.keep_rigid_motion ? free_rigid_motion(drop, geometry) : RigidMotion{};
  const bool viscous = options.viscosity_coefficient * dt > 0;
  if (viscous) {
    if (options.keep_rigid_motion)
      for (Eigen::Index i = 0; i < v.cols(); ++i) v.col(i) -= rigid.at(drop.positions().col(i));
    report = viscous_change(drop, geometry, v, dt, options);
    if (options.keep_rigid_motion)
      for (Eigen::Index i = 0; i < v.cols(); ++i) v.col(i) += rigid.at(drop.positions().col(i));
  }
  const double factor = std::max(0.0, 1 - options.damping_rate * dt);
  const auto n = static_cast<std::uint32_t>(drop.num_rows());
  for (std::uint32_t i = 0; i < n; ++i) {
    if (drop.connectivity().degree(i) == 0) continue;
    const Vector3d base = rigid.at(drop.positions().col(i));
    const Vector3d u = v.col(i) - base;
    Vector3d u_new = factor * u;
    if (viscous) u_new += to_eigen(drop.workspace().solution[i]);
    v.col(i) += constrain_to_solid(drop, i, u_new - u);
  }
  if (options.poor_quality_smoothing > 0)
    report.smoothed = smooth_poor_vertices(drop, v, options.poor_quality_smoothing);
  return report;
}

}  // namespace meniscus
