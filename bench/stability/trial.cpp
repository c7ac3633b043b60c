// SPDX-License-Identifier: GPL-3.0-or-later
#include "trial.h"

#include "meniscus/core/error.h"
#include "meniscus/geometry/inspect.h"
#include "meniscus/operators/damping.h"
#include "meniscus/operators/external_forces.h"
#include "meniscus/operators/volume_correction.h"

#include <Eigen/Geometry>

#include <cmath>
#include <random>

namespace meniscus::bench {
namespace {

using Eigen::Vector3d;

constexpr double most_flipped = 1e-3, most_growth_in_flow = 1e-6, most_growth = 1.5, most_volume_error = 0.05;
constexpr double least_time = 0.05;  // s, of a level

std::vector<Vector3d> area_vectors(const Drop& drop) {
  const ConstColumns x = drop.positions();
  std::vector<Vector3d> all;
  for (const auto& t : drop.connectivity().triangles())
    all.push_back(t[0] == Connectivity::removed
                      ? Vector3d(Vector3d::Zero())
                      : Vector3d(0.5 * (x.col(t[1]) - x.col(t[0])).cross(x.col(t[2]) - x.col(t[0]))));
  return all;
}

double area_of(const std::vector<Vector3d>& faces) {
  double area = 0;
  for (const Vector3d& face : faces) area += face.norm();
  return area;
}

/// Of the area before a step, the share whose faces turned by more than 90 degrees.
double turned_share(const std::vector<Vector3d>& before, const std::vector<Vector3d>& after) {
  double turned = 0;
  for (std::size_t f = 0; f < before.size(); ++f)
    if (before[f].dot(after[f]) < 0) turned += before[f].norm();
  return turned / area_of(before);
}

bool is_finite(const Drop& drop) { return drop.positions().allFinite() && drop.velocities().allFinite(); }

bool is_sound(const Drop& drop) {
  std::vector<Drop> one;
  one.push_back(drop);
  return inspect(to_mesh_data(one)).sound;
}

double tension_over_mass(const TrialCase& trial) { return 2 * trial.tension / trial.radius; }

/// Runs steps of `step` on a drop and judges each; `may_grow` says whether the area may.
template <class Step>
TrialResult run(Drop drop, const TrialCase& trial, bool keeps_volume, bool may_grow, Step step) {
  TrialResult result;
  const double volume = drop.volume();
  std::vector<Vector3d> before = area_vectors(drop);
  try {
    for (; result.steps < trial.steps; ++result.steps) {
      step(drop);
      if (!is_finite(drop)) return {Failure::not_finite, result.steps};
      std::vector<Vector3d> after = area_vectors(drop);
      const double area = area_of(after), growth = area / area_of(before);
      if (turned_share(before, after) > most_flipped) return {Failure::flipped, result.steps};
      if (growth > (may_grow ? most_growth : 1 + most_growth_in_flow)) return {Failure::area_grown, result.steps};
      if (keeps_volume && std::abs(drop.volume() / volume - 1) > most_volume_error)
        return {Failure::volume_lost, result.steps};
      if (std::abs(drop.volume()) < 1e-6 * volume) return result;  // shrunk to a point: nothing left to fail
      before = std::move(after);
    }
  } catch (const NumericsError&) {
    result.failure = Failure::solver;
  }
  return result;
}

/// One step beside a volume correction: advect, flow with c dt, correct.
void corrected_step(Drop& drop, PureFlow& flow, double dt, const VolumeCorrectionOptions& options,
                    bool positions_only) {
  drop.positions() += dt * drop.velocities();
  const Eigen::Matrix3Xd old = drop.positions();
  flow.step(drop);
  drop.velocities() += (drop.positions() - old) / dt;
  SurfaceGeometry& geometry = drop.workspace().geometry;
  geometry.compute(std::as_const(drop).positions(), drop.connectivity());
  const Eigen::Matrix3Xd velocities = drop.velocities();
  correct_volume(drop, geometry, dt, options);
  if (positions_only) drop.velocities() = velocities;
}

void set_random_velocities(Drop& drop, unsigned seed) {
  std::mt19937 generator(seed);
  Columns v = drop.velocities();
  for (Eigen::Index i = 0; i < v.cols(); ++i)
    for (int k = 0; k < 3; ++k) v(k, i) = 20 * (generator() / 4294967296.0 - 0.5);
}

TrialResult try_viscosity(Drop drop, const TrialCase& trial) {
  set_random_velocities(drop, trial.seed);
  SurfaceGeometry geometry;
  geometry.compute(std::as_const(drop).positions(), drop.connectivity());
  DampingOptions options;
  options.viscosity_coefficient = 2.456;
  const auto energy = [&] {
    double sum = 0;
    for (std::uint32_t i = 0; i < drop.num_rows(); ++i)
      sum += geometry.lumped_area(i) * drop.velocities().col(i).squaredNorm();
    return sum;
  };
  TrialResult result;
  try {
    for (double before = energy(); result.steps < trial.steps; ++result.steps) {
      apply_damping(drop, geometry, trial.time_step, options);
      if (!is_finite(drop)) return {Failure::not_finite, result.steps};
      const double after = energy();
      if (after > before * (1 + 1e-5)) return {Failure::energy_grown, result.steps};
      before = after;
    }
  } catch (const NumericsError&) {
    result.failure = Failure::solver;
  }
  return result;
}

}  // namespace

const char* failure_name(Failure failure) {
  constexpr const char* names[] = {"none",         "not finite",  "solver",  "flipped", "area grown",
                                   "energy grown", "volume lost", "unsound", "error"};
  return names[static_cast<std::size_t>(failure)];
}

TrialResult try_flow(Flow flow, const TrialCase& trial) {
  PureFlow method(flow, tension_over_mass(trial) * trial.time_step * trial.time_step);
  return run(Drop(test_spheroid(trial.quality, trial.radius, trial.edge, trial.seed)), trial, false, false,
             [&](Drop& drop) { method.step(drop); });
}

TrialResult try_operator(Operator which, const TrialCase& trial) {
  Drop drop(test_spheroid(trial.quality, trial.radius, trial.edge, trial.seed));
  if (which == Operator::viscosity) return try_viscosity(std::move(drop), trial);
  PureFlow flow(Flow::clamped, tension_over_mass(trial) * trial.time_step * trial.time_step);
  VolumeCorrectionOptions options;
  options.offset_limit = 0.25 * trial.radius;
  if (which == Operator::local_as_written) {
    options.method = VolumeCorrectionMethod::local_then_global;
    options.local = LocalCorrection::smooth_velocity;
  }
  TrialCase longer = trial;  // what the correction does to velocities shows after a few steps only
  longer.steps = 4 * trial.steps;
  return run(std::move(drop), longer, true, true, [&](Drop& moving) {
    corrected_step(moving, flow, trial.time_step, options, which == Operator::global_positions_only);
  });
}

TrialResult try_level(Level level, bool on_plane, const TrialCase& trial) {
  StepOptions options;
  options.level = level;
  options.liquid.surface_tension = trial.tension;
  options.band = {0.5 * trial.edge, 1.5 * trial.edge, 0.5};
  if (!on_plane) options.gravity.setZero();
  // What the paper's coefficient stands for: its tension grows with gamma, so it is scaled as the liquid's is.
  options.paper.curvature_flow_coefficient *= trial.tension / 72;
  Mesh mesh = test_spheroid(trial.quality, trial.radius, trial.edge, trial.seed);
  std::vector<Solid> solids;
  if (on_plane) {
    Columns x = positions(mesh);
    x.row(2).array() -= x.row(2).minCoeff();
    solids.push_back(Solid::plane(Vector3d::Zero(), Vector3d::UnitZ()));
    solids[0].advancing_angle = solids[0].receding_angle = M_PI / 3;
  }
  std::vector<Drop> drops;
  drops.emplace_back(std::move(mesh));
  if (on_plane) drops[0].velocities().row(2).setConstant(-30);
  const double volume = drops[0].volume(), area = area_of(area_vectors(drops[0]));
  TrialResult result;
  Remesher remesher;
  StepReport report;
  const auto ended = [&](Failure failure) { return TrialResult{failure, result.steps, report.recoveries}; };
  // Long enough for a drop to hit the plane and spread, whatever the step.
  const int steps = std::max(trial.steps, static_cast<int>(std::lround(least_time / trial.time_step)));
  try {
    for (; result.steps < steps; ++result.steps) {
      std::vector<Drop> next;
      for (Drop& drop : drops)
        for (Drop& piece : step_drop(std::move(drop), solids, (result.steps + 1) * trial.time_step, trial.time_step,
                                     options, remesher, report))
          next.push_back(std::move(piece));
      drops = std::move(next);
      double new_volume = 0, new_area = 0;
      for (const Drop& drop : drops) {
        if (!is_finite(drop)) return ended(Failure::not_finite);
        new_volume += drop.volume();
        new_area += area_of(area_vectors(drop));
      }
      if (new_area > most_growth * area * (on_plane ? 2 : 1)) return ended(Failure::area_grown);
      if (std::abs(new_volume / volume - 1) > most_volume_error) return ended(Failure::volume_lost);
    }
    for (const Drop& drop : drops)
      if (!is_sound(drop)) return ended(Failure::unsound);
  } catch (const Error&) {
    return ended(Failure::error);
  }
  return ended(Failure::none);
}

}  // namespace meniscus::bench
