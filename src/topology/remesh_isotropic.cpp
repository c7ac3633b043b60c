// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/topology/remesh_isotropic.h"

#include "attribute_maps.h"
#include "meniscus/core/error.h"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <fmt/format.h>

#include <cmath>

namespace meniscus {
namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using Primitive = CGAL::AABB_face_graph_triangle_primitive<Mesh>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

void check(const Mesh& mesh, double target_edge, int iterations) {
  if (!(target_edge > 0) || !std::isfinite(target_edge))
    throw UsageError(fmt::format("the target edge length must be finite and above 0; it is {} cm", target_edge));
  if (iterations < 1) throw UsageError(fmt::format("remeshing needs at least one iteration, not {}", iterations));
  if (mesh.number_of_faces() == 0) throw GeometryError("the mesh has no faces to remesh");
  if (!CGAL::is_triangle_mesh(mesh))
    throw GeometryError("the mesh has faces that are not triangles; triangulate it first");
  const double faces = estimated_faces(PMP::area(mesh), target_edge);
  if (!(faces <= 50e6))
    throw UsageError(fmt::format("edges of {} cm would need about {:.3g} faces (at most 50 million); take longer edges",
                                 target_edge, faces));
}

/// The point of face f nearest to p, as weights of its corners.
AttributeSource weights_in(const Mesh& mesh, FaceIndex f, const Point& p) {
  const auto h = mesh.halfedge(f);
  const std::array<VertexIndex, 3> v{mesh.source(h), mesh.target(h), mesh.target(mesh.next(h))};
  const Vector e1 = mesh.point(v[1]) - mesh.point(v[0]), e2 = mesh.point(v[2]) - mesh.point(v[0]),
               d = p - mesh.point(v[0]);
  const double a = e1 * e1, b = e1 * e2, c = e2 * e2, det = a * c - b * b;
  if (!(det > 0)) return same_as(v[0]);
  const double s = (c * (e1 * d) - b * (e2 * d)) / det, t = (a * (e2 * d) - b * (e1 * d)) / det;
  return {v, {1 - s - t, s, t}};
}

void carry_attributes(const Mesh& old, Mesh& mesh) {
  Tree tree(faces(old).begin(), faces(old).end(), old);
  std::vector<AttributeSource> sources;
  sources.reserve(mesh.num_vertices());
  for (const auto v : mesh.vertices()) {
    const auto nearest = tree.closest_point_and_primitive(mesh.point(v));
    sources.push_back(weights_in(old, nearest.second, nearest.first));
  }
  gather_attributes(old, mesh, sources);
}

}  // namespace

void remesh_isotropic(Mesh& mesh, double target_edge, int iterations, std::optional<double> feature_angle) {
  check(mesh, target_edge, iterations);
  const Mesh old = mesh;
  const std::string name = "e:kept_sharp";
  auto is_sharp = mesh.add_property_map<EdgeIndex, bool>(name, false).first;
  if (feature_angle) PMP::detect_sharp_edges(mesh, *feature_angle * 180 / CGAL_PI, is_sharp);
  PMP::isotropic_remeshing(
      mesh.faces(), target_edge, mesh,
      CGAL::parameters::number_of_iterations(static_cast<unsigned>(iterations)).edge_is_constrained_map(is_sharp));
  mesh.remove_property_map(is_sharp);
  mesh.collect_garbage();
  carry_attributes(old, mesh);
}

}  // namespace meniscus
