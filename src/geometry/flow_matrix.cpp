// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/geometry/flow_matrix.h"

#include "meniscus/core/chunks.h"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace meniscus {
namespace {

/// weight_k = s w_k, at least `floor`; returns their sum.
double scale_weights(const double* half_sum, int degree, double s, double floor, double* weight) {
  double sum = 0;
  for (int k = 0; k < degree; ++k) {
    weight[k] = std::max(s * half_sum[k], floor);
    sum += weight[k];
  }
  return sum;
}

/// rhs_i = sum_k weight_k (y_k - y_i), where `value` gives y.
template <class Value>
void sum_differences(const Connectivity& connectivity, const RingMatrix& matrix, const Value& value, Lanes* rhs) {
  for_each_chunk(connectivity.num_rows(), [&](std::size_t begin, std::size_t end) {
    for (auto v = static_cast<std::uint32_t>(begin); v < end; ++v) {
      const Ring ring = connectivity.ring(v);
      const double* const weight = ring_weights(matrix, connectivity, v);
      const Lanes own = value(v);
      Lanes sum{};
      for (int k = 0; k < ring.degree; ++k) sum += weight[k] * (value(ring.neighbour[k]) - own);
      rhs[v] = sum;
    }
  });
}

Lanes column(const ConstColumns& columns, std::uint32_t v) {
  const double* const p = columns.data() + 3 * std::size_t{v};
  return Lanes{p[0], p[1], p[2], 0};
}

}  // namespace

void assemble_flow_matrix(const Connectivity& connectivity, const SurfaceGeometry& geometry, double s,
                          bool clamp_negative, RingMatrix& matrix) {
  constexpr int width = Connectivity::width;
  const std::size_t n = connectivity.num_rows(), num_long = connectivity.long_rings().size();
  matrix.diagonal.resize(n);
  matrix.weight.resize(width * n);
  matrix.fit_long_rings(connectivity);
  const RingMatrix& half_sums = geometry.edge_weights();
  const double floor = clamp_negative ? 0.0 : -std::numeric_limits<double>::infinity();
  const auto set_diagonal = [&](std::uint32_t v, double sum) {
    const double diagonal = geometry.lumped_area(v) + sum;
    matrix.diagonal[v] = diagonal == 0 ? 1.0 : diagonal;
  };
  for_each_chunk(n, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const int degree = connectivity.degree(static_cast<std::uint32_t>(v));
      double* const row = &matrix.weight[width * v];
      const double sum = scale_weights(&half_sums.weight[width * v], degree > width ? 0 : degree, s, floor, row);
      std::fill(row + (degree > width ? 0 : degree), row + width, 0.0);
      set_diagonal(static_cast<std::uint32_t>(v), sum);
    }
  });
  for (std::size_t k = 0; k < num_long; ++k) {
    const std::vector<double>& half_sum = half_sums.long_weight[k];
    set_diagonal(connectivity.long_rings()[k].vertex, scale_weights(half_sum.data(), static_cast<int>(half_sum.size()),
                                                                    s, floor, matrix.long_weight[k].data()));
  }
}

void curvature_right_hand_side(const Connectivity& connectivity, const RingMatrix& matrix, const ConstColumns& x,
                               Lanes* rhs) {
  sum_differences(
      connectivity, matrix, [&](std::uint32_t v) { return column(x, v); }, rhs);
}

void weighted_differences(const Connectivity& connectivity, const RingMatrix& matrix, const Lanes* y, Lanes* rhs) {
  sum_differences(
      connectivity, matrix, [&](std::uint32_t v) { return y[v]; }, rhs);
}

Eigen::Vector3d missing_translation(const SurfaceGeometry& geometry, const std::vector<Lanes>& rhs,
                                    const std::vector<Lanes>& solution) {
  struct Sums {
    double mass = 0;
    Lanes missing{};
    Sums& operator+=(const Sums& other) {
      mass += other.mass;
      missing += other.missing;
      return *this;
    }
  };
  const Sums sums = sum_over_chunks(rhs.size(), Sums{}, [&](std::size_t begin, std::size_t end) {
    Sums part;
    for (std::size_t i = begin; i < end; ++i) {
      const double mass = geometry.lumped_area(static_cast<std::uint32_t>(i));
      if (!(mass > 0)) continue;
      part.mass += mass;
      part.missing += rhs[i] - mass * solution[i];
    }
    return part;
  });
  return sums.mass > 0 ? Eigen::Vector3d(to_eigen(sums.missing) / sums.mass) : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

}  // namespace meniscus
