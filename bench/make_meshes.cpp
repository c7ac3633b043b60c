// SPDX-License-Identifier: GPL-3.0-or-later
// Makes the solids of data/scenes that are no simple shapes, from implicit functions by CGAL's surface mesher:
// bench_make_meshes DIR writes DIR/bird.off and DIR/leaf.off. --quick makes coarse ones, checks them and writes
// nothing.
#include "meniscus/core/mesh_data.h"
#include "meniscus/geometry/inspect.h"
#include "meniscus/io/write_mesh.h"

#include <CGAL/Complex_2_in_triangulation_3.h>
#include <CGAL/IO/facets_in_complex_2_to_triangle_mesh.h>
#include <CGAL/Implicit_surface_3.h>
#include <CGAL/Surface_mesh_default_triangulation_3.h>
#include <CGAL/make_surface_mesh.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>

namespace {

using namespace meniscus;
using Eigen::Vector3d;
using Implicit = std::function<double(const Vector3d&)>;  ///< cm, negative inside

using Triangulation = CGAL::Surface_mesh_default_triangulation_3;
using MesherPoint = Triangulation::Geom_traits::Point_3;
using Surface = CGAL::Implicit_surface_3<Triangulation::Geom_traits, std::function<double(MesherPoint)>>;

/// The surface f = 0 within a ball about a point inside, in triangles with circumradii of at most `size` (cm).
MeshData mesh_of(const Implicit& f, const Vector3d& inside, double reach, double size) {
  Triangulation triangulation;
  CGAL::Complex_2_in_triangulation_3<Triangulation> complex(triangulation);
  const Triangulation::Geom_traits::Sphere_3 bounds({inside.x(), inside.y(), inside.z()}, reach * reach);
  const Surface surface([&f](const MesherPoint& p) { return f({p.x(), p.y(), p.z()}); }, bounds, 1e-6);
  const CGAL::Surface_mesh_default_criteria_3<Triangulation> criteria(30, size, 0.1 * size);
  CGAL::make_surface_mesh(complex, surface, criteria, CGAL::Manifold_tag(), 60);
  CGAL::Surface_mesh<MesherPoint> found;
  CGAL::facets_in_complex_2_to_triangle_mesh(complex, found);
  MeshData data;
  for (const auto v : found.vertices()) {
    const MesherPoint& p = found.point(v);
    data.points.push_back({p.x(), p.y(), p.z()});
  }
  for (const auto face : found.faces()) {
    std::array<std::uint32_t, 3> corners{};
    int k = 0;
    for (const auto v : CGAL::vertices_around_face(found.halfedge(face), found)) corners[k++] = v;
    data.triangles.push_back(corners);
  }
  return data;
}

/// The union of two, rounded where they meet over a width of `width` cm (a quadratic smooth minimum).
double blend(double a, double b, double width) {
  const double h = std::max(width - std::abs(a - b), 0.0) / width;
  return std::min(a, b) - 0.25 * h * h * width;
}

/// About the distance to an ellipsoid whose axes are those of space, turned by `pitch` (radians) about y.
double ellipsoid(const Vector3d& x, const Vector3d& center, const Vector3d& axes, double pitch = 0) {
  const Vector3d local = Eigen::AngleAxisd(-pitch, Vector3d::UnitY()) * (x - center);
  const double k = local.cwiseQuotient(axes).norm();
  const double slope = local.cwiseQuotient(axes.cwiseAbs2()).norm();
  return slope > 0 ? k * (k - 1) / slope : -axes.minCoeff();
}

/// A small round bird, 3 cm tall, that looks along x: belly, head, beak, folded wings, tail.
double bird(const Vector3d& x) {
  const Vector3d mirrored(x.x(), std::abs(x.y()), x.z());
  double f = ellipsoid(x, {0, 0, 0}, {1.05, 0.9, 0.95}, 0.35);
  f = blend(f, ellipsoid(x, {0.5, 0, 1.15}, {0.66, 0.64, 0.62}), 0.35);
  f = blend(f, ellipsoid(x, {1.22, 0, 1.1}, {0.34, 0.15, 0.12}, 0.15), 0.12);
  f = blend(f, ellipsoid(mirrored, {-0.25, 0.82, 0.1}, {0.75, 0.2, 0.42}, -0.5), 0.2);
  f = blend(f, ellipsoid(x, {-1.3, 0, 0.15}, {0.75, 0.32, 0.13}, -0.35), 0.3);
  return f;
}

/// A lotus leaf of 2 cm radius and 0.24 cm thick: a shallow bowl with a waved edge that is rounded off.
double leaf(const Vector3d& x) {
  constexpr double radius = 2, half_thickness = 0.12;
  const double r = std::hypot(x.x(), x.y()), phi = std::atan2(x.y(), x.x()), s = r / radius;
  const double height = 0.45 * s * s + 0.07 * s * s * s * std::cos(5 * phi);
  const double slope = 0.9 * s / radius;
  return std::hypot(std::max(r - radius, 0.0), (x.z() - height) / std::sqrt(1 + slope * slope)) - half_thickness;
}

bool make(const char* name, const Implicit& f, const Vector3d& inside, double reach, double size,
          const std::filesystem::path& directory) {
  const MeshData data = mesh_of(f, inside, reach, size);
  const Inspection inspection = inspect(data);
  fmt::print("{}: {} triangles, {:.4f} cm^3, {:.4f} cm^2, {}\n", name, inspection.faces, inspection.volume,
             inspection.area, inspection.sound ? "sound" : "not sound");
  if (inspection.sound && !directory.empty()) write_mesh(directory / (std::string(name) + ".off"), data);
  return inspection.sound;
}

}  // namespace

int main(int argc, char** argv) {
  const bool quick = argc > 1 && std::strcmp(argv[1], "--quick") == 0;
  if (argc != 2) {
    fmt::print(stderr, "bench_make_meshes DIR | --quick\n");
    return 2;
  }
  const std::filesystem::path directory = quick ? "" : argv[1];
  const double coarse = quick ? 4 : 1;
  const bool bird_is_sound = make("bird", bird, {0, 0, 0}, 4, 0.09 * coarse, directory);
  const bool leaf_is_sound = make("leaf", leaf, {0, 0, 0}, 4, quick ? 0.15 : 0.09, directory);
  return bird_is_sound && leaf_is_sound ? 0 : 1;
}
