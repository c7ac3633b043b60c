// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/geometry/solve_spd.h"

#include <cmath>
#include <cstdint>
#include <vector>

/// What the methods of SpdSolver share.
namespace meniscus::spd {

/// The sum over the three columns.
inline double total(const Lanes& v) { return v[0] + v[1] + v[2]; }

inline bool is_finite(const Lanes& v) { return std::isfinite(total(v)); }

/// a / b in each column; zero where b is not positive, so that a finished column stays as it is.
inline Lanes ratio(const Lanes& a, const Lanes& b) {
  Lanes r{};
  for (int c = 0; c < 3; ++c) r[c] = b[c] > 0 ? a[c] / b[c] : 0.0;
  return r;
}

/// One row of A x without long rings: three sums side by side keep the adders busy.
inline Lanes row_product(const double* weight, const std::uint32_t* neighbour, double diagonal, const Lanes* x,
                         const Lanes& own, bool wide) {
  Lanes a = weight[0] * x[neighbour[0]], b = weight[1] * x[neighbour[1]], c = weight[2] * x[neighbour[2]];
  a += weight[3] * x[neighbour[3]];
  b += weight[4] * x[neighbour[4]];
  c += weight[5] * x[neighbour[5]];
  if (wide) {
    a += weight[6] * x[neighbour[6]];
    b += weight[7] * x[neighbour[7]];
  }
  return diagonal * own - ((a + b) + c);
}

/// What a long ring adds to its row of A x.
Lanes long_row(const Connectivity::LongRing& ring, const std::vector<double>& weight, const Lanes* x);

/// Whether `alpha` along a direction p with p.Ap = `curvature` is a step: everything finite, A
/// positive along p, and some column left to move.
inline bool is_step(const Lanes& curvature, const Lanes& alpha) {
  return is_finite(curvature) && curvature[0] >= 0 && curvature[1] >= 0 && curvature[2] >= 0 && total(alpha) > 0 &&
         is_finite(alpha);
}

/// A system to solve, and the arrays that all methods use.
struct System {
  const Connectivity& connectivity;
  const RingMatrix& matrix;
  const Lanes* rhs;
  Lanes* solution;
  const std::uint8_t* fixed;  // or nullptr

  bool is_fixed(std::size_t v) const { return fixed != nullptr && fixed[v] != 0; }
};

struct Vectors {
  std::vector<double> inverse_diagonal;  // zero in fixed rows
  std::vector<Lanes> residual, direction, product;
};

/// When conjugate gradients stop, and how far they came.
struct Progress {
  double threshold;    // of the squared residual norm
  int max_iterations;  // of this stage
  int iterations = 0;
  Lanes residual{};     // squared norm
  bool broken = false;  // not finite, or not positive definite

  bool is_converged() const { return total(residual) <= threshold; }
};

/// y = A x and, per column, x.y.
Lanes multiply_and_dot(const System& system, const Lanes* x, Lanes* y);

/// Conjugate gradients with the diagonal as preconditioner, from system.solution and its residual.
/// `direction` is overwritten.
void iterate_jacobi(const System& system, Vectors& vectors, Progress& progress);

/// The method that ought to be the fastest for this system and start. See SolverMethod::automatic.
SolverMethod choose_method(const System& system, const Progress& progress, bool pattern_changed);

}  // namespace meniscus::spd
