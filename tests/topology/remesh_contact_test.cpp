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
#include <cmath>
#include <map>
#include <optional>
#include <set>

namespace meniscus {
namespace {

using Eigen::Vector3d;
using random_shapes::mean_edge;
using random_shapes::Numbers;

/// A cap on the plane z = 0, its bottom wetted.
Drop cap_on_plane(double angle, double edge) {
  Drop drop(make_cap(Vector3d::Zero(), Vector3d::UnitZ(), 1, angle, edge));
  const auto x = drop.positions();
  for (std::uint32_t v = 0; v < drop.num_rows(); ++v)
    if (std::abs(x(2, v)) < 1e-9) {
      drop.contact()[v] = Contact::wetted;
      drop.contact_solid()[v] = 0;
      drop.contact_normals().col(v) = Vector3d::UnitZ();
    }
  for (std::uint32_t v = 0; v < drop.num_rows(); ++v) {
    const Ring ring = drop.connectivity().ring(v);
    for (int k = 0; k < ring.degree; ++k)
      if (is_colliding(drop.contact()[v]) && drop.contact()[ring.neighbour[k]] == Contact::free)
        drop.contact()[v] = Contact::line;
  }
  return drop;
}

/// Edges with a wet face on one side only, as vertex pairs.
std::set<std::pair<std::uint32_t, std::uint32_t>> contact_line(const Drop& drop) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> line;
  const Mesh& mesh = drop.mesh();
  const auto is_wet = [&](HalfedgeIndex h) {
    for (const auto v : CGAL::vertices_around_face(h, mesh))
      if (!is_colliding(drop.contact()[v])) return false;
    return true;
  };
  for (const auto h : mesh.halfedges())
    if (is_wet(h) && !is_wet(mesh.opposite(h)))
      line.emplace(std::min(mesh.source(h), mesh.target(h)), std::max(mesh.source(h), mesh.target(h)));
  return line;
}

TEST(Remesh, KeepsTheContactLineAClosedCurveOnTheSolid) {
  for (const double angle : {0.6, 1.5, 2.4})
    for (const double scale : {0.5, 1.0, 2.0}) {
      Drop drop = cap_on_plane(angle, 0.1);
      const auto report = remesh(drop, band(0.06 * scale, 0.15 * scale, 4, 0.3));
      EXPECT_TRUE(report.changed());
      EXPECT_EQ(judge::defect(drop), "");
      std::map<std::uint32_t, int> ends;
      for (const auto& [a, b] : contact_line(drop)) {
        ++ends[a];
        ++ends[b];
      }
      EXPECT_GE(ends.size(), 10u);
      for (const auto& [v, count] : ends) {
        EXPECT_EQ(count, 2);
        EXPECT_EQ(drop.contact()[v], Contact::line);
        EXPECT_NEAR(drop.positions().col(v).norm(), 1, 0.2 * scale);
      }
      for (const auto v : drop.mesh().vertices())
        if (is_colliding(drop.contact()[v])) {
          EXPECT_NEAR(drop.positions()(2, static_cast<Eigen::Index>(v)), 0, 1e-12);
          EXPECT_NEAR(drop.contact_normals()(2, static_cast<Eigen::Index>(v)), 1, 1e-12);
          EXPECT_EQ(drop.contact_solid()[v], 0);
        } else {
          EXPECT_EQ(drop.contact_solid()[v], -1);
        }
    }
}

TEST(Remesh, NeverFlipsTheContactLine) {
  Drop drop = cap_on_plane(1.2, 0.08);
  Numbers numbers(1);
  for (const auto v : drop.mesh().vertices())  // so irregular that many edges want to flip
    if (drop.contact()[v] != Contact::line) {
      Vector3d step = numbers.vector(0.03);
      if (drop.contact()[v] == Contact::wetted) step.z() = 0;
      drop.mesh().point(v) = to_point(to_eigen(drop.mesh().point(v)) + step);
    }
  const auto before = contact_line(drop);
  const auto report = remesh(drop, band(1e-4, 10));
  EXPECT_GT(report.flips, 20u);
  EXPECT_EQ(report.splits + report.collapses, 0u);
  EXPECT_EQ(contact_line(drop), before);
}

/// Faces of three colliding vertices that do not face the plane z = 0.
std::size_t count_turned(const Drop& drop) {
  std::size_t count = 0;
  const auto x = drop.positions();
  for (const auto& [a, b, c] : drop.connectivity().triangles()) {
    if (a == Connectivity::removed || !is_colliding(drop.contact()[a]) || !is_colliding(drop.contact()[b]) ||
        !is_colliding(drop.contact()[c]))
      continue;
    count += !(Vector3d(x.col(b) - x.col(a)).cross(Vector3d(x.col(c) - x.col(a))).z() < 0);
  }
  return count;
}

/// Colliding vertices are marked as on the line just if they have a free neighbour.
bool has_true_contact(const Drop& drop) {
  for (const auto v : drop.mesh().vertices()) {
    if (!is_colliding(drop.contact()[v])) continue;
    const Ring ring = drop.connectivity().ring(v);
    bool has_free = false;
    for (int k = 0; k < ring.degree; ++k) has_free |= !is_colliding(drop.contact()[ring.neighbour[k]]);
    if (has_free != (drop.contact()[v] == Contact::line)) return false;
  }
  return true;
}

/// Moves every `stride`th vertex of the line of a cap of radius 1 inward.
void push_line_inward(Drop& drop, double by, int stride) {
  int count = 0;
  for (const auto v : drop.mesh().vertices())
    if (drop.contact()[v] == Contact::line && count++ % stride == 0)
      drop.mesh().point(v) = to_point((1 - by) * to_eigen(drop.mesh().point(v)));
}

TEST(Remesh, UnfoldsTheWettedAreaThatTheLineOvertook) {
  std::size_t turned = 0;
  for (const double angle : {0.6, 1.1, 1.5, 2.0, 2.4})
    for (const double share : {0.5, 0.8, 1.1})
      for (const int stride : {1, 2, 3, 5, 1000}) {
        constexpr double edge = 0.1;
        Drop drop = cap_on_plane(angle, edge);
        push_line_inward(drop, share * edge, stride);
        turned += count_turned(drop);
        remesh(drop, band(0.5 * edge, 1.5 * edge, 3));
        EXPECT_EQ(count_turned(drop), 0u) << angle << " " << share << " " << stride;
        EXPECT_TRUE(has_true_contact(drop));
        EXPECT_EQ(judge::defect(drop), "") << angle << " " << share << " " << stride;
      }
  EXPECT_GT(turned, 100u);  // or nothing was tested
}

TEST(Remesh, LiftsAFilmOfNoThickness) {
  Drop drop = cap_on_plane(0.9, 0.1);
  // Free neighbours of the line fall onto the plane, inside of it: their faces with the line lie on wet ones.
  std::vector<VertexIndex> fallen;
  for (const auto v : drop.mesh().vertices()) {
    const Ring ring = drop.connectivity().ring(v);
    bool is_near_line = false, is_near_fallen = false;
    for (int k = 0; k < ring.degree; ++k) {
      is_near_line |= drop.contact()[ring.neighbour[k]] == Contact::line;
      for (const auto w : fallen) is_near_fallen |= w == VertexIndex(ring.neighbour[k]);
    }
    if (drop.contact()[v] == Contact::free && is_near_line && !is_near_fallen) fallen.push_back(v);
  }
  ASSERT_GT(fallen.size(), 5u);
  for (const auto v : fallen) {
    Point& p = drop.mesh().point(v);
    p = Point(p.x(), p.y(), 0);
    drop.contact()[v] = Contact::line;
    drop.contact_solid()[v] = 0;
    drop.contact_normals().col(v) = Vector3d::UnitZ();
  }
  EXPECT_GT(count_turned(drop), 5u);
  const auto report = remesh(drop, band(0.05, 0.15, 3));
  EXPECT_GT(report.lifts, 0u);
  EXPECT_EQ(count_turned(drop), 0u);
  EXPECT_TRUE(has_true_contact(drop));
  EXPECT_EQ(judge::defect(drop), "");
}

/// Shakes every vertex by up to `by`; colliding ones stay on the plane z = 0, free ones above it.
void shake(Drop& drop, double by, Numbers& numbers) {
  for (const auto v : drop.mesh().vertices()) {
    const Vector3d x = to_eigen(drop.mesh().point(v));
    Vector3d step = numbers.vector(by);
    if (is_colliding(drop.contact()[v]) || x.z() + step.z() < 0.5 * x.z()) step.z() = 0;
    drop.mesh().point(v) = to_point(x + step);
  }
}

/// Nothing if no piece is more than a tetrahedron.
std::optional<Drop> largest_piece(const Drop& drop) {
  SplitReport report;
  const std::vector<Drop> pieces = split_components(drop, report);
  std::size_t largest = 0;
  for (std::size_t k = 1; k < pieces.size(); ++k)
    if (pieces[k].volume() > pieces[largest].volume()) largest = k;
  return pieces.empty() ? std::nullopt : std::make_optional(pieces[largest]);
}

// From sound meshes remesh makes none that lie on themselves, whatever the contact angle and the band.
TEST(Remesh, MakesNoFilmOnTheSolid) {
  int tried = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    Numbers numbers(seed);
    Drop drop = cap_on_plane(numbers.between(0.25, 2.8), numbers.between(0.06, 0.2));
    for (int round = 0; round < 4; ++round) {
      const double h = mean_edge(drop.mesh());
      shake(drop, 0.25 * h, numbers);
      if (count_turned(drop) > 0 || judge::meets_itself(drop.mesh())) break;
      ++tried;
      const double low = h * numbers.log_between(0.4, 1.6);
      if (remesh(drop, band(low, 3 * low, 3)).cuts > 0) {
        const auto piece = largest_piece(drop);
        if (!piece) break;
        drop = *piece;
      }
      ASSERT_EQ(count_turned(drop), 0u) << seed << " " << round;
      ASSERT_TRUE(has_true_contact(drop)) << seed << " " << round;
      ASSERT_EQ(judge::defect(drop), "") << seed << " " << round;
      for (const auto v : drop.mesh().vertices())
        ASSERT_TRUE(is_colliding(drop.contact()[v]) || drop.mesh().point(v).z() > 0) << seed << " " << round;
    }
  }
  EXPECT_GT(tried, 60);
}

TEST(Remesh, MakesTheWettedAreaCoarser) {
  const auto wet_vertices = [](double weight) {
    Drop drop = cap_on_plane(1.5, 0.06);
    RemeshOptions options = band(0.05, 0.15, 4);
    options.band.wetted_weight = weight;
    remesh(drop, options);
    EXPECT_EQ(judge::defect(drop), "");
    std::size_t count = 0;
    for (const auto v : drop.mesh().vertices()) count += drop.contact()[v] == Contact::wetted;
    return count;
  };
  EXPECT_LT(wet_vertices(0.5), 0.6 * static_cast<double>(wet_vertices(1)));
}

}  // namespace
}  // namespace meniscus
