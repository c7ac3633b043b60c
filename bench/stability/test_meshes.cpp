// SPDX-License-Identifier: GPL-3.0-or-later
#include "test_meshes.h"

#include "../../tests/support/random_shapes.h"
#include "meniscus/core/error.h"
#include "meniscus/geometry/inspect.h"
#include "meniscus/geometry/shapes.h"

#include <Eigen/Geometry>

#include <cmath>

namespace meniscus::bench {
namespace {

using Eigen::Vector3d;
using random_shapes::Numbers;

/// Of every `one_in`-th edge, brings one end to `share` of the way from the other; each vertex at most once.
void shorten_edges(Mesh& mesh, std::size_t one_in, double share) {
  std::vector<bool> moved(mesh.num_vertices(), false);
  std::size_t count = 0;
  for (const auto e : mesh.edges()) {
    const auto a = mesh.vertex(e, 0), b = mesh.vertex(e, 1);
    if (++count % one_in != 0 || moved[a] || moved[b]) continue;
    moved[a] = moved[b] = true;
    const Vector3d p = to_eigen(mesh.point(a)), q = to_eigen(mesh.point(b));
    mesh.point(a) = to_point(q + share * (p - q));
  }
}

/// Of every `one_in`-th face, brings a corner next to the middle of the edge opposite.
void flatten_faces(Mesh& mesh, std::size_t one_in) {
  std::vector<bool> moved(mesh.num_vertices(), false);
  std::size_t count = 0;
  for (const auto f : mesh.faces()) {
    const auto h = mesh.halfedge(f);
    const auto a = mesh.target(h), b = mesh.target(mesh.next(h)), c = mesh.source(h);
    if (++count % one_in != 0 || moved[a] || moved[b] || moved[c]) continue;
    moved[a] = moved[b] = moved[c] = true;
    const Vector3d middle = 0.5 * (to_eigen(mesh.point(b)) + to_eigen(mesh.point(c)));
    mesh.point(a) = to_point(middle + 0.05 * (to_eigen(mesh.point(a)) - middle));
  }
}

}  // namespace

Mesh test_spheroid(Quality quality, double radius, double edge_length, unsigned seed) {
  const double wide = radius / std::cbrt(2.0);
  const Vector3d axes(wide, wide, 2 * wide);
  Mesh mesh = make_sphere(Vector3d::Zero(), radius, edge_length);
  Columns x = positions(mesh);
  Numbers numbers(seed);
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    if (quality == Quality::jittered) x.col(i) += 0.15 * edge_length * numbers.vector(1);
    if (quality == Quality::obtuse) x.col(i) = Eigen::AngleAxisd(1.5 * x(2, i) / radius, Vector3d::UnitZ()) * x.col(i);
    x.col(i) = axes.cwiseProduct(x.col(i).normalized());
  }
  if (quality == Quality::slivers) flatten_faces(mesh, 20);
  if (quality == Quality::needle) shorten_edges(mesh, 30, 1.0 / 50);
  if (quality == Quality::aspect) shorten_edges(mesh, 30, 1.0 / 1000);
  for (Eigen::Index i = 0; i < x.cols(); ++i) x.col(i) /= x.col(i).cwiseQuotient(axes).norm();
  if (const Inspection inspection = inspect(to_mesh_data(mesh)); !inspection.sound)
    throw GeometryError("a mesh to start from is not sound: " + inspection.defects.front().message);
  return mesh;
}

}  // namespace meniscus::bench
