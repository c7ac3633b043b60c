// SPDX-License-Identifier: GPL-3.0-or-later
// Each stage of a step on its own, by Google Benchmark: bench_operators [--quick] [--benchmark_filter=REGEX ...].
// Arguments are triangles; "flight" is a drop of R = 0.2 cm that oscillates, "rest" a cap of 90 degrees on a plane.
// Before each iteration the drop is put back, off the clock. The column tri/s counts triangles a second.
#include "meniscus/geometry/flow_matrix.h"
#include "meniscus/geometry/rigid_motion.h"
#include "meniscus/operators/contact_angle.h"
#include "meniscus/operators/damping.h"
#include "meniscus/operators/external_forces.h"
#include "meniscus/operators/mean_curvature_flow.h"
#include "meniscus/operators/pressure.h"
#include "meniscus/operators/tangential_damping.h"
#include "meniscus/operators/volume_correction.h"
#include "meniscus/state/free_rigid_motion.h"
#include "meniscus/topology/face_changes.h"
#include "meniscus/topology/remesh.h"
#include "step_scenes.h"

#include <benchmark/benchmark.h>

#include <cstring>

namespace {

using namespace meniscus;

/// A drop a few steps into a run, and what a step has ready when an operator is called.
struct Fixture {
  explicit Fixture(Simulation simulation, double time_step)
      : solids(simulation.solids()), time(simulation.time()), dt(time_step), drop(simulation.drops().front()) {
    geometry.compute(std::as_const(drop).positions(), drop.connectivity());
    x = drop.positions();
    v = drop.velocities();
    last = drop.displacements();
    const double length = 3 * drop.volume() / geometry.area();
    tension = 2 * 72 / length;
    pressure.mean = mean_pressure(drop, geometry, pressure);
    assemble_flow_matrix(drop.connectivity(), geometry, tension * dt * dt, true, matrix);
    rhs.resize(drop.num_rows());
    curvature_right_hand_side(drop.connectivity(), matrix, std::as_const(drop).positions(), rhs.data());
  }

  void put_back() {
    drop.positions() = x;
    drop.velocities() = v;
    drop.displacements() = last;
  }

  std::vector<Solid> solids;
  double time, dt, tension = 0;
  Drop drop;
  SurfaceGeometry geometry;
  BodyPressure pressure;
  RingMatrix matrix;
  std::vector<Lanes> rhs;
  Eigen::Matrix3Xd x, v, last;
};

Fixture in_flight(std::int64_t triangles, Level level = Level::calibrated) {
  const auto setting =
      bench::free_flight(static_cast<int>(std::lround(std::sqrt(static_cast<double>(triangles) / 20))), level);
  Simulation simulation = setting.simulation();
  for (int k = 0; k < 5; ++k) simulation.step();
  return Fixture(std::move(simulation), setting.scene.time_step);
}

Fixture at_rest(std::int64_t triangles) {
  constexpr double radius = 0.2;
  bench::Setting setting;
  Scene& scene = setting.scene = default_scene();
  const double edge = std::sqrt(3.5 * pi * radius * radius / static_cast<double>(triangles) / (std::sqrt(3.0) / 4));
  scene.mesh.edge_min = 0.5 * edge;
  scene.mesh.edge_max = 1.5 * edge;
  scene.time_step = edge / std::sqrt(2 * 72 / radius);
  scene.solids.emplace_back();
  scene.solids.front().name = "plane";
  DropSpec cap;
  cap.shape = DropShape::cap;
  cap.on = "plane";
  cap.radius = radius;
  scene.drops.push_back(cap);
  Simulation simulation(scene);
  for (int k = 0; k < 5; ++k) simulation.step();
  return Fixture(std::move(simulation), scene.time_step);
}

/// Times `work` on a drop that is put back each time.
template <class Work>
void run(benchmark::State& state, Fixture fixture, Work work) {
  for (auto _ : state) {
    state.PauseTiming();
    fixture.put_back();
    state.ResumeTiming();
    work(fixture);
  }
  state.counters["tri/s"] = benchmark::Counter(static_cast<double>(fixture.drop.mesh().number_of_faces()),
                                               benchmark::Counter::kIsIterationInvariantRate);
}

void flight_geometry(benchmark::State& state) {
  run(state, in_flight(state.range(0)),
      [](Fixture& f) { f.geometry.compute(std::as_const(f.drop).positions(), f.drop.connectivity()); });
}

void flight_mean_pressure(benchmark::State& state) {
  run(state, in_flight(state.range(0)),
      [](Fixture& f) { benchmark::DoNotOptimize(mean_pressure(f.drop, f.geometry, BodyPressure())); });
}

void flight_rigid_motion(benchmark::State& state) {
  run(state, in_flight(state.range(0)), [](Fixture& f) {
    benchmark::DoNotOptimize(fit_rigid_motion(f.drop.positions(), f.drop.velocities(), f.geometry));
  });
}

void flight_assembly(benchmark::State& state) {
  run(state, in_flight(state.range(0)), [](Fixture& f) {
    assemble_flow_matrix(f.drop.connectivity(), f.geometry, f.tension * f.dt * f.dt, true, f.matrix);
  });
}

void flight_product(benchmark::State& state) {
  std::vector<Lanes> product;
  run(state, in_flight(state.range(0)), [&](Fixture& f) {
    product.resize(f.rhs.size());
    multiply(f.drop.connectivity(), f.matrix, f.rhs.data(), product.data());
    benchmark::DoNotOptimize(product.data());
  });
}

void flight_solve_from_zero(benchmark::State& state) {
  SpdSolver solver;
  std::vector<Lanes> solution;
  int iterations = 0;
  run(state, in_flight(state.range(0)), [&](Fixture& f) {
    solution.assign(f.rhs.size(), Lanes{});
    iterations = solver
                     .solve(f.drop.connectivity(), f.matrix, f.rhs.data(), solution.data(), nullptr, false,
                            default_scene().solver)
                     .iterations;
  });
  state.counters["iterations"] = iterations;
}

void external_forces(benchmark::State& state, Fixture fixture) {
  run(state, std::move(fixture),
      [](Fixture& f) { apply_external_forces(f.drop, f.solids, f.time + f.dt, f.dt, ExternalForcesOptions()); });
}
void flight_external_forces(benchmark::State& state) { external_forces(state, in_flight(state.range(0))); }
void rest_external_forces(benchmark::State& state) { external_forces(state, at_rest(state.range(0))); }

void flight_damping(benchmark::State& state) {
  run(state, in_flight(state.range(0)), [](Fixture& f) {
    DampingOptions options;
    options.viscosity_coefficient = 2.456 * 0.01;
    apply_damping(f.drop, f.geometry, f.dt, options);
  });
}

void curvature_flow(benchmark::State& state, Fixture fixture) {
  int iterations = 0;
  run(state, std::move(fixture), [&](Fixture& f) {
    MeanCurvatureFlowOptions options;
    options.coefficient = f.tension * f.dt;
    options.body_pressure = f.pressure;
    iterations = flow_by_mean_curvature(f.drop, f.geometry, f.dt, options).iterations;
  });
  state.counters["iterations"] = iterations;
}
void flight_curvature_flow(benchmark::State& state) { curvature_flow(state, in_flight(state.range(0))); }
void rest_curvature_flow(benchmark::State& state) { curvature_flow(state, at_rest(state.range(0))); }

void rest_contact_angle(benchmark::State& state) {
  run(state, at_rest(state.range(0)), [](Fixture& f) {
    ContactAngleOptions options;
    options.tension_over_mass = f.tension;
    options.line_friction_over_mass = f.tension / 72;
    options.body_pressure = f.pressure;
    apply_contact_angle(f.drop, f.solids, f.geometry, f.time, f.dt, options);
  });
}

void flight_tangential_damping(benchmark::State& state) {
  run(state, in_flight(state.range(0)), [](Fixture& f) {
    remove_tangential_deformation(f.drop, f.geometry, free_rigid_motion(f.drop, f.geometry), f.dt);
  });
}

void volume_correction(benchmark::State& state, VolumeCorrectionMethod method) {
  Fixture fixture = in_flight(state.range(0));
  fixture.drop.set_target_volume(fixture.drop.target_volume() * 1.0001);
  run(state, std::move(fixture), [&](Fixture& f) {
    VolumeCorrectionOptions options;
    options.method = method;
    options.solver.tolerance = 1e-3;
    correct_volume(f.drop, f.geometry, f.dt, options);
  });
}
void flight_volume_global(benchmark::State& state) { volume_correction(state, VolumeCorrectionMethod::global); }
void flight_volume_local(benchmark::State& state) { volume_correction(state, VolumeCorrectionMethod::local); }

void flight_face_changes(benchmark::State& state) {
  Fixture fixture = in_flight(state.range(0));
  const Eigen::Matrix3Xd before = fixture.x;
  run(state, std::move(fixture),
      [&](Fixture& f) { find_face_changes(f.drop, before, f.drop.workspace().violent_faces); });
}

void flight_remesh_unchanged(benchmark::State& state) {
  Fixture fixture = in_flight(state.range(0));
  RemeshOptions options;
  options.band = bench::free_flight(static_cast<int>(std::lround(std::sqrt(static_cast<double>(state.range(0)) / 20))),
                                    Level::calibrated)
                     .scene.mesh;
  Remesher remesher;
  run(state, std::move(fixture), [&](Fixture& f) { remesher.remesh(f.drop, options); });
}

void flight_pressure_substep(benchmark::State& state) {
  run(state, in_flight(state.range(0), Level::pressure), [](Fixture& f) {
    PressureOptions options;
    options.edge_min = 1;
    options.smoothing = 0.3;
    PressureStep step(f.drop, f.solids, f.time, options);
    step.solve(f.dt);
    step.move();
  });
}

void sizes(benchmark::internal::Benchmark* benchmark) {
  for (const std::int64_t triangles : {1280, 20480, 100820}) benchmark->Arg(triangles);
  benchmark->Unit(benchmark::kMicrosecond);
}

BENCHMARK(flight_geometry)->Apply(sizes);
BENCHMARK(flight_mean_pressure)->Apply(sizes);
BENCHMARK(flight_rigid_motion)->Apply(sizes);
BENCHMARK(flight_assembly)->Apply(sizes);
BENCHMARK(flight_product)->Apply(sizes);
BENCHMARK(flight_solve_from_zero)->Apply(sizes);
BENCHMARK(flight_external_forces)->Apply(sizes);
BENCHMARK(rest_external_forces)->Apply(sizes);
BENCHMARK(flight_damping)->Apply(sizes);
BENCHMARK(flight_curvature_flow)->Apply(sizes);
BENCHMARK(rest_curvature_flow)->Apply(sizes);
BENCHMARK(rest_contact_angle)->Apply(sizes);
BENCHMARK(flight_tangential_damping)->Apply(sizes);
BENCHMARK(flight_volume_global)->Apply(sizes);
BENCHMARK(flight_volume_local)->Apply(sizes);
BENCHMARK(flight_face_changes)->Apply(sizes);
BENCHMARK(flight_remesh_unchanged)->Apply(sizes);
BENCHMARK(flight_pressure_substep)->Apply(sizes);

}  // namespace

int main(int argc, char** argv) {
  std::vector<char*> arguments(argv, argv + argc);
  char shortest[] = "--benchmark_min_time=0.001", smallest[] = "--benchmark_filter=/1280";
  for (char*& argument : arguments)
    if (std::strcmp(argument, "--quick") == 0) {
      argument = shortest;
      arguments.push_back(smallest);
      break;
    }
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
