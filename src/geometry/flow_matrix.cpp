// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/geometry/flow_matrix.h"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace meniscus {
namespace {

/// The weights of the edges of one ring, and their sum. Face k of the ring is (v, u_k, u_{k+1}): its
/// cotangent at u_{k+1} belongs to edge v u_k, the one at u_k to edge v u_{k+1}.
/// `half` is s/2, `floor` the least weight allowed.
double ring_weights(const FaceGeometry* faces, const std::uint32_t* corner, int degree, double half, double floor,
                    double* weight) {
  constexpr std::uint8_t next[3] = {1, 2, 0}, previous[3] = {2, 0, 1};
  const auto cotangents = [&](int k) { return faces[corner[k] / 3].cotangent.data(); };
  const auto place = [&](int k) { return corner[k] - 3 * (corner[k] / 3); };
  double carried = cotangents(degree - 1)[next[place(degree - 1)]];
  double sum = 0;
  for (int k = 0; k < degree; ++k) {
    const double* const cotangent = cotangents(k);
    const std::uint32_t c = place(k);
    weight[k] = std::max(half * (cotangent[previous[c]] + carried), floor);
    sum += weight[k];
    carried = cotangent[next[c]];
  }
  return sum;
}

}  // namespace

void assemble_flow_matrix(const Connectivity& connectivity, const SurfaceGeometry& geometry, double s,
                          bool clamp_negative, RingMatrix& matrix) {
  constexpr int width = Connectivity::width;
  const std::size_t n = connectivity.num_rows();
  matrix.diagonal.resize(n);
  matrix.weight.resize(width * n);
  matrix.long_weight.resize(connectivity.long_rings().size());
  const FaceGeometry* const faces = geometry.faces().data();
  const double half = 0.5 * s, floor = clamp_negative ? 0.0 : -std::numeric_limits<double>::infinity();
  std::size_t num_long = 0;
  for (std::uint32_t v = 0; v < n; ++v) {
    double* const row = &matrix.weight[width * std::size_t{v}];
    const int degree = connectivity.degree(v);
    double sum = 0;
    if (degree > width) {
      const Connectivity::LongRing& ring = connectivity.long_rings()[num_long];
      std::vector<double>& weight = matrix.long_weight[num_long++];
      weight.resize(ring.neighbour.size());
      sum = ring_weights(faces, ring.corner.data(), degree, half, floor, weight.data());
    } else if (degree > 0) {
      sum = ring_weights(faces, connectivity.corner_rows() + width * std::size_t{v}, degree, half, floor, row);
    }
    std::fill(row + (degree > width ? 0 : degree), row + width, 0.0);
    const double diagonal = geometry.lumped_area(v) + sum;
    matrix.diagonal[v] = diagonal == 0 ? 1.0 : diagonal;
  }
}

void curvature_right_hand_side(const Connectivity& connectivity, const RingMatrix& matrix, const ConstColumns& x,
                               Lanes* rhs) {
  constexpr int width = Connectivity::width;
  const std::size_t n = connectivity.num_rows();
  const double* const data = x.data();
  const auto point = [data](std::uint32_t v) {
    const double* const p = data + 3 * std::size_t{v};
    return Lanes{p[0], p[1], p[2], 0};
  };
  const auto add = [&](const std::uint32_t* neighbour, const double* weight, int degree, const Lanes& centre) {
    Lanes sum{};
    for (int k = 0; k < degree; ++k) sum += weight[k] * (point(neighbour[k]) - centre);
    return sum;
  };
  std::size_t num_long = 0;
  for (std::uint32_t v = 0; v < n; ++v) {
    const int degree = connectivity.degree(v);
    const Ring ring = connectivity.ring(v);
    const double* const weight =
        degree > width ? matrix.long_weight[num_long++].data() : &matrix.weight[width * std::size_t{v}];
    rhs[v] = add(ring.neighbour, weight, degree, point(v));
  }
}

}  // namespace meniscus
