// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/operators/damping.h"

#include "meniscus/core/chunks.h"
#include "meniscus/core/error.h"
#include "meniscus/geometry/flow_matrix.h"
#include "meniscus/operators/collision_constraint.h"

#include <fmt/format.h>

#include <algorithm>

namespace meniscus {
namespace {

using Eigen::Vector3d;

/// The viscous solve stops here even if more is asked for: viscosity is a damping rate fitted to some per cent.
constexpr double least_tolerance = 1e-3;

/// A sum that is the largest term.
struct Largest {
  double value = 0;

  Largest& operator+=(const Largest& other) {
    value = std::max(value, other.value);
    return *this;
  }
};

/// The explicit change eta dt Lap(v) into workspace.solution. Returns the largest eta dt L_ii / M_ii.
double explicit_change(Drop& drop, const SurfaceGeometry& geometry, double step) {
  const Connectivity& connectivity = drop.connectivity();
  const ConstColumns v = std::as_const(drop).velocities();
  const RingMatrix& weights = geometry.edge_weights();
  Lanes* const change = drop.workspace().solution.data();
  const auto stiffness_of = [&](std::uint32_t i) {
    const Ring ring = connectivity.ring(i);
    const double mass = geometry.lumped_area(i);
    change[i] = Lanes{};
    if (!(mass > 0)) return 0.0;
    const double* const weight = ring_weights(weights, connectivity, i);
    const Vector3d own = v.col(i);
    Vector3d sum = Vector3d::Zero();
    double stiffness = 0;
    for (int k = 0; k < ring.degree; ++k) {
      const double w = std::max(weight[k], 0.0);
      stiffness += w;
      sum += w * (v.col(ring.neighbour[k]) - own);
    }
    change[i] = to_lanes(step / mass * sum);
    return step * stiffness / mass;
  };
  return sum_over_chunks(drop.num_rows(), Largest{},
                         [&](std::size_t begin, std::size_t end) {
                           Largest stiffest;
                           for (auto i = static_cast<std::uint32_t>(begin); i < end; ++i)
                             stiffest += Largest{stiffness_of(i)};
                           return stiffest;
                         })
      .value;
}

/// The change of velocity by viscosity over the step, eta dt Lap(v), into workspace.solution.
DampingReport viscous_change(Drop& drop, const SurfaceGeometry& geometry, double dt, const DampingOptions& options) {
  DampingReport report;
  Workspace& work = drop.workspace();
  const std::size_t n = drop.num_rows();
  work.rhs.resize(n);
  work.solution.resize(n);
  const double step = options.viscosity_coefficient * dt;
  report.implicit = explicit_change(drop, geometry, step) > 0.5;
  if (!report.implicit) return report;
  assemble_flow_matrix(drop.connectivity(), geometry, step, true, work.matrix);
  for_each_chunk(n, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      work.rhs[i] = geometry.lumped_area(static_cast<std::uint32_t>(i)) * work.solution[i];
      work.solution[i] = Lanes{};
    }
  });
  SolverOptions solver = options.solver;
  solver.tolerance = std::max(solver.tolerance, least_tolerance);
  report.solve =
      work.solver.solve(drop.connectivity(), work.matrix, work.rhs.data(), work.solution.data(), nullptr, true, solver);
  if (!report.solve.converged)
    throw NumericsError(fmt::format("drop {}: the viscous solve did not converge in {} iterations (residual {:.1e})",
                                    drop.id(), report.solve.iterations, report.solve.relative_residual));
  const Lanes shift = to_lanes(missing_translation(geometry, work.rhs, work.solution));
  for (Lanes& change : work.solution) change += shift;
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
  const bool viscous = options.viscosity_coefficient * dt > 0;
  if (viscous) report = viscous_change(drop, geometry, dt, options);
  const double taken = std::min(1.0, options.damping_rate * dt);
  if (viscous || taken > 0)
    for_each_chunk(drop.num_rows(), [&](std::size_t begin, std::size_t end) {
      for (auto i = static_cast<std::uint32_t>(begin); i < end; ++i) {
        if (drop.connectivity().degree(i) == 0) continue;
        Vector3d change = -taken * v.col(i);
        if (viscous) change += to_eigen(drop.workspace().solution[i]);
        v.col(i) += constrain_to_solid(drop, i, change);
      }
    });
  if (options.poor_quality_smoothing > 0)
    report.smoothed = smooth_poor_vertices(drop, v, options.poor_quality_smoothing);
  return report;
}

}  // namespace meniscus
