// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/types.h"
#include "meniscus/geometry/connectivity.h"
#include "meniscus/geometry/solve_spd.h"

#include <array>
#include <cstddef>
#ifdef __AVX__
#include <immintrin.h>
#endif

/// Four triangles side by side, so that whole registers hold one coordinate of each: passes over all faces are bound by
/// arithmetic, and this does four times as much of it at once.
namespace meniscus {

using Four = Lanes;
using FourMasks = decltype(Four{} < Four{});  ///< of a comparison: all bits of a lane, or none

inline Four constant(double value) { return Four{value, value, value, value}; }
inline Four square_root(Four v) {
  Eigen::Map<Eigen::Array4d, Eigen::Aligned32> lanes(reinterpret_cast<double*>(&v));
  lanes = lanes.sqrt();
  return v;
}
/// Bit k is set where a comparison holds in lane k.
inline unsigned lanes_where(const FourMasks& masks) {
#ifdef __AVX__
  return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<const __m256d&>(masks)));
#else
  return (masks[0] & 1) | (masks[1] & 2) | (masks[2] & 4) | (masks[3] & 8);
#endif
}
inline double sum(const Four& v) { return (v[0] + v[1]) + (v[2] + v[3]); }

/// Four vectors, or points.
struct FourVectors {
  Four x, y, z;

  FourVectors operator+(const FourVectors& o) const { return {x + o.x, y + o.y, z + o.z}; }
  FourVectors operator-(const FourVectors& o) const { return {x - o.x, y - o.y, z - o.z}; }
  FourVectors& operator+=(const FourVectors& o) { return *this = *this + o; }
  FourVectors cross(const FourVectors& o) const { return {y * o.z - z * o.y, z * o.x - x * o.z, x * o.y - y * o.x}; }
  Four dot(const FourVectors& o) const { return x * o.x + y * o.y + z * o.z; }
};

inline FourVectors operator*(const Four& s, const FourVectors& v) { return {s * v.x, s * v.y, s * v.z}; }
inline FourVectors constant(const Eigen::Vector3d& v) { return {constant(v.x()), constant(v.y()), constant(v.z())}; }
inline Eigen::Vector3d sum(const FourVectors& v) { return {sum(v.x), sum(v.y), sum(v.z)}; }

/// The corners of triangles [first, first + 4). Those that were removed, and those beyond the last, have their three
/// corners at row 0: no area, no volume.
class FourTriangles {
 public:
  FourTriangles(const std::vector<std::array<std::uint32_t, 3>>& triangles, std::size_t first, std::size_t end) {
    for (std::size_t k = 0; k < 4; ++k) {
      const bool is_there = first + k < end && triangles[first + k][0] != Connectivity::removed;
      for (std::size_t corner = 0; corner < 3; ++corner)
        offset_[corner][k] = is_there ? 3 * std::size_t{triangles[first + k][corner]} : 0;
    }
  }

  /// Corner 0, 1 or 2 of each, from 3 x rows coordinates.
  FourVectors corner(const double* columns, std::size_t corner) const {
    const auto& [a, b, c, d] = offset_[corner];
    return {Four{columns[a], columns[b], columns[c], columns[d]},
            Four{columns[a + 1], columns[b + 1], columns[c + 1], columns[d + 1]},
            Four{columns[a + 2], columns[b + 2], columns[c + 2], columns[d + 2]}};
  }

 private:
  std::array<std::array<std::size_t, 4>, 3> offset_;
};

}  // namespace meniscus
