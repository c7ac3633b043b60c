// SPDX-License-Identifier: GPL-3.0-or-later
// What one merge and one remesh bring in: two balls of R = 0.2 cm, 1.2 R apart, become one drop, and its edges are
// brought into the band about the balls' own edge length. Error of volume and area beside the two balls' union, and
// of the curvature more than three edges away from the seam, before and after remeshing, against edge length.
#include "charts.h"
#include "meniscus/core/error.h"
#include "meniscus/geometry/curvature.h"
#include "meniscus/geometry/shapes.h"
#include "meniscus/topology/boolean.h"
#include "meniscus/topology/remesh.h"
#include "references/curved_surfaces.h"
#include "support/process.h"

#include <cmath>

namespace meniscus::bench {
namespace {

using Eigen::Vector3d;

constexpr double radius = 0.2, apart = 1.2 * radius;

/// The root mean square error of K over 2/R, away from the plane of the seam.
double curvature_error(const Drop& drop, double away) {
  SurfaceGeometry geometry;
  geometry.compute(drop.positions(), drop.connectivity());
  const std::vector<double> curvature = mean_curvature(geometry, drop.positions(), drop.connectivity());
  double sum = 0, area = 0;
  for (std::uint32_t v = 0; v < curvature.size(); ++v) {
    if (drop.connectivity().degree(v) == 0 || std::abs(drop.positions()(0, v)) < away) continue;
    const double off = curvature[v] / references::sphere_curvature(radius) - 1;
    sum += geometry.lumped_area(v) * off * off;
    area += geometry.lumped_area(v);
  }
  return std::sqrt(sum / area);
}

void add(ChartTable& table, const char* what, const Drop& drop, double edge, double before_volume, double before_area,
         double seconds) {
  SurfaceGeometry geometry;
  geometry.compute(drop.positions(), drop.connectivity());
  table.add({std::string(what), edge, double(drop.mesh().number_of_faces()),
             geometry.volume() / references::two_balls_volume(radius, apart) - 1, geometry.volume() / before_volume - 1,
             geometry.area() / references::two_balls_area(radius, apart) - 1, geometry.area() / before_area - 1,
             curvature_error(drop, 3 * edge), seconds});
}

}  // namespace

ChartTable merge_remesh_chart(bool quick) {
  ChartTable table("merge_remesh",
                   "Two balls of R = 0.2 cm, 1.2 R apart, merged, then remeshed to [0.5, 1.5] of their edges",
                   {"what", "edge", "triangles", "volume_error", "volume_change", "area_error", "area_change",
                    "curvature_error", "cpu_seconds"});
  for (const double edge : {0.06, 0.04, 0.02, 0.01, 0.005}) {
    if (quick && edge < 0.04) continue;
    const Drop a(make_sphere(Vector3d(-0.5 * apart, 0, 0), radius, edge));
    const Drop b(make_sphere(Vector3d(0.5 * apart, 0.13 * edge, 0.07 * edge), radius, edge));
    double start = cpu_seconds();
    const BooleanResult merged = boolean(view_of(a), view_of(b), BooleanOperation::unite);
    if (!merged.ok()) throw NumericsError("two balls were not united: " + merged.message);
    MeshData data;
    data.points = merged.points;
    data.triangles = merged.triangles;
    std::vector<Drop> drops = to_drops(data);
    Drop& drop = drops.front();
    const double merge_seconds = cpu_seconds() - start;
    SurfaceGeometry geometry;
    geometry.compute(std::as_const(drop).positions(), drop.connectivity());
    add(table, "merged", drop, edge, geometry.volume(), geometry.area(), merge_seconds);
    RemeshOptions options;
    options.band = {0.5 * edge, 1.5 * edge, 0.5};
    start = cpu_seconds();
    remesh(drop, options);
    add(table, "remeshed", drop, edge, geometry.volume(), geometry.area(), cpu_seconds() - start);
  }
  return table;
}

}  // namespace meniscus::bench
