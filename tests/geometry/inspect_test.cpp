// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/geometry/inspect.h"

#include "meniscus/geometry/self_intersection.h"
#include "meniscus/geometry/shapes.h"

#include <CGAL/intersections.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace meniscus {
namespace {

constexpr double pi = 3.14159265358979323846;
const Eigen::Vector3d origin = Eigen::Vector3d::Zero();

MeshData tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}, {}, {}, {}};
}

MeshData sphere(const Eigen::Vector3d& center, double radius, int frequency = 3) {
  return to_mesh_data(make_icosphere(center, radius, frequency));
}

MeshData inside_out(MeshData data) {
  for (auto& t : data.triangles) std::swap(t[1], t[2]);
  return data;
}

MeshData together(MeshData a, const MeshData& b) {
  const auto shift = static_cast<std::uint32_t>(a.points.size());
  a.points.insert(a.points.end(), b.points.begin(), b.points.end());
  for (const auto& t : b.triangles) a.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  return a;
}

const Defect* find(const Inspection& inspection, DefectKind kind) {
  const auto it = std::find_if(inspection.defects.begin(), inspection.defects.end(),
                               [&](const Defect& d) { return d.kind == kind; });
  return it == inspection.defects.end() ? nullptr : &*it;
}

std::vector<std::string> kinds(const Inspection& inspection) {
  std::vector<std::string> names;
  for (const auto& defect : inspection.defects) names.push_back(name(defect.kind));
  return names;
}
using Names = std::vector<std::string>;
using Ids = std::vector<std::size_t>;

void expect_sound(const MeshData& data, std::size_t components, std::int64_t genus) {
  const Inspection i = inspect(data);
  EXPECT_TRUE(i.sound && i.closed && i.manifold && i.outward && i.bounds_volume && !i.self_intersecting);
  EXPECT_EQ(kinds(i), Names{});
  EXPECT_EQ(i.components, components);
  EXPECT_EQ(i.genus, genus);
}

TEST(Inspect, SoundShapes) {
  expect_sound(tetrahedron(), 1, 0);
  expect_sound(sphere({1, 2, 3}, 0.5), 1, 0);
  expect_sound(to_mesh_data(make_torus(origin, 1, 0.4, 0.15)), 1, 1);
  expect_sound(to_mesh_data(make_box(origin, {1, 2, 3}, 0.5)), 1, 0);
  expect_sound(to_mesh_data(make_cap(origin, {1, 2, 3}, 1, 0.4, 0.1)), 1, 0);
  expect_sound(to_mesh_data(make_cap(origin, {0, 0, 1}, 1, 2.6, 0.2)), 1, 0);
  expect_sound(to_mesh_data(make_dumbbell(4, 1, 0.2, 0.1)), 1, 0);
  expect_sound(together(sphere(origin, 1), to_mesh_data(make_torus(origin, 3, 0.4, 0.2))), 2, 1);
}

TEST(Inspect, Measures) {
  const Inspection i = inspect(to_mesh_data(make_box(origin, {1, 2, 3}, 1)));
  EXPECT_EQ(i.faces, 2u * 2 * (2 + 3 + 6));
  EXPECT_EQ(i.vertices, i.faces / 2 + 2);
  EXPECT_NEAR(i.volume, 6, 1e-14);
  EXPECT_NEAR(i.area, 22, 1e-13);
  EXPECT_NEAR(i.edge_length.min, 1, 1e-15);
  EXPECT_NEAR(i.edge_length.max, std::sqrt(2), 1e-15);
  EXPECT_NEAR(i.angle.least, pi / 4, 1e-15);
  EXPECT_NEAR(i.angle.greatest, pi / 2, 1e-15);
}

TEST(Inspect, Empty) {
  const Inspection i = inspect({});
  EXPECT_EQ(kinds(i), Names{"empty_mesh"});
  EXPECT_FALSE(i.sound || i.closed || i.outward || i.bounds_volume);
  MeshData points_only;
  points_only.points = {{0, 0, 0}};
  EXPECT_EQ(kinds(inspect(points_only)), (Names{"empty_mesh", "isolated_vertex"}));
}

TEST(Inspect, NonFinite) {
  MeshData data = tetrahedron();
  data.points[3][2] = std::numeric_limits<double>::infinity();
  data.points[1][0] = std::nan("");
  const Inspection i = inspect(data);
  EXPECT_EQ(kinds(i), Names{"non_finite_coordinate"});
  EXPECT_EQ(i.defects[0].vertices, (Ids{1, 3}));
  EXPECT_TRUE(i.closed && i.manifold);
  EXPECT_FALSE(i.outward || i.bounds_volume || i.sound);
}

TEST(Inspect, IndexOutOfRange) {
  MeshData data = tetrahedron();
  data.triangles.push_back({0, 1, 4});
  data.triangles.push_back({4294967295u, 1, 2});
  const Inspection i = inspect(data);
  EXPECT_EQ(kinds(i), Names{"index_out_of_range"});
  EXPECT_EQ(i.defects[0].faces, (Ids{4, 5}));
  EXPECT_FALSE(i.sound || i.closed || i.manifold);
}

TEST(Inspect, RepeatedVertex) {
  MeshData data = tetrahedron();
  data.triangles.push_back({1, 1, 2});
  const Inspection i = inspect(data);
  EXPECT_EQ(kinds(i), Names{"repeated_vertex_in_face"});
  EXPECT_EQ(i.defects[0].faces, Ids{4});
  EXPECT_FALSE(i.sound);
}

/// The tetrahedron with the middle of edge 1-2 inserted in face 3 only, and a face without area in between.
TEST(Inspect, DegenerateFace) {
  MeshData data = tetrahedron();
  data.points.push_back({0.5, 0.5, 0});
  data.triangles.pop_back();
  data.triangles.insert(data.triangles.end(), {{1, 4, 3}, {4, 2, 3}, {1, 2, 4}});
  const Inspection i = inspect(data);
  EXPECT_EQ(kinds(i), (Names{"degenerate_face", "self_intersection"}));  // the middle touches face 0, too
  EXPECT_EQ(i.defects[0].faces, Ids{5});
  EXPECT_TRUE(i.closed && i.manifold && i.outward);
  EXPECT_FALSE(i.sound);
  data.points[4] = {0.5, 0.5, 0x1p-50};  // not on the line, by next to nothing
  EXPECT_EQ(find(inspect(data), DefectKind::degenerate_face), nullptr);
}

TEST(Inspect, DuplicateFace) {
  MeshData data = tetrahedron();
  data.triangles.push_back({2, 3, 1});
  const Inspection same = inspect(data);
  ASSERT_NE(find(same, DefectKind::duplicate_face), nullptr);
  EXPECT_EQ(find(same, DefectKind::duplicate_face)->faces, Ids{4});
  EXPECT_NE(find(same, DefectKind::non_manifold_edge), nullptr);
  EXPECT_FALSE(same.sound || same.manifold);
  const MeshData pillow{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}, {}, {}, {}};
  const Inspection turned = inspect(pillow);
  EXPECT_EQ(kinds(turned), (Names{"duplicate_face", "inside_out_component"}));
  EXPECT_FALSE(turned.sound || turned.outward || turned.bounds_volume);
}

TEST(Inspect, BoundaryByHole) {
  MeshData data = sphere(origin, 1);
  data.triangles.erase(data.triangles.begin() + 100);
  data.triangles.erase(data.triangles.begin());
  const Inspection i = inspect(data);
  EXPECT_EQ(kinds(i), (Names{"boundary_edge", "boundary_edge"}));
  EXPECT_EQ(i.defects[0].vertices.size(), 3u);
  EXPECT_EQ(i.defects[0].faces.size(), 3u);
  EXPECT_FALSE(i.closed || i.outward || i.bounds_volume || i.sound);
  EXPECT_TRUE(i.manifold);
  EXPECT_FALSE(i.genus.has_value());
}

TEST(Inspect, ManyHolesAreSummedUp) {
  MeshData data;
  for (std::uint32_t k = 0; k < 50; ++k) {
    const double z = k;
    data.points.insert(data.points.end(), {{0, 0, z}, {1, 0, z}, {0, 1, z}});
    data.triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
  }
  const Inspection i = inspect(data);
  EXPECT_EQ(i.defects.size(), 21u);
  EXPECT_NE(i.defects.back().message.find("30 more"), std::string::npos);
  EXPECT_EQ(i.components, 50u);
}

TEST(Inspect, InconsistentOrientation) {
  MeshData data = tetrahedron();
  std::swap(data.triangles[2][0], data.triangles[2][1]);
  const Inspection i = inspect(data);
  EXPECT_EQ(kinds(i), Names{"inconsistent_orientation"});
  EXPECT_EQ(i.defects[0].faces.size(), 6u);  // three edges
  EXPECT_TRUE(i.closed && i.manifold);
  EXPECT_FALSE(i.outward || i.bounds_volume || i.sound);
}

TEST(Inspect, TetrahedraSharingAVertex) {
  MeshData data = tetrahedron();
  data.points.insert(data.points.end(), {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}});
  for (const auto& t : tetrahedron().triangles) {
    const auto move = [](std::uint32_t v) { return v == 0 ? 0 : v + 3; };
    data.triangles.push_back({move(t[0]), move(t[2]), move(t[1])});
  }
  const Inspection i = inspect(data);
  EXPECT_EQ(kinds(i), Names{"pinched_vertex"});
  EXPECT_EQ(i.defects[0].vertices, Ids{0});
  EXPECT_EQ(i.components, 2u);
  EXPECT_TRUE(i.closed && i.outward);
  EXPECT_FALSE(i.manifold || i.self_intersecting || i.bounds_volume || i.sound);
}

TEST(Inspect, TetrahedraSharingAnEdge) {
  MeshData data = tetrahedron();
  data.points.insert(data.points.end(), {{-1, 0, 0}, {0, -1, 0}});  // mirrored through the z axis, edge 0-3
  const std::array<std::uint32_t, 4> image{0, 4, 5, 3};
  for (const auto& t : tetrahedron().triangles) data.triangles.push_back({image[t[0]], image[t[1]], image[t[2]]});
  const Inspection i = inspect(data);
  EXPECT_EQ(kinds(i), Names{"non_manifold_edge"});
  EXPECT_EQ(i.defects[0].vertices, (Ids{0, 3}));
  EXPECT_EQ(i.defects[0].faces, (Ids{1, 2, 5, 6}));
  EXPECT_TRUE(i.closed);
  EXPECT_FALSE(i.manifold || i.bounds_volume || i.sound || i.self_intersecting);
}

TEST(Inspect, IsolatedVertex) {
  MeshData data = tetrahedron();
  data.points.push_back({0.1, 0.1, 0.1});
  const Inspection i = inspect(data);
  EXPECT_EQ(kinds(i), Names{"isolated_vertex"});
  EXPECT_EQ(i.defects[0].vertices, Ids{4});
  EXPECT_TRUE(i.bounds_volume);
  EXPECT_EQ(i.genus, 0);
  EXPECT_FALSE(i.sound);
}

TEST(Inspect, UnweldedFacesCoincide) {
  MeshData data;
  for (const auto& t : tetrahedron().triangles) {
    const auto n = static_cast<std::uint32_t>(data.points.size());
    for (const auto v : t) data.points.push_back(tetrahedron().points[v]);
    data.triangles.push_back({n, n + 1, n + 2});
  }
  data.points[0] = {-0.0, 0, 0};  // equal to 0 all the same
  const Inspection i = inspect(data);
  ASSERT_NE(find(i, DefectKind::coincident_vertices), nullptr);
  EXPECT_NE(find(i, DefectKind::coincident_vertices)->message.find("12 vertices"), std::string::npos);
  EXPECT_FALSE(i.closed || i.sound);
}

TEST(Inspect, InsideOut) {
  const Inspection i = inspect(inside_out(sphere(origin, 1)));
  EXPECT_EQ(kinds(i), Names{"inside_out_component"});
  EXPECT_TRUE(i.closed && i.manifold);
  EXPECT_LT(i.volume, 0);
  EXPECT_FALSE(i.outward || i.bounds_volume || i.sound);
}

TEST(Inspect, InsideOutBesideAGoodOne) {
  const Inspection i = inspect(together(sphere(origin, 2), inside_out(sphere({5, 0, 0}, 1))));
  EXPECT_EQ(kinds(i), Names{"inside_out_component"});
  EXPECT_EQ(i.defects[0].faces, Ids{180});  // the first face of the second sphere
  EXPECT_GT(i.volume, 0);
  EXPECT_FALSE(i.outward || i.bounds_volume || i.sound);
}

TEST(Inspect, CavitiesAlternate) {
  const MeshData drop = sphere(origin, 3), bubble = inside_out(sphere(origin, 2)), inner = sphere({0.1, 0, 0}, 1);
  expect_sound(together(drop, bubble), 2, 0);
  expect_sound(together(together(drop, bubble), inner), 3, 0);
  expect_sound(together(inner, together(bubble, drop)), 3, 0);
  const Inspection i = inspect(together(drop, inner));
  EXPECT_EQ(kinds(i), Names{"inside_out_component"});
  EXPECT_TRUE(i.outward);
  EXPECT_FALSE(i.bounds_volume || i.sound);
}

/// A drop in the box of a ring but not in the ring, and one in its tube; rays through edges and vertices.
TEST(Inspect, NestingIsNotJudgedByBoxes) {
  const MeshData ring = to_mesh_data(make_torus(origin, 2, 0.8, 0.4));
  expect_sound(together(ring, sphere(origin, 0.5)), 2, 1);
  expect_sound(together(ring, inside_out(sphere({-2, 0, 0}, 0.3))), 2, 1);
  const MeshData box = to_mesh_data(make_box(origin, {8, 8, 8}, 1));  // its vertices and diagonals lie on the rays
  expect_sound(together(box, inside_out(to_mesh_data(make_box(origin, {2, 2, 2}, 1)))), 2, 0);
}

TEST(Inspect, TouchingSpheres) {
  // Icospheres have vertices (0, +-1, +-t) and so on; two that meet in one point do so at a vertex.
  const MeshData one = sphere(origin, 1);
  MeshData two = one;
  const Eigen::Vector3d tip = Eigen::Vector3d::Map(one.points[0].data());
  for (auto& p : two.points)
    for (int d = 0; d < 3; ++d) p[d] = 2 * tip[d] - p[d];
  const Inspection i = inspect(together(one, inside_out(two)));
  EXPECT_TRUE(i.self_intersecting);
  EXPECT_NE(find(i, DefectKind::coincident_vertices), nullptr);
  EXPECT_TRUE(i.closed && i.manifold && i.outward);
  EXPECT_FALSE(i.sound || i.bounds_volume);
}

TEST(Inspect, OverlappingSpheres) {
  const Inspection i = inspect(together(sphere(origin, 1), sphere({1, 0, 0}, 1)));
  EXPECT_EQ(kinds(i), Names{"self_intersection"});
  EXPECT_LE(i.defects[0].faces.size(), 20u);
  EXPECT_TRUE(i.self_intersecting && i.outward);
  EXPECT_FALSE(i.bounds_volume || i.sound);
}

TEST(Inspect, FoldedNeighbours) {
  MeshData data = sphere(origin, 1);  // a vertex pulled through the opposite side
  for (auto& x : data.points[0]) x = -1.5 * x;
  EXPECT_TRUE(inspect(data).self_intersecting);
  // Two faces with a common edge, folded flat onto each other.
  const MeshData flap{{{0, 0, 0}, {1, 0, 0}, {0.3, 1, 0}, {0.6, 1, 0}}, {{0, 1, 2}, {1, 0, 3}}, {}, {}, {}};
  EXPECT_EQ(self_intersections(flap, 10), (std::vector<std::array<std::uint32_t, 2>>{{0, 1}}));
  // Two faces with a common vertex in one plane: apart, and one over the other.
  MeshData fan{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}, {{0, 1, 2}, {0, 3, 4}}, {}, {}, {}};
  EXPECT_TRUE(self_intersections(fan, 10).empty());
  fan.points[3] = {0.2, 0.1, 0}, fan.points[4] = {0.1, 0.2, 0};
  EXPECT_EQ(self_intersections(fan, 10).size(), 1u);
}

/// A disc of slivers around its centre and the same seen from below: all boxes overlap, no face does.
TEST(Inspect, FansOfSlivers) {
  const std::uint32_t n = 400;
  MeshData cone;
  cone.points = {{0, 0, 0}, {0, 0, 1}};
  for (std::uint32_t k = 0; k < n; ++k) {
    cone.points.push_back({std::cos(2 * pi * k / n), std::sin(2 * pi * k / n), 0});
    cone.triangles.push_back({0, 2 + (k + 1) % n, 2 + k});
    cone.triangles.push_back({1, 2 + k, 2 + (k + 1) % n});
  }
  EXPECT_TRUE(inspect(cone).sound);
  std::swap(cone.points[2], cone.points[3]);  // now slivers overlap
  EXPECT_TRUE(inspect(cone).self_intersecting);
}

/// The quick answers never contradict the exact ones: triangles around one vertex, on a small lattice.
RC_GTEST_PROP(Inspect, TrianglesAtAVertexMeetAsTheirSidesDo, ()) {
  const auto lattice = [] { return double(*rc::gen::inRange(-2, 3)); };
  MeshData data{{{0, 0, 0}}, {{0, 1, 2}, {0, 3, 4}}, {}, {}, {}};
  for (int k = 0; k < 4; ++k) data.points.push_back({lattice(), lattice(), lattice()});
  const auto at = [&](int v) { return Point(data.points[v][0], data.points[v][1], data.points[v][2]); };
  RC_PRE(!CGAL::collinear(at(0), at(1), at(2)) && !CGAL::collinear(at(0), at(3), at(4)));
  const bool meet = CGAL::do_intersect(Kernel::Triangle_3(at(0), at(1), at(2)), Kernel::Segment_3(at(3), at(4))) ||
                    CGAL::do_intersect(Kernel::Triangle_3(at(0), at(3), at(4)), Kernel::Segment_3(at(1), at(2)));
  RC_ASSERT(!self_intersections(data, 1).empty() == meet);
}

TEST(Inspect, HugeAndTinyCoordinates) {
  for (const double scale : {1e300, 1e-300}) {
    MeshData data = sphere(origin, 1);
    for (auto& p : data.points)
      for (auto& x : p) x *= scale;
    const Inspection i = inspect(data);
    EXPECT_TRUE(i.sound) << scale;
    EXPECT_FALSE(std::isnan(i.volume));
  }
  MeshData spike = tetrahedron();
  spike.points[3] = {0, 0, 1e300};
  EXPECT_TRUE(inspect(spike).sound);
  EXPECT_NEAR(inspect(spike).volume, 1e300 / 6, 1e286);
}

TEST(Inspect, FacesAsTheFileCountsThem) {
  MeshData data = tetrahedron();
  data.triangles.push_back({1, 1, 2});
  data.source_face = {0, 0, 1, 2, 7};
  EXPECT_EQ(inspect(data).defects[0].faces, Ids{7});
}

TEST(Inspect, StopsCountingIntersections) {
  MeshData data;  // 300 triangles through one line: 44850 pairs
  for (std::uint32_t k = 0; k < 300; ++k) {
    const double c = std::cos(k * 0.01), s = std::sin(k * 0.01);
    data.points.insert(data.points.end(), {{c, s, 0}, {-c, -s, 0}, {0, 0, 1 + k * 1e-3}});
    data.triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
  }
  const Inspection i = inspect(data);
  ASSERT_NE(find(i, DefectKind::self_intersection), nullptr);
  EXPECT_EQ(find(i, DefectKind::self_intersection)->message.rfind("at least 1000 pairs", 0), 0u);
}

RC_GTEST_PROP(Inspect, AnySoupIsInspected, ()) {
  MeshData data;
  const auto coordinate = rc::gen::element(0.0, 1.0, -1.0, 0.5, 1e300, -1e-300, std::nan(""), -HUGE_VAL);
  const std::size_t n = *rc::gen::inRange(0, 9), m = *rc::gen::inRange(0, 25);
  for (std::size_t v = 0; v < n; ++v) data.points.push_back({*coordinate, *coordinate, *coordinate});
  for (std::size_t t = 0; t < m; ++t) {
    const auto index = rc::gen::inRange<std::uint32_t>(0, static_cast<std::uint32_t>(n) + 2);
    data.triangles.push_back({*index, *index, *index});
  }
  const Inspection i = inspect(data);
  RC_ASSERT(i.faces == m);
  RC_ASSERT(i.sound == (i.bounds_volume && i.defects.empty()));
  RC_ASSERT(i.sound || !i.defects.empty());  // whatever is wrong has a name
}

RC_GTEST_PROP(Inspect, RenumberingChangesNothing, ()) {
  MeshData data = together(sphere(origin, 1, 2), sphere({*rc::gen::element(0.5, 1.5, 3.0), 0.1, 0}, 0.4, 2));
  const Inspection before = inspect(data);
  std::vector<std::uint32_t> order(data.points.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto keys = *rc::gen::container<std::vector<int>>(order.size(), rc::gen::arbitrary<int>());
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return keys[a] < keys[b]; });
  MeshData renumbered = data;
  for (std::size_t v = 0; v < order.size(); ++v) renumbered.points[order[v]] = data.points[v];
  for (auto& t : renumbered.triangles) t = {order[t[1]], order[t[2]], order[t[0]]};
  std::reverse(renumbered.triangles.begin(), renumbered.triangles.end());
  const Inspection after = inspect(renumbered);
  RC_ASSERT(before.sound == after.sound);
  RC_ASSERT(before.genus == after.genus);
  RC_ASSERT(kinds(before) == kinds(after));
  RC_ASSERT(std::abs(before.volume - after.volume) < 1e-13);
}

}  // namespace
}  // namespace meniscus
