// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/operators/volume_correction.h"

#include "meniscus/core/chunks.h"
#include "meniscus/core/error.h"
#include "meniscus/geometry/flow_matrix.h"
#include "meniscus/geometry/rigid_motion.h"
#include "meniscus/state/offset_to_volume.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

using Eigen::Vector3d;

/// a_i = u_i . n_i (Eq 9), u without the rigid motion.
void normal_rates(const Drop& drop, const SurfaceGeometry& geometry, std::vector<double>& rate) {
  const ConstColumns x = drop.positions(), v = drop.velocities();
  const RigidMotion rigid = fit_rigid_motion(x, v, geometry);
  rate.resize(drop.num_rows());
  for (std::uint32_t i = 0; i < rate.size(); ++i) rate[i] = (v.col(i) - rigid.at(x.col(i))).dot(geometry.normal(i));
}

/// a_bar_i (Eq 10): the area-weighted mean over the neighbours of i.
double mean_rate(const Drop& drop, const SurfaceGeometry& geometry, const std::vector<double>& rate, std::uint32_t i) {
  const Ring ring = drop.connectivity().ring(i);
  double sum = 0, area = 0;
  for (int k = 0; k < ring.degree; ++k) {
    const double a = geometry.lumped_area(ring.neighbour[k]);
    sum += a * rate[ring.neighbour[k]];
    area += a;
  }
  return area > 0 ? sum / area : 0;
}

/// Eqs 9-11 as written: what they take away at each vertex (cm/s), into workspace.more_scalars.
void one_ring_mean_of_velocity(Drop& drop, const SurfaceGeometry& geometry) {
  std::vector<double>& rate = drop.workspace().scalars;
  std::vector<double>& mean = drop.workspace().more_scalars;
  normal_rates(drop, geometry, rate);
  mean.resize(drop.num_rows());
  for (std::uint32_t i = 0; i < mean.size(); ++i) mean[i] = mean_rate(drop, geometry, rate, i);
}

/// (M + r^2 L) q_bar = M q for the normal part q of the last flow; q_bar/dt into workspace.more_scalars.
void neighbourhood_mean_of_flow(Drop& drop, const SurfaceGeometry& geometry, double dt, const SolverOptions& solver) {
  Workspace& work = drop.workspace();
  const std::size_t n = drop.num_rows();
  const double length = 2 * 3 * drop.target_volume() / geometry.area();
  work.rhs.resize(n);
  work.solution.resize(n);
  work.more_scalars.resize(n);
  double flux = 0;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double q = drop.displacements().col(i).dot(geometry.normal(i)) * geometry.lumped_area(i);
    flux += q;
    work.rhs[i] = Lanes{q, 0, 0, 0};
  }
  std::fill(work.solution.begin(), work.solution.end(), Lanes{flux / geometry.area(), 0, 0, 0});
  assemble_flow_matrix(drop.connectivity(), geometry, length * length, true, work.matrix);
  const SolveReport report =
      work.solver.solve(drop.connectivity(), work.matrix, work.rhs.data(), work.solution.data(), nullptr, true, solver);
  if (!report.converged)
    throw NumericsError(
        fmt::format("drop {}: the local volume correction did not converge in {} iterations (residual {:.1e})",
                    drop.id(), report.iterations, report.relative_residual));
  for (std::size_t i = 0; i < n; ++i) work.more_scalars[i] = work.solution[i][0] / dt;
}

void correct_locally(Drop& drop, const SurfaceGeometry& geometry, double dt, const VolumeCorrectionOptions& options) {
  if (options.local == LocalCorrection::smooth_velocity)
    one_ring_mean_of_velocity(drop, geometry);
  else
    neighbourhood_mean_of_flow(drop, geometry, dt, options.solver);
  const std::vector<double>& excess = drop.workspace().more_scalars;
  Columns x = drop.positions(), v = drop.velocities();
  for (std::uint32_t i = 0; i < excess.size(); ++i) {
    if (!is_off_solids(drop, i)) continue;
    const Vector3d change = -excess[i] * geometry.normal(i);
    v.col(i) += change;
    x.col(i) += change * dt;
  }
}

/// dV/dd, and the flow's own change of the volume, which the limit does not count.
struct Flow {
  double area = 0, volume = 0;

  Flow& operator+=(const Flow& other) {
    area += other.area;
    volume += other.volume;
    return *this;
  }
};

/// Offsets the surface by d = (V_target - V)/A until the volume fits. Films have none to give: what is pushed through
/// the wetted area is lifted again, and the volume would never fit.
void correct_globally(Drop& drop, const SurfaceGeometry& geometry, double dt, double limit,
                      VolumeCorrectionReport& report) {
  const std::vector<std::uint8_t>& films = drop.workspace().films;
  const auto moves = [&](std::uint32_t i) { return is_off_solids(drop, i) && (films.empty() || films[i] == 0); };
  const Flow flow = sum_over_chunks(drop.num_rows(), Flow{}, [&](std::size_t begin, std::size_t end) {
    Flow part;
    const ConstColumns last = drop.displacements();
    for (auto i = static_cast<std::uint32_t>(begin); i < end; ++i) {
      if (!moves(i)) continue;
      part.area += geometry.area_vector(i).dot(geometry.normal(i)) / 3;
      part.volume += last.col(i).dot(geometry.area_vector(i)) / 3;
    }
    return part;
  });
  const double area = flow.area, target = drop.target_volume(), expected = area > 0 ? -flow.volume / area : 0;
  const VolumeOffset moved = offset_to_volume(drop, geometry, area, target, expected - limit, expected + limit, films);
  report.relative_error_before = moved.error_before / target;
  report.relative_error = moved.error / target;
  report.offset = moved.offset;
  report.limited = moved.limited;
  if (!(area > 0)) return;
  Columns v = drop.velocities();
  const double speed = report.offset / dt;
  for_each_chunk(drop.num_rows(), [&](std::size_t begin, std::size_t end) {
    for (auto i = static_cast<std::uint32_t>(begin); i < end; ++i)
      if (moves(i)) v.col(i) += speed * geometry.normal(i);
  });
}

}  // namespace

VolumeCorrectionReport correct_volume(Drop& drop, const SurfaceGeometry& geometry, double dt,
                                      const VolumeCorrectionOptions& options) {
  VolumeCorrectionReport report;
  using Method = VolumeCorrectionMethod;
  report.relative_error = std::numeric_limits<double>::quiet_NaN();
  if (drop.num_rows() == 0) return report;
  if (options.method == Method::local || options.method == Method::local_then_global)
    correct_locally(drop, geometry, dt, options);
  if (options.method == Method::global || options.method == Method::local_then_global)
    correct_globally(drop, geometry, dt, options.offset_limit, report);
  return report;
}

}  // namespace meniscus
