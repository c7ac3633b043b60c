// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/topology/remesh.h"

#include "meniscus/core/error.h"
#include "meniscus/topology/split.h"
#include "support/judge.h"
#include "support/random_shapes.h"
#include "support/remesh_options.h"

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace meniscus {
namespace {

using Eigen::Vector3d;
using random_shapes::mean_edge;
using random_shapes::Numbers;

double edge_length(const Mesh& mesh, EdgeIndex e) {
  const auto h = mesh.halfedge(e);
  return (to_eigen(mesh.point(mesh.target(h))) - to_eigen(mesh.point(mesh.source(h)))).norm();
}

std::pair<std::size_t, std::size_t> count_out_of_band(const Mesh& mesh, const EdgeBand& edges) {
  std::size_t below = 0, above = 0;
  for (const auto e : mesh.edges()) {
    below += edge_length(mesh, e) < edges.edge_min;
    above += edge_length(mesh, e) > edges.edge_max;
  }
  return {below, above};
}

std::size_t sum(const RefusedEdges& r) {
  return r.link_condition + r.would_invert + r.would_be_sliver + r.would_be_long + r.valence + r.feature +
         r.contact_line + r.near_intersection;
}

bool same_points(const Mesh& a, const Mesh& b) {
  return a.num_vertices() == b.num_vertices() &&
         std::memcmp(positions(a).data(), positions(b).data(),
                     sizeof(double) * static_cast<std::size_t>(positions(a).size())) == 0;
}

TEST(Remesh, BringsSmoothShapesIntoAnyBand) {
  const std::vector<Mesh> shapes{make_sphere(Vector3d(1, 2, 3), 1, 0.1),
                                 make_ellipsoid(Vector3d::Zero(), {1, 0.7, 0.5}, 0.08),
                                 make_torus(Vector3d::Zero(), 1, 0.4, 0.1), make_dumbbell(4, 0.7, 0.35, 0.08)};
  for (const Mesh& mesh : shapes)
    for (const double scale : {0.5, 1.0, 2.0}) {
      const double h = scale * mean_edge(mesh);
      const RemeshOptions options = band(0.5 * h, 1.5 * h, 8, 0.5);
      Drop drop(mesh);
      const RemeshReport report = remesh(drop, options);
      EXPECT_EQ(judge::defect(drop), "");
      EXPECT_EQ(count_out_of_band(drop.mesh(), options.band), std::make_pair(std::size_t{0}, std::size_t{0}));
      EXPECT_EQ(report.edges_below + report.edges_above, 0u);
      EXPECT_EQ(report.cuts, 0u);
    }
}

TEST(Remesh, ReportsExactlyTheEdgesLeftOut) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    Drop drop(random_shapes::irregular_sphere(1, 10, 0.4, seed));
    const double h = mean_edge(drop.mesh());
    const RemeshOptions options = band(0.6 * h, 1.25 * h, 2);
    const RemeshReport report = remesh(drop, options);
    EXPECT_EQ(std::make_pair(report.edges_below, report.edges_above), count_out_of_band(drop.mesh(), options.band));
    EXPECT_EQ(sum(report.refused), report.edges_below + report.edges_above);
    for (const auto e : drop.mesh().edges())
      if (edge_length(drop.mesh(), e) < options.band.edge_min) {
        EXPECT_EQ(drop.poor_quality()[drop.mesh().vertex(e, 0)], 1);
        EXPECT_EQ(drop.poor_quality()[drop.mesh().vertex(e, 1)], 1);
      }
  }
}

TEST(Remesh, LeavesAMeshInTheBandAlone) {
  Drop drop(make_sphere(Vector3d::Zero(), 1, 0.1));
  const Mesh before = drop.mesh();
  const auto version = drop.topology_version();
  const double h = mean_edge(before);
  const RemeshReport report = remesh(drop, band(0.5 * h, 1.5 * h));
  EXPECT_FALSE(report.changed());
  EXPECT_EQ(report.passes, 0);
  EXPECT_EQ(drop.topology_version(), version);
  EXPECT_TRUE(same_points(before, drop.mesh()));
}

TEST(Remesh, GivesTheSameBitsTwice) {
  const auto run = [] {
    Drop drop(random_shapes::irregular_sphere(1, 12, 0.35, 3));
    const double h = mean_edge(drop.mesh());
    remesh(drop, band(0.7 * h, 1.5 * h, 4, 0.3));
    return drop;
  };
  const Drop a = run(), b = run();
  EXPECT_TRUE(same_points(a.mesh(), b.mesh()));
  EXPECT_EQ(a.connectivity().triangles(), b.connectivity().triangles());
}

TEST(Remesh, AKeptRemesherGivesTheSameAsAFreshOne) {
  Remesher kept;
  for (unsigned seed = 0; seed < 5; ++seed) {
    const Mesh mesh = random_shapes::irregular_sphere(1, 8, 0.35, seed);
    const RemeshOptions options = band(0.7 * mean_edge(mesh), 1.5 * mean_edge(mesh));
    Drop a(mesh), b(mesh);
    kept.remesh(a, options);
    remesh(b, options);
    EXPECT_TRUE(same_points(a.mesh(), b.mesh()));
  }
}

// Decisions may turn on rounding, so moved and renumbered meshes need not give the same faces, but
// they must give as many and the same volume, nearly.
TEST(Remesh, DoesNotDependOnPlaceOrNumbering) {
  const Mesh mesh = random_shapes::irregular_sphere(1, 14, 0.35, 5);
  const RemeshOptions options = band(0.6 * mean_edge(mesh), 1.4 * mean_edge(mesh), 6, 0.3);
  Mesh moved = mesh;
  const Eigen::AngleAxisd turn(1.1, Vector3d(1, 2, -1).normalized());
  for (const auto v : moved.vertices()) moved.point(v) = to_point(turn * to_eigen(mesh.point(v)) + Vector3d(3, -8, 1));
  Mesh renumbered;
  const auto n = static_cast<Mesh::size_type>(mesh.number_of_vertices());
  for (Mesh::size_type v = 0; v < n; ++v) renumbered.add_vertex(mesh.point(VertexIndex(n - 1 - v)));
  for (const auto f : mesh.faces()) {
    std::vector<VertexIndex> face;
    for (const auto v : CGAL::vertices_around_face(mesh.halfedge(f), mesh)) face.emplace_back(n - 1 - v);
    renumbered.add_face(face);
  }
  Drop a(mesh), b(moved), c(renumbered);
  for (Drop* drop : {&a, &b, &c}) {
    const auto report = remesh(*drop, options);
    EXPECT_EQ(report.edges_below + report.edges_above, 0u);
    EXPECT_EQ(judge::defect(*drop), "");
    EXPECT_NEAR(drop->mesh().number_of_faces(), a.mesh().number_of_faces(), 0.02 * a.mesh().number_of_faces());
    EXPECT_NEAR(drop->volume(), a.volume(), 1e-3 * a.volume());
  }
}

/// Largest error of an attribute that was linear in position, after remeshing a sphere of radius 1.
struct Carried {
  double h, linear_error, volume_change;
};
Carried carry(int frequency) {
  Mesh mesh = random_shapes::irregular_sphere(1, frequency, 0.3, 1);
  auto linear = mesh.add_property_map<VertexIndex, double>("v:linear", 0).first;
  auto constant = mesh.add_property_map<VertexIndex, double>("v:constant", 0.1).first;
  auto narrow = mesh.add_property_map<VertexIndex, float>("v:narrow", 0.3f).first;
  auto whole = mesh.add_property_map<VertexIndex, std::int32_t>("v:whole", 7).first;
  const auto f = [](const Vector3d& x) { return 2 * x.x() - x.y() + 3 * x.z() + 1; };
  for (const auto v : mesh.vertices()) linear[v] = f(to_eigen(mesh.point(v)));
  Drop drop(mesh);
  drop.velocities().colwise() = Vector3d(0.1, 0.2, 0.3);
  const double before = drop.volume(), h = mean_edge(mesh);
  const auto report = remesh(drop, band(0.6 * h, 1.3 * h, 4, 0.3));
  EXPECT_GT(report.splits, 0u);
  EXPECT_GT(report.collapses, 0u);
  EXPECT_GT(report.flips, 0u);
  linear = drop.mesh().property_map<VertexIndex, double>("v:linear").first;
  constant = drop.mesh().property_map<VertexIndex, double>("v:constant").first;
  narrow = drop.mesh().property_map<VertexIndex, float>("v:narrow").first;
  whole = drop.mesh().property_map<VertexIndex, std::int32_t>("v:whole").first;
  double error = 0;
  for (const auto v : drop.mesh().vertices()) {
    error = std::max(error, std::abs(linear[v] - f(to_eigen(drop.mesh().point(v)))));
    EXPECT_EQ(constant[v], 0.1);
    EXPECT_EQ(narrow[v], 0.3f);
    EXPECT_EQ(whole[v], 7);
    EXPECT_EQ(Vector3d(drop.velocities().col(v)), Vector3d(0.1, 0.2, 0.3));
  }
  return {h, error, std::abs(drop.volume() - before) / before};
}

TEST(Remesh, CarriesConstantsExactlyAndLinearFunctionsToSecondOrder) {
  const Carried coarse = carry(8), fine = carry(32);
  EXPECT_LT(coarse.linear_error, 0.5 * std::sqrt(14.0) * coarse.h * coarse.h);  // |gradient| h^2/2
  EXPECT_GT(coarse.linear_error / fine.linear_error, 8);                        // 16 for second order
}

TEST(Remesh, ChangesTheVolumeToSecondOrderOnly) {
  const Carried coarse = carry(8), fine = carry(32);
  EXPECT_LT(coarse.volume_change, 0.1 * coarse.h * coarse.h);
  EXPECT_LT(fine.volume_change, 0.1 * fine.h * fine.h);
}

TEST(Remesh, ASplitSphereComesNearerToTheSphere) {
  Drop drop(make_icosphere(Vector3d::Zero(), 1, 8));
  const double ball = 4.0 / 3 * 3.141592653589793, h = mean_edge(drop.mesh()), before = drop.volume();
  remesh(drop, band(0.3 * h, 0.8 * h));
  EXPECT_LT(std::abs(drop.volume() - ball), 0.4 * std::abs(before - ball));
  // Plain midpoints would lie h^2/8 below the sphere.
  for (const auto v : drop.mesh().vertices()) EXPECT_NEAR(to_eigen(drop.mesh().point(v)).norm(), 1, h * h / 16);
}

TEST(Remesh, ACoarsenedSphereKeepsItsVolume) {
  Drop drop(make_icosphere(Vector3d::Zero(), 1, 24));
  const double h = mean_edge(drop.mesh()), before = drop.volume();
  EXPECT_GT(remesh(drop, band(2 * h, 6 * h)).collapses, 0u);
  EXPECT_NEAR(drop.volume(), before, 1e-3 * before);
}

TEST(Remesh, KeepsTheShapeOfABoxWithSharpEdges) {
  Drop drop(make_box(Vector3d::Zero(), {1, 0.6, 0.4}, 0.05));
  RemeshOptions options = band(0.08, 0.3, 6, 0.3);
  options.feature_angle = 0.7;
  EXPECT_GT(remesh(drop, options).collapses, 0u);
  EXPECT_EQ(judge::defect(drop), "");
  EXPECT_NEAR(drop.volume(), 0.24, 1e-12);
  int corners = 0;
  for (const auto v : drop.mesh().vertices())
    corners += (to_eigen(drop.mesh().point(v)).cwiseAbs() - Vector3d(0.5, 0.3, 0.2)).norm() < 1e-12;
  EXPECT_EQ(corners, 8);
}

/// How far a point is from the surface of the unit box about the origin.
double distance_to_unit_box(const Vector3d& x) { return std::abs(x.cwiseAbs().maxCoeff() - 0.5); }

TEST(Remesh, KeepsAUnitBoxWithSharpEdgesExactly) {
  for (const double given : {1.0, 0.25, 0.1})
    for (const double edge : {0.5, 0.35, 0.2, 0.1, 0.06})
      for (const double smoothing : {0.0, 0.5}) {
        Drop drop(make_box(Vector3d::Zero(), {1, 1, 1}, given));
        RemeshOptions options = band(0.5 * edge, 1.5 * edge, 8, smoothing);
        options.feature_angle = 0.7;
        remesh_to_band(drop, options);
        EXPECT_EQ(judge::defect(drop), "");
        EXPECT_NEAR(drop.volume(), 1, 1e-12) << given << " " << edge;
        for (const auto v : drop.mesh().vertices())
          EXPECT_LT(distance_to_unit_box(to_eigen(drop.mesh().point(v))), 1e-12);
      }
}

TEST(Remesh, NearlyKeepsAUnitBoxWithoutFeatures) {
  for (const double given : {1.0, 0.25, 0.1})
    for (const double edge : {0.35, 0.2, 0.1, 0.06}) {
      Drop drop(make_box(Vector3d::Zero(), {1, 1, 1}, given));
      remesh_to_band(drop, band(0.5 * edge, 1.5 * edge, 8, 0.5));
      EXPECT_EQ(judge::defect(drop), "");
      EXPECT_NEAR(drop.volume(), 1, 0.5 * edge * edge) << given << " " << edge;  // chamfers along 12 edges
      for (const auto v : drop.mesh().vertices())
        EXPECT_LT(distance_to_unit_box(to_eigen(drop.mesh().point(v))), 0.5 * edge) << given << " " << edge;
    }
}

TEST(Remesh, RefinesWhereTheSurfaceCurves) {
  // A prolate ellipsoid: the curvatures at its tips are 50/cm, at its waist 10 and 0.4 (half that in the mean).
  const auto edges_of = [](double refinement) {
    Drop drop(make_ellipsoid({0, 0, 0}, {0.1, 0.1, 0.5}, 0.05));
    RemeshOptions options = band(0.04, 0.12);
    options.band.refinement = refinement;
    for (int k = 0; k < 4; ++k) remesh(drop, options);
    EXPECT_EQ(judge::defect(drop), "");
    double tip = 0, waist = 0, least = INFINITY;
    int tips = 0, waists = 0;
    for (const auto e : drop.mesh().edges()) {
      const auto h = drop.mesh().halfedge(e);
      const double z =
          0.5 * std::abs(drop.mesh().point(drop.mesh().source(h)).z() + drop.mesh().point(drop.mesh().target(h)).z());
      const double length = edge_length(drop.mesh(), e);
      least = std::min(least, length);
      if (z > 0.45) tip += length, ++tips;
      if (z < 0.2) waist += length, ++waists;
    }
    return std::array<double, 3>{tip / tips, waist / waists, least};
  };
  const auto even = edges_of(1), refined = edges_of(4);
  EXPECT_LT(refined[0], 0.75 * even[0]);
  EXPECT_LT(refined[0], 0.7 * refined[1]);
  EXPECT_GT(refined[2], 0.5 * 0.04 / 4);
}

TEST(Remesh, RefusesBandsThatMeanNothing) {
  Drop drop(make_icosphere(Vector3d::Zero(), 1, 2));
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  const std::vector<std::pair<double, double>> bands{{0, 1},     {-1, 1},         {0.5, 1}, {nan, 1},
                                                     {0.1, nan}, {0.1, infinity}, {1, 0.1}};
  for (const auto& [low, high] : bands) {
    EXPECT_THROW(remesh(drop, band(low, high)), UsageError) << low << " " << high;
    EXPECT_THROW(remesh_to_band(drop, band(low, high)), UsageError) << low << " " << high;
  }
  RemeshOptions options = band(0.1, 0.3);
  options.band.wetted_weight = 0;
  EXPECT_THROW(remesh(drop, options), UsageError);
  options = band(0.1, 0.3, 0);
  EXPECT_THROW(remesh(drop, options), UsageError);
  EXPECT_THROW(remesh_to_band(drop, band(1e-4, 3e-4)), UsageError);  // 12.6 cm^2 in 2e-4 cm edges
  EXPECT_EQ(drop.mesh().number_of_faces(), 80u);
}

TEST(Remesh, RefusesABlownUpDropInsteadOfFillingTheMemory) {
  Mesh mesh = make_icosphere(Vector3d::Zero(), 1, 2);
  mesh.point(VertexIndex(0)) = Point(0, 0, 1e9);
  Drop drop(mesh);
  EXPECT_THROW(remesh(drop, band(0.1, 0.3)), GeometryError);
}

TEST(Remesh, LeavesATetrahedronAlone) {
  Mesh mesh;
  CGAL::make_tetrahedron(Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0), Point(0, 0, 1), mesh);
  Drop drop(mesh);
  const auto report = remesh(drop, band(10, 30));
  EXPECT_FALSE(report.changed());
  EXPECT_EQ(report.edges_below, 6u);
}

TEST(RemeshToBand, MeetsItselfNowhereNew) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    Numbers numbers(seed);
    const Mesh mesh = random_shapes::shape(numbers);
    const RemeshOptions options = random_shapes::options_for(mesh, numbers);
    if (judge::meets_itself(mesh)) continue;
    Drop drop(mesh);
    try {
      remesh_to_band(drop, options);
    } catch (const GeometryError&) {
      EXPECT_TRUE(same_points(drop.mesh(), mesh));  // refused: as it was
    }
    EXPECT_EQ(judge::defect(drop), "") << "seed " << seed;
  }
}

// bench_remesh --stress runs 1,000.
TEST(RemeshAndSplit, RandomRunsGiveOnlySoundMeshes) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    Numbers numbers(seed);
    const Mesh mesh = random_shapes::shape(numbers);
    const RemeshOptions options = random_shapes::options_for(mesh, numbers);
    const bool met_itself = judge::meets_itself(mesh);
    Drop drop(mesh);
    remesh(drop, options);
    ASSERT_EQ(judge::connectivity_defect(drop), "") << "seed " << seed;
    SplitReport report;
    for (const Drop& piece : split_components(std::move(drop), report)) {
      ASSERT_EQ(judge::topology_defect(piece.mesh()), "") << "seed " << seed;
      ASSERT_TRUE(met_itself || !judge::meets_itself(piece.mesh())) << "seed " << seed;
    }
  }
}

}  // namespace
}  // namespace meniscus
