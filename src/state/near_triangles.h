// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>

#include <atomic>
#include <cstdint>
#include <functional>
#include <vector>

namespace meniscus {

/// For each cell of a grid about a closed surface, how near the surface is, and the triangles among which is the
/// nearest one of each of its points. Cells are looked at when they are first asked for, by any thread; what they hold
/// does not depend on which one comes first.
class NearTriangles {
 public:
  struct Candidate {
    std::uint32_t triangle;
    Eigen::Vector3d center;  ///< of a ball that holds it
    double radius;
    double from_middle = 0;  ///< at most its distance from the middle of the cell that it is listed in
  };
  struct Cell {
    double clearance = 0;  ///< its points are outside and at least so far from the surface (cm); or 0
    Eigen::Vector3d middle;
    std::vector<Candidate> candidates;  ///< the nearest to the middle first; none where they would be many
  };
  /// Appends the triangles that may be within a distance (cm) of a point; more do no harm.
  using Find = std::function<void(const Eigen::Vector3d& x, double distance, std::vector<std::uint32_t>& found)>;
  /// The distance of a point to a triangle (cm).
  using Distance = std::function<double(const Eigen::Vector3d& x, std::uint32_t triangle)>;
  /// The distance of a point to the surface (cm), negative inside.
  using Nearest = std::function<double(const Eigen::Vector3d& x)>;

  /// `balls`: one a triangle. Cells are as long as edges, or longer where a million would not do.
  NearTriangles(const Eigen::AlignedBox3d& box, std::vector<Candidate> balls, double edge, Nearest nearest, Find find,
                Distance distance);
  ~NearTriangles();

  /// The cell of x; null outside of the grid, which reaches a little beyond the surface's box.
  const Cell* at(const Eigen::Vector3d& x) const;

 private:
  const Cell* make(const Eigen::Vector3d& center) const;

  std::vector<Candidate> balls_;
  Nearest nearest_;
  Find find_;
  Distance distance_;
  Eigen::AlignedBox3d box_;
  Eigen::Array3i num_cells_;
  double size_;  // of a cell, cm
  mutable std::vector<std::atomic<const Cell*>> cells_;
};

}  // namespace meniscus
