// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.h"
#include "meniscus/core/error.h"
#include "meniscus/operators/mean_curvature_flow.h"
#include "meniscus/operators/volume_correction.h"
#include "meniscus/topology/split.h"
#include "mesh_files.h"
#include "report.h"

#include <algorithm>
#include <cmath>

namespace meniscus::tools {
namespace {

struct FlowOptions {
  CommonOptions common;
  std::string input, output;
  std::optional<double> gamma, dt;
  int steps = 1;
  bool keep_volume = false;
};

/// What the solves of a run did.
struct Solves {
  int iterations = 0;
  double worst_residual = 0;
  SolverMethod method = SolverMethod::automatic;
};

const char* method_name(SolverMethod method) {
  switch (method) {
    case SolverMethod::automatic:
      return "auto";
    case SolverMethod::conjugate_gradient_jacobi:
      return "jacobi";
    case SolverMethod::conjugate_gradient_incomplete_cholesky:
      return "incomplete_cholesky";
    case SolverMethod::cholesky:
      break;
  }
  return "cholesky";
}

/// Offsets the surface until the volume fits; the normals of the first offset may not reach it.
void keep_volume(Drop& drop, const FlowOptions& options) {
  constexpr int most_offsets = 10;
  constexpr double tolerance = 1e-9;
  SurfaceGeometry& geometry = drop.workspace().geometry;
  for (int k = 0; k < most_offsets; ++k) {
    if (k > 0) geometry.compute(std::as_const(drop).positions(), drop.connectivity());
    const VolumeCorrectionReport report = correct_volume(drop, geometry, *options.dt, VolumeCorrectionOptions{});
    if (std::abs(report.relative_error) < tolerance) return;
  }
  throw NumericsError(
      fmt::format("{}: a step changes the shape so much that no offset keeps its volume; take smaller "
                  "steps (--dt)",
                  shown_name(options.input)));
}

void step(Drop& drop, const FlowOptions& options, Solves& solves) {
  SurfaceGeometry& geometry = drop.workspace().geometry;
  geometry.compute(std::as_const(drop).positions(), drop.connectivity());
  MeanCurvatureFlowOptions flow;
  flow.coefficient = *options.gamma;
  const SolveReport solve = flow_by_mean_curvature(drop, geometry, *options.dt, flow);
  solves.iterations += solve.iterations;
  solves.worst_residual = std::max(solves.worst_residual, solve.relative_residual);
  solves.method = solve.method;
  if (options.keep_volume) keep_volume(drop, options);
}

void flow(Drop& drop, const FlowOptions& options, Solves& solves, Progress& progress) {
  for (int k = 1; k <= options.steps; ++k) {
    step(drop, options, solves);
    if (!drop.positions().allFinite() || !(drop.volume() > 0))
      throw NumericsError(fmt::format("{}: step {}: the surface has collapsed; take fewer steps, or smaller ones",
                                      shown_name(options.input), k));
    progress.show(fmt::format("step {}/{}", k, options.steps));
  }
}

/// The attribute that remembers which vertex of the file each vertex of a component is.
const std::string row_name = "meniscus_row";

/// The mesh as drops that keep their volumes apart, each with the map of row_name.
std::vector<Drop> components(const MeshData& data, const FlowOptions& options) {
  MeshData numbered = data;
  VertexAttribute rows{row_name, ScalarType::uint32, {}};
  for (std::size_t v = 0; v < data.points.size(); ++v) rows.values.push_back(static_cast<double>(v));
  numbered.attributes.push_back(std::move(rows));
  std::vector<Drop> drops;
  drops.push_back(to_drop(numbered, options.input));
  if (!options.keep_volume) return drops;
  std::vector<Mesh> meshes = connected_components(drops[0].mesh());
  if (meshes.size() < 2) return drops;
  drops.clear();
  for (const Mesh& mesh : meshes) drops.push_back(to_drop(to_output(mesh, numbered, false), options.input));
  return drops;
}

/// Writes a drop's positions, and velocities if the file had any, to the rows that they came from.
void scatter(const Drop& drop, MeshData& data) {
  const auto rows = drop.mesh().property_map<VertexIndex, double>(attribute_map_name(row_name)).first;
  for (const auto v : drop.mesh().vertices()) {
    const auto row = static_cast<std::size_t>(rows[v]);
    const Eigen::Vector3d x = drop.positions().col(v.idx()), velocity = drop.velocities().col(v.idx());
    for (int k = 0; k < 3; ++k) data.points[row][static_cast<std::size_t>(k)] = x[k];
    for (auto& attribute : data.attributes)
      for (int k = 0; k < 3; ++k)
        if (attribute.name == std::string("v") + "xyz"[k]) attribute.values[row] = velocity[k];
  }
}

int flow_file(const FlowOptions& options) {
  check_output(options.output, options.common);
  return run_reported(options.common, [&](Report& report) {
    MeshData data = read_input(options.input, options.common);
    report.add_input(options.input, data);
    Progress progress(options.common.console());
    Solves solves;
    report.timed([&] {
      for (Drop& drop : components(data, options)) {
        flow(drop, options, solves, progress);
        scatter(drop, data);
      }
    });
    progress.clear();
    report.add("steps", options.steps);
    report.add("solver", method_name(solves.method));
    report.add("solver_iterations", solves.iterations);
    report.add("solver_residual", solves.worst_residual);
    report.add_output(options.output, data);
    write_output(options.output, data, options.common);
    options.common.console().say(fmt::format("{} steps, {} solver iterations ({})", options.steps, solves.iterations,
                                             method_name(solves.method)));
  });
}

}  // namespace

void add_flow(CLI::App& app, Run& run) {
  const auto options = std::make_shared<FlowOptions>();
  CLI::App* verb =
      add_verb(app,
               {"flow",
                "Implicit mean curvature flow of a closed mesh: (M + gamma dt L) X_new = M X_old, steps times. "
                "A sphere shrinks as r^2 = r0^2 - 4 gamma t.",
                {"meniscus flow bumpy.ply -o smooth.ply --gamma 1 --dt 0.0001 --steps 10",
                 "meniscus flow bumpy.ply -o smooth.ply --gamma 1 --dt 0.0001 --steps 10 --keep-volume"}},
               options->common);
  verb->add_option("IN", options->input, "Closed mesh (.ply, .off, .obj, .stl), or - for stdin")->required();
  add_output(*verb, options->output, "Mesh to write, or - for stdout")->type_name("OUT");
  add_positive(*verb, "--gamma", options->gamma, "cm^2/s", "Coefficient of the flow")->required();
  add_positive(*verb, "--dt", options->dt, "s", "Time of a step")->required();
  verb->add_option("--steps", options->steps, "How many steps")
      ->capture_default_str()
      ->type_name("N")
      ->check(CLI::Range(1, 1000000000));
  verb->add_flag("--keep-volume", options->keep_volume,
                 "Offset each component after each step so that its volume stays");
  add_format(*verb, options->common);
  verb->callback([=, &run] { run = [=] { return flow_file(*options); }; });
}

}  // namespace meniscus::tools
