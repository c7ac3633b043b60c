// SPDX-License-Identifier: GPL-3.0-or-later
// Curvature and flow: the error of K on a sphere, an ellipsoid and a torus against edge length, for smooth and jittered
// meshes and both lumped masses; the error of a sphere's radius under implicit flow against time step and against the
// solver's tolerance.
#include "meniscus/geometry/curvature.h"
#include "charts.h"
#include "meniscus/geometry/shapes.h"
#include "meniscus/operators/mean_curvature_flow.h"
#include "references/curved_surfaces.h"

#include <cmath>
#include <functional>
#include <random>

namespace meniscus::bench {
namespace {

using Eigen::Vector3d;

struct Shape {
  const char* name;
  std::function<Mesh(double edge)> make;
  std::function<Vector3d(const Vector3d&)> project;  ///< onto the exact surface
  std::function<double(const Vector3d&)> curvature;
};

std::vector<Shape> shapes() {
  const Vector3d axes(0.2, 0.24, 0.28);
  const double major = 0.3, minor = 0.1;
  return {{"sphere", [](double edge) { return make_sphere(Vector3d::Zero(), 0.2, edge); },
           [](const Vector3d& x) { return Vector3d(0.2 * x.normalized()); },
           [](const Vector3d&) { return references::sphere_curvature(0.2); }},
          {"ellipsoid", [axes](double edge) { return make_ellipsoid(Vector3d::Zero(), axes, edge); },
           [axes](const Vector3d& x) { return Vector3d(x / x.cwiseQuotient(axes).norm()); },
           [axes](const Vector3d& x) { return references::ellipsoid_curvature(axes, x); }},
          {"torus", [=](double edge) { return make_torus(Vector3d::Zero(), major, minor, edge); },
           [=](const Vector3d& x) {
             const Vector3d ring = major * Vector3d(x.x(), x.y(), 0).normalized();
             return Vector3d(ring + minor * (x - ring).normalized());
           },
           [=](const Vector3d& x) { return references::torus_curvature(major, minor, x); }}};
}

/// Moves vertices by up to `amount` edges, back onto the surface; the same
/// numbers on every machine.
void jitter(Mesh& mesh, const Shape& shape, double amount) {
  std::mt19937 generator(7);
  const auto number = [&] { return 2 * (generator() / 4294967296.0) - 1; };
  for (const auto v : mesh.vertices()) {
    const double x = number(), y = number(), z = number();
    mesh.point(v) = to_point(shape.project(to_eigen(mesh.point(v)) + amount * Vector3d(x, y, z)));
  }
}

struct CurvatureError {
  double rms = 0, worst = 0;  ///< relative to the exact value's root mean square
};

/// With mixed Voronoi areas, or with a third of each face's area.
CurvatureError curvature_error(const Mesh& mesh, const Shape& shape, bool barycentric) {
  Connectivity connectivity;
  connectivity.rebuild(mesh);
  SurfaceGeometry geometry;
  const ConstColumns x = positions(mesh);
  geometry.compute(x, connectivity);
  std::vector<double> curvature = mean_curvature(geometry, x, connectivity);
  if (barycentric) {
    std::vector<double> third(curvature.size(), 0.0);
    for (std::size_t f = 0; f < connectivity.triangles().size(); ++f)
      for (const std::uint32_t v : connectivity.triangles()[f])
        third[v] += Eigen::Map<const Vector3d>(geometry.faces()[f].area_vector.data()).norm() / 3;
    for (std::uint32_t v = 0; v < curvature.size(); ++v) curvature[v] *= geometry.lumped_area(v) / third[v];
  }
  CurvatureError error;
  double weight = 0, scale = 0;
  for (std::uint32_t v = 0; v < curvature.size(); ++v) {
    const double exact = shape.curvature(x.col(v)), off = curvature[v] - exact, area = geometry.lumped_area(v);
    error.rms += area * off * off;
    error.worst = std::max(error.worst, std::abs(off));
    scale += area * exact * exact;
    weight += area;
  }
  error.rms = std::sqrt(error.rms / scale);
  error.worst /= std::sqrt(scale / weight);
  return error;
}

/// The relative error of a ball's radius when implicit flow with gamma = 1 has
/// taken a quarter of it.
double flow_error(int frequency, int steps, double tolerance) {
  const double radius = 0.2, time = (1 - 0.75 * 0.75) * radius * radius / 4;
  Drop drop(make_icosphere(Vector3d::Zero(), radius, frequency));
  MeanCurvatureFlowOptions options;
  options.coefficient = 1;
  options.solver.tolerance = tolerance;
  for (int n = 0; n < steps; ++n) {
    SurfaceGeometry& geometry = drop.workspace().geometry;
    geometry.compute(std::as_const(drop).positions(), drop.connectivity());
    flow_by_mean_curvature(drop, geometry, time / steps, options);
  }
  const double mean = drop.positions().colwise().norm().mean();
  return mean / references::sphere_radius_under_flow(radius, 1, time) - 1;
}

}  // namespace

ChartTable curvature_chart(bool quick) {
  ChartTable table("curvature",
                   "Curvature K and implicit flow beside exact values; x is "
                   "edges per 0.1 cm, steps or 1/tolerance",
                   {"what", "variant", "x", "rms_error", "worst_error"});
  for (const Shape& shape : shapes())
    for (const double edge : {0.04, 0.02, 0.01, 0.005})
      for (const double amount : {0.0, 0.1, 0.3})
        for (const bool barycentric : {false, true}) {
          if (quick && (edge < 0.02 || amount > 0.1)) continue;
          if (barycentric && amount > 0) continue;
          Mesh mesh = shape.make(edge);
          jitter(mesh, shape, amount * edge);
          const CurvatureError error = curvature_error(mesh, shape, barycentric);
          const std::string variant = barycentric    ? "barycentric"
                                      : amount == 0  ? "mixed"
                                      : amount < 0.2 ? "jitter 0.1"
                                                     : "jitter 0.3";
          table.add({std::string(shape.name), variant, 0.1 / edge, error.rms, error.worst});
        }
  for (const int frequency : {8, 16, 32})
    for (const int steps : {1, 2, 4, 8, 16, 32, 64, 128}) {
      if (quick && (frequency > 8 || steps > 8)) continue;
      const double error = std::abs(flow_error(frequency, steps, 1e-10));
      table.add({std::string("flow"), std::to_string(10 * frequency * frequency + 2) + " vertices", double(steps),
                 error, error});
    }
  const double converged = flow_error(16, 32, 1e-12);
  for (const double tolerance : {1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8}) {
    if (quick && tolerance < 1e-3) continue;
    const double error = std::abs(flow_error(16, 32, tolerance) - converged);
    table.add({std::string("tolerance"), std::string("2562 vertices in 32 steps"), 1 / tolerance, error, error});
  }
  return table;
}

}  // namespace meniscus::bench
