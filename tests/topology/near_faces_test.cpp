// SPDX-License-Identifier: GPL-3.0-or-later
// What finds faces near each other, against a look at all of them.
#include "../../src/topology/fold_finder.h"
#include "../../src/topology/placed_face.h"
#include "../../src/topology/sorted_boxes.h"
#include "../../src/topology/watched_region.h"
#include "meniscus/geometry/shapes.h"

#include <gtest/gtest.h>

#include <random>

namespace meniscus {
namespace {

using Eigen::Vector3d;

/// Boxes with corners on a lattice, so that many touch, some are flat and some are points.
std::vector<FaceBox> lattice_boxes(std::size_t count, int size, unsigned seed) {
  std::mt19937 numbers(seed);
  std::uniform_int_distribution<int> place(0, size), side(0, 2);
  std::vector<FaceBox> boxes;
  for (std::uint32_t k = 0; k < count; ++k) {
    const Vector3d low(2 * place(numbers), place(numbers), place(numbers));
    boxes.push_back({{low, low + Vector3d(side(numbers), side(numbers), side(numbers))}, k});
  }
  return boxes;
}

std::vector<SortedBoxes::Pair> all_pairs(const std::vector<FaceBox>& boxes) {
  std::vector<SortedBoxes::Pair> pairs;
  for (std::uint32_t a = 0; a < boxes.size(); ++a)
    for (std::uint32_t b = a + 1; b < boxes.size(); ++b)
      if (boxes[a].box.intersects(boxes[b].box)) pairs.push_back({a, b});
  return pairs;
}

TEST(SortedBoxes, FindEachPairThatMeetsOnce) {
  for (const std::size_t count : {0, 1, 2, 5, 300, 4100}) {
    const std::vector<FaceBox> boxes = lattice_boxes(count, count > 1000 ? 24 : 8, 7);
    // From 2,048 boxes on they are looked for in chunks.
    auto visited = SortedBoxes(boxes).pairs_if([](std::uint32_t, std::uint32_t) { return true; });
    std::sort(visited.begin(), visited.end());
    EXPECT_EQ(visited, all_pairs(boxes)) << count;
    EXPECT_TRUE(count < 300 || visited.size() > count);
  }
}

TEST(SortedBoxes, FindThoseThatMeetAGivenBox) {
  const std::vector<FaceBox> boxes = lattice_boxes(301, 8, 7);
  const SortedBoxes sorted(boxes);
  for (const FaceBox& query : lattice_boxes(100, 9, 8)) {
    std::vector<std::uint32_t> found, expected;
    sorted.for_each_meeting(query.box, [&](std::uint32_t k) { found.push_back(k); });
    std::sort(found.begin(), found.end());
    for (std::uint32_t k = 0; k < boxes.size(); ++k)
      if (query.box.intersects(boxes[k].box)) expected.push_back(k);
    EXPECT_EQ(found, expected);
  }
}

/// Faces around a vertex that is smooth are not asked one by one: the answers are those of `meet` all the same, from a
/// round surface to a crumpled one, and where not all faces around a vertex are in the list.
TEST(FacesThatMeet, AreThoseOfALookAtAllPairs) {
  std::mt19937 numbers(11);
  std::size_t num_meeting = 0;
  for (const double noise : {0.0, 0.05, 0.1, 0.15, 0.2, 0.3, 1.0}) {
    Drop drop(make_icosphere(Vector3d(0.3, -7, 2), 1, 6));
    std::normal_distribution<double> move(0, 1);
    for (std::uint32_t v = 0; v < drop.num_rows() && noise > 0; ++v)
      drop.positions().col(v) += noise * Vector3d(move(numbers), move(numbers), move(numbers));
    const MeshView mesh = view_of(std::as_const(drop));
    for (const double share : {1.0, 0.7}) {
      std::vector<FaceBox> faces = faces_in(mesh, box_of(mesh));
      faces.erase(std::remove_if(faces.begin(), faces.end(),
                                 [&](const FaceBox&) { return std::generate_canonical<double, 32>(numbers) > share; }),
                  faces.end());
      std::vector<FacePair> expected;
      for (std::size_t a = 0; a < faces.size(); ++a)
        for (std::size_t b = a + 1; b < faces.size(); ++b)
          if (faces[a].box.intersects(faces[b].box) &&
              meet(placed_face(mesh, faces[a].face), placed_face(mesh, faces[b].face)))
            expected.push_back({faces[a].face, faces[b].face});
      EXPECT_EQ(faces_that_meet(mesh, faces), expected) << noise << ", " << share;
      if (noise == 0) {
        EXPECT_TRUE(expected.empty());
      }
      num_meeting += expected.size();
    }
  }
  EXPECT_GT(num_meeting, 1000u);
}

TEST(WatchedRegion, ReachesFromOneToTwoReachesFromAWatchedVertex) {
  Drop drop(make_icosphere(Vector3d(0.3, -7, 2), 1, 6));
  EXPECT_TRUE(WatchedRegion(drop, 0.2).empty());
  const std::array<std::uint32_t, 3> watched{3, 4, 200};
  for (const auto v : watched) drop.seam_watch()[v] = 1;
  constexpr double reach = 0.2;
  const WatchedRegion region(drop, reach);
  EXPECT_FALSE(region.empty());
  std::mt19937 numbers(9);
  std::uniform_real_distribution<double> place(-1.5, 1.5);
  int near = 0, far = 0;
  for (int k = 0; k < 20000; ++k) {
    const Vector3d x = Vector3d(0.3, -7, 2) + Vector3d(place(numbers), place(numbers), place(numbers));
    double distance = std::numeric_limits<double>::infinity();
    for (const auto v : watched)
      distance = std::min(distance, (x - Vector3d(drop.positions().col(v))).cwiseAbs().maxCoeff());
    near += distance <= reach;
    far += distance > 2 * reach;
    EXPECT_TRUE(distance > reach || region.covers(x));
    EXPECT_TRUE(distance <= 2 * reach || !region.covers(x));
  }
  EXPECT_GT(near, 50);
  EXPECT_GT(far, 10000);
}

/// A drop that blew up does not ask for a cell for each point of space.
TEST(WatchedRegion, ReachesAllWatchedVerticesHoweverFarApart) {
  Drop drop(make_icosphere(Vector3d::Zero(), 1, 3));
  for (std::uint32_t v = 0; v < drop.num_rows(); ++v) {
    drop.positions().col(v) *= 1e6;
    drop.seam_watch()[v] = 1;
  }
  const WatchedRegion region(drop, 0.01);
  for (std::uint32_t v = 0; v < drop.num_rows(); ++v) EXPECT_TRUE(region.covers(Vector3d(drop.positions().col(v))));
  EXPECT_FALSE(region.covers(Vector3d(1e9, 0, 0)));
}

}  // namespace
}  // namespace meniscus
