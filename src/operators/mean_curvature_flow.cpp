// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/operators/mean_curvature_flow.h"

#include "meniscus/core/chunks.h"
#include "meniscus/core/error.h"
#include "meniscus/geometry/flow_matrix.h"
#include "meniscus/operators/collision_constraint.h"

#include <fmt/format.h>

namespace meniscus {
namespace {

/// Which rows the solve holds at zero; nullptr if none.
const std::uint8_t* fixed_rows(Drop& drop, ContactInFlow contact_in_flow) {
  if (contact_in_flow == ContactInFlow::slide) return nullptr;
  std::vector<std::uint8_t>& fixed = drop.workspace().fixed;
  fixed.resize(drop.num_rows());
  bool any = false;
  for (std::size_t i = 0; i < fixed.size(); ++i) any |= (fixed[i] = is_colliding(drop.contact()[i])) != 0;
  return any ? fixed.data() : nullptr;
}

}  // namespace

SolveReport flow_by_mean_curvature(Drop& drop, const SurfaceGeometry& geometry, double dt,
                                   const MeanCurvatureFlowOptions& options) {
  const double step = options.coefficient * dt, viscous = options.viscosity * dt;
  const std::size_t n = drop.num_rows();
  if (step + viscous == 0 || n == 0) return {};
  Workspace& work = drop.workspace();
  work.rhs.resize(n);
  work.solution.resize(n);
  Columns x = drop.positions(), v = drop.velocities(), last = drop.displacements();

  assemble_flow_matrix(drop.connectivity(), geometry, step + viscous, options.clamp_negative_weights, work.matrix);
  if (viscous == 0) {
    curvature_right_hand_side(drop.connectivity(), work.matrix, x, work.rhs.data());
  } else {
    const double of_x = step / (step + viscous), of_v = viscous * dt / (step + viscous);
    for_each_chunk(n, [&](std::size_t begin, std::size_t end) {
      for (auto i = static_cast<Eigen::Index>(begin); i < static_cast<Eigen::Index>(end); ++i)
        work.solution[static_cast<std::size_t>(i)] = to_lanes(of_x * x.col(i) + of_v * v.col(i));
    });
    weighted_differences(drop.connectivity(), work.matrix, work.solution.data(), work.rhs.data());
  }
  const Eigen::Vector3d turning = viscous * dt * options.rotation;
  const bool pressed = options.body_pressure.mean != 0 || !options.body_pressure.gradient.isZero(0);
  for_each_chunk(n, [&](std::size_t begin, std::size_t end) {
    for (auto i = static_cast<std::uint32_t>(begin); i < end; ++i) {
      if (pressed) work.rhs[i] += to_lanes(step / 3 * options.body_pressure.at(x.col(i)) * geometry.area_vector(i));
      if (viscous != 0) work.rhs[i] += to_lanes(turning.cross(geometry.area_gradient(i)));
      work.solution[i] = to_lanes(last.col(i));
    }
  });
  const std::uint8_t* const fixed = fixed_rows(drop, options.contact);
  const SolveReport report = work.solver.solve(drop.connectivity(), work.matrix, work.rhs.data(), work.solution.data(),
                                               fixed, drop.flow_pattern_changed(), options.solver);
  if (!report.converged)
    throw NumericsError(
        fmt::format("drop {}: curvature flow did not converge in {} iterations (residual {:.1e}); use a "
                    "smaller time step or a looser solver tolerance",
                    drop.id(), report.iterations, report.relative_residual));

  const Eigen::Vector3d shift =
      fixed ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : missing_translation(geometry, work.rhs, work.solution);
  const double per_second = dt > 0 ? 1 / dt : 0;
  for_each_chunk(n, [&](std::size_t begin, std::size_t end) {
    for (auto i = static_cast<std::uint32_t>(begin); i < end; ++i) {
      if (drop.connectivity().degree(i) == 0) continue;
      const Eigen::Vector3d move = constrain_to_solid(drop, i, to_eigen(work.solution[i]) + shift);
      last.col(i) = move;
      x.col(i) += move;
      v.col(i) += move * per_second;
    }
  });
  return report;
}

}  // namespace meniscus
