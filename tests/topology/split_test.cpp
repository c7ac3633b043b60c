// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/topology/split.h"

#include "meniscus/core/error.h"
#include "meniscus/topology/remesh.h"
#include "meniscus/topology/remesh_isotropic.h"
#include "support/judge.h"
#include "support/random_shapes.h"

#include <CGAL/Surface_mesh/IO/OFF.h>
#include <gtest/gtest.h>

#include <fstream>

namespace meniscus {
namespace {

using Eigen::Vector3d;
using random_shapes::mean_edge;

Mesh joined(const std::vector<Mesh>& parts) {
  Mesh all;
  for (const Mesh& part : parts) all += part;
  return all;
}

double sum_of_targets(const std::vector<Drop>& pieces) {
  double sum = 0;
  for (const Drop& piece : pieces) sum += piece.target_volume();
  return sum;
}

Mesh tetrahedron(double size, const Vector3d& at) {
  Mesh mesh;
  const auto p = [&](double x, double y, double z) { return to_point(at + size * Vector3d(x, y, z)); };
  CGAL::make_tetrahedron(p(0, 0, 0), p(1, 0, 0), p(0, 1, 0), p(0, 0, 1), mesh);
  return mesh;
}

TEST(Split, ComponentsBecomeDropsInOrder) {
  Mesh mesh = joined({make_icosphere(Vector3d(0, 0, 0), 1, 3), make_icosphere(Vector3d(5, 0, 0), 0.5, 2),
                      make_icosphere(Vector3d(-5, 0, 0), 0.7, 4)});
  auto number = mesh.add_property_map<VertexIndex, std::int32_t>("v:number", 0).first;
  for (const auto v : mesh.vertices()) number[v] = static_cast<std::int32_t>(v);
  Drop drop(mesh);
  for (const auto v : drop.mesh().vertices()) drop.velocities().col(v) = to_eigen(drop.mesh().point(v));
  drop.set_id(4);
  SplitReport report;
  const double target = drop.target_volume();
  const auto pieces = split_components(drop, report);
  ASSERT_EQ(pieces.size(), 3u);
  EXPECT_EQ(report.pieces, 3u);
  EXPECT_NEAR(report.volume_shared, 0, 1e-12 * target);
  std::int32_t next = 0;
  for (const Drop& piece : pieces) {
    EXPECT_EQ(judge::defect(piece), "");
    EXPECT_EQ(piece.id(), 4);
    const auto kept = piece.mesh().property_map<VertexIndex, std::int32_t>("v:number").first;
    for (const auto v : piece.mesh().vertices()) {
      EXPECT_EQ(kept[v], next++);
      EXPECT_EQ(Vector3d(piece.velocities().col(v)), to_eigen(piece.mesh().point(v)));
    }
  }
  EXPECT_NEAR(sum_of_targets(pieces), target, 1e-12 * target);
}

TEST(Split, OneComponentComesBackAsItWas) {
  Drop drop(make_icosphere(Vector3d::Zero(), 1, 3));
  drop.set_target_volume(5);
  SplitReport report;
  const auto pieces = split_components(drop, report);
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_EQ(pieces[0].target_volume(), 5);
  EXPECT_EQ(pieces[0].connectivity().triangles(), drop.connectivity().triangles());
}

TEST(Split, DeletesTetrahedraAndKeepsTheirVolumeInTheLedger) {
  Drop drop(joined({make_icosphere(Vector3d::Zero(), 1, 3), tetrahedron(0.3, Vector3d(3, 0, 0))}));
  SplitReport report;
  const double target = drop.target_volume();
  const auto pieces = split_components(drop, report);
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_EQ(report.deleted, 1u);
  EXPECT_NEAR(report.volume_deleted, 0.027 / 6, 1e-15);
  EXPECT_NEAR(report.volume_shared, 0.027 / 6, 1e-12);
  EXPECT_NEAR(sum_of_targets(pieces), target, 1e-12);
}

TEST(Split, ALoneTetrahedronVanishes) {
  SplitReport report;
  EXPECT_TRUE(split_components(Drop(tetrahedron(1, Vector3d::Zero())), report).empty());
  EXPECT_EQ(report.deleted, 1u);
}

TEST(Split, SpecksGiveTheirVolumeToTheOthers) {
  const Mesh ball = make_icosphere(Vector3d::Zero(), 1, 3), speck = make_icosphere(Vector3d(3, 0, 0), 0.05, 1);
  Drop drop(joined({ball, speck}));
  const double target = drop.target_volume();
  SplitReport report;
  const auto pieces = split_components(drop, report, 0.01);
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_EQ(report.deleted, 1u);
  EXPECT_NEAR(pieces[0].target_volume() / target, 1, 1e-14);
  EXPECT_EQ(split_components(Drop(speck), report, 0.01).size(), 1u);  // nobody else could take it
}

TEST(Split, DeletesWhatEnclosesNothing) {
  Mesh inside_out = make_icosphere(Vector3d(4, 0, 0), 0.2, 1);
  for (const auto v : inside_out.vertices())  // mirrored
    inside_out.point(v) = Point(8 - inside_out.point(v).x(), inside_out.point(v).y(), inside_out.point(v).z());
  SplitReport report;
  const auto pieces = split_components(Drop(joined({make_icosphere(Vector3d::Zero(), 1, 3), inside_out})), report);
  EXPECT_EQ(pieces.size(), 1u);
  EXPECT_EQ(report.deleted_empty, 1u);
}

TEST(Split, SharesEvenlyButChangesNoSmallPieceByMoreThanATwentieth) {
  Drop drop(joined({make_icosphere(Vector3d::Zero(), 1, 4), make_icosphere(Vector3d(3, 0, 0), 1, 4),
                    make_icosphere(Vector3d(6, 0, 0), 0.1, 4)}));
  const double big =
      judge::volume_of(judge::soup_of(drop.mesh()), judge::components_of(judge::soup_of(drop.mesh()))[0]);
  const double lost = 0.03 * big;
  drop.set_target_volume(drop.target_volume() + lost);
  SplitReport report;
  const double target = drop.target_volume();
  const auto pieces = split_components(drop, report);
  ASSERT_EQ(pieces.size(), 3u);
  EXPECT_NEAR(report.volume_shared, lost, 1e-12);
  EXPECT_NEAR(pieces[2].target_volume(), 1.05 * pieces[2].volume(), 1e-12);
  EXPECT_NEAR(pieces[0].target_volume() - pieces[0].volume(), 0.5 * (lost - 0.05 * pieces[2].volume()), 1e-12);
  EXPECT_NEAR(sum_of_targets(pieces), target, 1e-12);
}

TEST(Split, ConnectedComponentsKeepAttributesAndFaces) {
  Mesh mesh = joined({make_torus(Vector3d::Zero(), 1, 0.3, 0.2), make_icosphere(Vector3d(5, 0, 0), 0.5, 2)});
  auto height = mesh.add_property_map<VertexIndex, double>("v:height", 0).first;
  for (const auto v : mesh.vertices()) height[v] = mesh.point(v).z();
  const auto pieces = connected_components(mesh);
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_EQ(pieces[0].number_of_faces() + pieces[1].number_of_faces(), mesh.number_of_faces());
  for (const Mesh& piece : pieces) {
    EXPECT_EQ(judge::topology_defect(piece), "");
    const auto kept = piece.property_map<VertexIndex, double>("v:height").first;
    for (const auto v : piece.vertices()) EXPECT_EQ(kept[v], piece.point(v).z());
  }
}

/// Remeshes until the thin place is coarse enough to be cut, and splits.
std::vector<Drop> pinch(Drop drop, const EdgeBand& edges, std::size_t& cuts) {
  RemeshOptions options;
  options.band = edges;
  const RemeshReport remeshed = remesh(drop, options);
  cuts = remeshed.cuts;
  EXPECT_EQ(judge::defect(drop), "");
  SplitReport report;
  const double target = drop.target_volume();
  auto pieces = split_components(std::move(drop), report);
  EXPECT_NEAR(sum_of_targets(pieces), target, 1e-12 * target);
  return pieces;
}

TEST(PinchOff, ADumbbellBecomesTwoClosedDrops) {
  Drop drop(make_dumbbell(4, 0.7, 0.04, 0.1));
  drop.velocities().colwise() = Vector3d(0, 0, 3);
  std::size_t cuts = 0;
  const double before = drop.volume();
  const auto pieces = pinch(drop, {0.12, 0.3, 1}, cuts);
  EXPECT_GE(cuts, 1u);
  ASSERT_GE(pieces.size(), 2u);
  double volume = 0;
  int large = 0;
  for (const Drop& piece : pieces) {
    EXPECT_EQ(judge::defect(piece), "");
    volume += piece.volume();
    large += piece.volume() > 0.3 * before;
    for (const auto v : piece.mesh().vertices()) EXPECT_EQ(Vector3d(piece.velocities().col(v)), Vector3d(0, 0, 3));
  }
  EXPECT_EQ(large, 2);
  EXPECT_NEAR(volume, before, 0.03 * before);
}

/// Vertices less edges plus faces: 2 for a sphere, 0 for a torus.
int euler_characteristic(const Mesh& mesh) {
  return static_cast<int>(mesh.number_of_vertices()) - static_cast<int>(mesh.number_of_edges()) +
         static_cast<int>(mesh.number_of_faces());
}

TEST(PinchOff, ATorusIsCutWhereItsTubeIsTight) {
  Mesh mesh = make_torus(Vector3d::Zero(), 1, 0.35, 0.1);
  for (const auto v : mesh.vertices()) {  // the tube's radius shrinks to a ninth where x is greatest
    const Vector3d x = to_eigen(mesh.point(v)), ring = Vector3d(x.x(), x.y(), 0).normalized();
    mesh.point(v) = to_point(ring + (x - ring) * (1 - 0.89 * std::exp(-6 * (1 - ring.x()))));
  }
  EXPECT_EQ(euler_characteristic(mesh), 0);
  std::size_t cuts = 0;
  const auto pieces = pinch(Drop(mesh), {0.12, 0.3, 1}, cuts);
  EXPECT_GE(cuts, 1u);
  ASSERT_GE(pieces.size(), 1u);
  EXPECT_EQ(euler_characteristic(pieces[0].mesh()), 2);
  for (const Drop& piece : pieces) EXPECT_EQ(judge::defect(piece), "");
}

TEST(PinchOff, ATightHoleCloses) {
  Drop drop(make_torus(Vector3d::Zero(), 0.5, 0.47, 0.03));
  RemeshOptions options;
  options.band = {0.15, 0.4, 1};
  EXPECT_GE(remesh(drop, options).cuts, 1u);
  EXPECT_EQ(judge::connectivity_defect(drop), "");
  EXPECT_FALSE(judge::meets_itself(drop.mesh()));
  SplitReport report;  // bubbles of air that were shut in enclose a negative volume, and vanish here
  const auto pieces = split_components(std::move(drop), report);
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_EQ(judge::defect(pieces[0]), "");
  EXPECT_EQ(euler_characteristic(pieces[0].mesh()), 2);
}

TEST(PinchOff, NoCutsWhenNotAsked) {
  Drop drop(make_dumbbell(4, 0.7, 0.04, 0.1));
  RemeshOptions options;
  options.band = {0.12, 0.3, 1};
  options.cut_necks = false;
  const RemeshReport report = remesh(drop, options);
  EXPECT_EQ(report.cuts, 0u);
  EXPECT_GT(report.refused.link_condition, 0u);
  EXPECT_EQ(judge::components_of(judge::soup_of(drop.mesh())).size(), 1u);
}

Mesh regression(const std::string& name) {
  Mesh mesh;
  std::ifstream file(MENISCUS_DATA_DIR "/regressions/" + name);
  EXPECT_TRUE(CGAL::IO::read_OFF(file, mesh)) << name;
  return mesh;
}

// Sides of a cut that stood 0.1 edges apart met when later collapses moved their caps.
TEST(Regression, PinchOffCapsDoNotCross) {
  Drop drop(regression("pinch_off_caps_cross.off"));
  RemeshOptions options;
  options.band = {0.32412449181335012, 1.2784863886976456, 1};
  options.max_passes = 1;
  ASSERT_FALSE(judge::meets_itself(drop.mesh()));
  EXPECT_GE(remesh(drop, options).cuts, 1u);
  EXPECT_FALSE(judge::meets_itself(drop.mesh()));
}

// A tetrahedron has no tangent planes: its corners slid into a neighbour.
TEST(Regression, SmoothingLeavesTetrahedraAlone) {
  Drop drop(joined({tetrahedron(0.1, Vector3d::Zero()), tetrahedron(0.1, Vector3d(0.11, 0, 0))}));
  const Mesh before = drop.mesh();
  RemeshOptions options;
  options.band = {0.2, 0.5, 1};
  options.smoothing = 0.5;
  remesh(drop, options);
  for (const auto v : before.vertices()) EXPECT_EQ(drop.mesh().point(v), before.point(v));
}

TEST(CutNecks, CutsADumbbellAcrossItsNeckAtAnyResolution) {
  for (const double edge : {0.05, 0.1, 0.15}) {
    Drop drop(make_dumbbell(4, 0.7, 0.15, edge));
    drop.velocities().colwise() = Vector3d(0.1, 0.2, 0.3);
    const double before = drop.volume();
    EXPECT_EQ(cut_necks(drop, 0.2).cuts, 0u);  // the neck's diameter is 0.3
    EXPECT_EQ(cut_necks(drop, 0.35).cuts, 1u);
    EXPECT_EQ(judge::defect(drop), "");
    EXPECT_NEAR(drop.volume(), before, 1e-2 * before);
    SplitReport report;
    const auto pieces = split_components(drop, report);
    ASSERT_EQ(pieces.size(), 2u);
    EXPECT_NEAR(sum_of_targets(pieces), before, 1e-12 * before);
    for (const Drop& piece : pieces) {
      EXPECT_GT(piece.volume(), 0.4 * before);
      EXPECT_EQ(judge::defect(piece), "");
      for (const auto v : piece.mesh().vertices())
        EXPECT_LT((piece.velocities().col(v) - Vector3d(0.1, 0.2, 0.3)).norm(), 1e-15);
    }
  }
}

TEST(CutNecks, LeavesThreadEndsAndSmallDropsAlone) {
  Drop ball(make_icosphere(Vector3d::Zero(), 0.1, 6));
  EXPECT_EQ(cut_necks(ball, 0.5).cuts, 0u);
  Drop thread(make_ellipsoid(Vector3d::Zero(), {0.1, 0.1, 1}, 0.03));
  EXPECT_EQ(cut_necks(thread, 0.3).cuts, 0u);
  EXPECT_THROW(cut_necks(ball, 0), UsageError);
  EXPECT_THROW(cut_necks(ball, std::nan("")), UsageError);
}

TEST(RemeshIsotropic, CarriesAttributesByProjection) {
  Mesh mesh = random_shapes::irregular_sphere(1, 12, 0.3, 2);
  auto linear = mesh.add_property_map<VertexIndex, double>("v:linear", 0).first;
  mesh.add_property_map<VertexIndex, double>("v:constant", 0.1);
  mesh.add_property_map<VertexIndex, std::uint8_t>("v:whole", 3);
  const auto f = [](const Vector3d& x) { return x.x() + 2 * x.y() - x.z(); };
  for (const auto v : mesh.vertices()) linear[v] = f(to_eigen(mesh.point(v)));
  const double h = mean_edge(mesh);
  remesh_isotropic(mesh, 0.7 * h, 3);
  EXPECT_EQ(judge::defect(mesh), "");
  EXPECT_NEAR(mean_edge(mesh), 0.7 * h, 0.1 * h);
  linear = mesh.property_map<VertexIndex, double>("v:linear").first;
  const auto constant = mesh.property_map<VertexIndex, double>("v:constant").first;
  const auto whole = mesh.property_map<VertexIndex, std::uint8_t>("v:whole").first;
  for (const auto v : mesh.vertices()) {
    EXPECT_NEAR(linear[v], f(to_eigen(mesh.point(v))), 1e-9);  // it projects onto the old faces
    EXPECT_EQ(constant[v], 0.1);
    EXPECT_EQ(whole[v], 3);
  }
}

TEST(RemeshIsotropic, KeepsSharpEdgesAndRefusesNonsense) {
  Mesh mesh = make_box(Vector3d::Zero(), {1, 1, 1}, 0.2);
  for (const double target : {0.0, -1.0, std::nan(""), 1e-5})
    EXPECT_THROW(remesh_isotropic(mesh, target, 3), UsageError);
  EXPECT_THROW(remesh_isotropic(mesh, 0.1, 0), UsageError);
  Mesh empty;
  EXPECT_THROW(remesh_isotropic(empty, 0.1, 3), GeometryError);
  remesh_isotropic(mesh, 0.1, 3, 0.7);
  Drop drop(mesh);
  EXPECT_NEAR(drop.volume(), 1, 1e-9);
}

}  // namespace
}  // namespace meniscus
