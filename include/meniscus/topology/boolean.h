// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/mesh_data.h"
#include "meniscus/state/drop.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

/// Union, intersection and difference of two closed meshes. docs/BOOLEAN.md has the table of outcomes.
namespace meniscus {

using Triangle = std::array<std::uint32_t, 3>;  ///< indices of points, counterclockwise seen from outside

enum class BooleanOperation { unite, intersect, subtract };

/// A closed mesh as flat arrays. Nothing is copied. Triangles that name Connectivity::removed, and
/// points that no triangle names, take no part.
struct MeshView {
  ConstColumns points;  ///< 3 x number of points, cm
  const std::vector<Triangle>& triangles;
};
inline MeshView view_of(const Drop& drop) { return {drop.positions(), drop.connectivity().triangles()}; }
inline MeshView view_of(const MeshData& data) {
  return {{data.points.empty() ? nullptr : data.points.front().data(), static_cast<Eigen::Index>(data.points.size())},
          data.triangles};
}

/// What was found. Solids are closed regular sets: lower-dimensional parts of a result do not count.
enum class BooleanOutcome {
  refused,     ///< no result; see BooleanRefusal
  disjoint,    ///< no common point
  a_inside_b,  ///< A is a part of B; their surfaces may touch
  b_inside_a,
  equal,     ///< the same solid
  touching,  ///< the surfaces meet, the interiors do not
  crossing   ///< the interiors meet and neither holds the other
};

/// Why there is no result.
enum class BooleanRefusal {
  none,
  unsound_input,  ///< not finite, open, inside out, meets itself, ...: the message and faces tell
  pinched,        ///< the exact result is not a 2-manifold (solids that touch along an edge, say)
  rounding,       ///< no ladder step gave a result that is sound in doubles
};

/// "crossing", "pinched" and so on, as reports spell it.
const char* name(BooleanOutcome outcome);
const char* name(BooleanRefusal refusal);

/// How a result was reached, the cheapest first.
enum class BooleanStep {
  apart,      ///< the surfaces do not meet: whole components are kept or dropped
  local,      ///< faces that meet were cut, in general position, by ours
  corefined,  ///< CGAL's corefinement of the whole meshes, with exact points
  shifted,    ///< B was moved by `shift`, then as `local`
};
const char* name(BooleanStep step);

struct BooleanOptions {
  /// Skip the checks of the inputs: they are known to be sound. Then the cost is that of the faces in
  /// the common box and a copy of the arrays.
  bool inputs_are_sound = false;
  /// Components of the result that face inward (air shut in by a union) stay; else they are dropped.
  bool keep_cavities = true;
  /// B may be moved by up to this share of the larger mesh's largest extent if all else fails; 0: never.
  double max_shift = 1e-10;
};

/// A point of a triangle of an input: its corners' weights sum to 1. An old vertex has weight 1 at the
/// first corner.
struct SurfacePoint {
  Triangle corners;
  std::array<double, 3> weights;
};

/// Where a vertex on the seam lies on both inputs.
struct SeamVertex {
  SurfacePoint on_a, on_b;
};

/// A result: rows are A's kept vertices, then B's, then those of the seam, so that attributes are
/// gathered from kept_a, kept_b and seam in turn.
struct BooleanResult {
  BooleanOutcome outcome = BooleanOutcome::refused;
  BooleanRefusal refusal = BooleanRefusal::none;
  BooleanStep step = BooleanStep::apart;
  std::string message;                          ///< of a refusal: what is wrong and where
  std::vector<std::uint32_t> faces_a, faces_b;  ///< of a refusal: at fault, at most 20 each

  std::vector<std::array<double, 3>> points;  ///< cm
  std::vector<Triangle> triangles;            ///< none if the result is empty
  std::vector<std::uint32_t> kept_a, kept_b;  ///< old indices of the first rows, ascending
  std::vector<SeamVertex> seam;               ///< of the last rows: vertices where the surfaces met
  std::size_t whole_a = 0, whole_b = 0;       ///< the first triangles are A's uncut ones, then B's; the rest are new

  double volume_a = 0, volume_b = 0, volume = 0;    ///< cm^3; of A and B, and of the result
  int retries = 0;                                  ///< ladder steps that failed before
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  ///< how far B was moved, cm

  bool ok() const { return outcome != BooleanOutcome::refused; }
  std::size_t first_seam_row() const { return kept_a.size() + kept_b.size(); }
};

/// A united with, cut down to, or less B. Each result is checked: closed, 2-manifold, outward, no
/// self-intersection where faces were made, and a volume within the bounds of inclusion and
/// exclusion. What fails is tried again by the steps above; in the end refused. Never throws for what
/// the meshes hold. The same input gives the same bits.
///
/// An empty input (no triangles) is an unsound one. Cavities and nested drops (components that face
/// inward and outward in turn) are solids like others.
BooleanResult boolean(const MeshView& a, const MeshView& b, BooleanOperation operation,
                      const BooleanOptions& options = {});

/// Whether the surfaces have a common point: exact, touching included, stops at the first. A drop
/// within another does not meet it. Cost: a pass over both, then the faces in the common box.
/// Precondition: coordinates are finite.
bool surfaces_meet(const MeshView& a, const MeshView& b);

}  // namespace meniscus
