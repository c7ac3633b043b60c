// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/core/chunks.h"
#include "solve_spd_parts.h"

namespace meniscus::spd {

Lanes long_row(const Connectivity::LongRing& ring, const std::vector<double>& weight, const Lanes* x) {
  Lanes sum{};
  for (std::size_t k = 0; k < weight.size(); ++k) sum -= weight[k] * x[ring.neighbour[k]];
  return sum;
}

Lanes multiply_and_dot(const System& system, const Lanes* x, Lanes* y) {
  constexpr int width = Connectivity::width;
  const Connectivity& connectivity = system.connectivity;
  const std::uint32_t* const neighbour = connectivity.neighbour_rows();
  const std::uint16_t* const degree = connectivity.degrees();
  const double* const weight = system.matrix.weight.data();
  const double* const diagonal = system.matrix.diagonal.data();
  Lanes dot = sum_over_chunks(connectivity.num_rows(), Lanes{}, [&](std::size_t begin, std::size_t end) {
    Lanes part{};
    for (std::size_t i = begin; i < end; ++i) {
      const Lanes own = x[i];
      const Lanes row = row_product(weight + width * i, neighbour + width * i, diagonal[i], x, own, degree[i] > 6);
      y[i] = row;
      part += own * row;
    }
    return part;
  });
  for (std::size_t k = 0; k < connectivity.long_rings().size(); ++k) {
    const Connectivity::LongRing& ring = connectivity.long_rings()[k];
    const Lanes rest = long_row(ring, system.matrix.long_weight[k], x);
    y[ring.vertex] += rest;
    dot += x[ring.vertex] * rest;
  }
  return dot;
}

void iterate_jacobi(const System& system, Vectors& vectors, Progress& progress) {
  const std::size_t n = system.connectivity.num_rows();
  const double* const inverse = vectors.inverse_diagonal.data();
  Lanes* const x = system.solution;
  Lanes* const r = vectors.residual.data();
  Lanes* const p = vectors.direction.data();
  Lanes* const q = vectors.product.data();
  Lanes rz = progress.residual;
  for_each_chunk(n, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) p[i] = inverse[i] * r[i];
  });
  while (!progress.is_converged() && progress.iterations < progress.max_iterations) {
    const Lanes pq = multiply_and_dot(system, p, q);
    const Lanes alpha = ratio(rz, pq);
    if (!is_step(pq, alpha)) {
      progress.broken = true;
      return;
    }
    const Lanes rz_new = sum_over_chunks(n, Lanes{}, [&](std::size_t begin, std::size_t end) {
      Lanes part{};
      for (std::size_t i = begin; i < end; ++i) {
        const Lanes ri = r[i] - alpha * q[i];
        r[i] = ri;
        part += inverse[i] * (ri * ri);
      }
      return part;
    });
    ++progress.iterations;
    progress.residual = rz_new;
    // The step along p is taken here, where p is read anyway to turn it; at the last one nothing needs turning.
    const bool is_last = progress.is_converged();
    const Lanes beta = ratio(rz_new, rz);
    for_each_chunk(n, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Lanes pi = p[i];
        x[i] += alpha * pi;
        if (!is_last) p[i] = inverse[i] * r[i] + beta * pi;
      }
    });
    rz = rz_new;
  }
}

}  // namespace meniscus::spd
