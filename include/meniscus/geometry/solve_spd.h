// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/types.h"
#include "meniscus/geometry/connectivity.h"

#include <memory>
#include <vector>

namespace meniscus {

/// Three doubles in a row of four, so that a product moves whole registers; the fourth is unused.
using Lanes = double __attribute__((vector_size(32)));

inline Lanes to_lanes(const Eigen::Vector3d& v) { return Lanes{v.x(), v.y(), v.z(), 0.0}; }
inline Eigen::Vector3d to_eigen(const Lanes& v) { return {v[0], v[1], v[2]}; }

/// How (M + s L) X = B is solved.
///
/// `automatic` takes, by a model of costs fitted to docs/charts/solver.csv, the incomplete Cholesky
/// preconditioner where the diagonal jumps between neighbours (irregular meshes) and enough iterations
/// are ahead to pay for it (about 30, or 80 where the pattern changed), a complete factor where even
/// those would cost more (small meshes, far tighter tolerances), and the diagonal for all else; if
/// conjugate gradients do not converge, it solves with a complete factor.
enum class SolverMethod {
  automatic,                               ///< the fastest of those below
  conjugate_gradient_jacobi,               ///< diagonal preconditioner
  conjugate_gradient_incomplete_cholesky,  ///< the paper's: IC(0) preconditioner
  cholesky,                                ///< CHOLMOD; the symbolic factor is kept while the pattern stands
};

struct SolverOptions {
  SolverMethod method = SolverMethod::automatic;
  double tolerance = 1e-6;    ///< on |B - A X| / |B| over the three columns, in the norm of the inverse diagonal, > 0
  int max_iterations = 1000;  ///< of conjugate gradients
};

/// What a solve did. A solve that did not converge leaves the last iterate in place (the start, if it
/// failed before the first); its residual is infinite if something was not finite.
struct SolveReport {
  bool converged = true;
  int iterations = 0;            ///< of conjugate gradients; 0 for a direct solve alone
  double relative_residual = 0;  ///< in the norm of SolverOptions::tolerance: by recurrence, of a direct solve by A X
  SolverMethod method = SolverMethod::conjugate_gradient_jacobi;  ///< the one used, never `automatic`
};

/// A = M + s L over the rings of a mesh, in rows of fixed width (see Connectivity): row i is
/// A_ii = diagonal[i], A_ij = -weight[8 i + k] for its k-th neighbour j. Rings longer than 8 keep
/// their weights in long_weight, in the order of Connectivity::long_rings(), and zeros in their row.
/// Symmetric; positive definite if M is positive and s L positive semidefinite.
/// A removed vertex has diagonal 1 and no neighbours.
struct RingMatrix {
  std::vector<double> diagonal;                  ///< n
  std::vector<double> weight;                    ///< 8 n, zero where padded
  std::vector<std::vector<double>> long_weight;  ///< one a long ring, or more: rows that were needed once stay

  /// Gives each long ring a row of its length.
  void fit_long_rings(const Connectivity& connectivity) {
    const auto& rings = connectivity.long_rings();
    if (long_weight.size() < rings.size()) long_weight.resize(rings.size());
    for (std::size_t k = 0; k < rings.size(); ++k) long_weight[k].resize(rings[k].neighbour.size());
  }
};

/// The weights of vertex v's ring, one a neighbour.
inline const double* ring_weights(const RingMatrix& matrix, const Connectivity& connectivity, std::uint32_t v) {
  return connectivity.degree(v) > Connectivity::width ? matrix.long_weight[connectivity.long_ring(v)].data()
                                                      : &matrix.weight[Connectivity::width * std::size_t{v}];
}

/// y = A x. Arrays of n rows; y must not alias x.
void multiply(const Connectivity& connectivity, const RingMatrix& matrix, const Lanes* x, Lanes* y);

/// Solves with one matrix after another, keeping its arrays and, for CHOLMOD, its symbolic factor.
class SpdSolver {
 public:
  SpdSolver();
  ~SpdSolver();
  SpdSolver(SpdSolver&&) noexcept;
  SpdSolver& operator=(SpdSolver&&) noexcept;

  /// Solves A X = B for three columns at once. `solution` holds the start on entry, the solution on
  /// return. Rows with fixed[i] != 0 (nullptr: none) are held at zero, whatever the start says.
  /// All-zero B gives zero. `pattern_changed` says that the connectivity is not that of the last
  /// call, so that kept symbolic factors are void. The result depends on the arguments alone, not on
  /// earlier calls (a resumed run solves with a new solver where the unbroken one had kept factors). Nothing is
  /// allocated while the number of rows stands, except by CHOLMOD. Never throws for numerical reasons: a matrix that is
  /// not positive definite, or anything not finite, is reported as not converged.
  SolveReport solve(const Connectivity& connectivity, const RingMatrix& matrix, const Lanes* rhs, Lanes* solution,
                    const std::uint8_t* fixed, bool pattern_changed, const SolverOptions& options);

  /// Drops the kept factors: the next matrix may be of another mesh with as many rows. Arrays stay.
  void forget();

 private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace meniscus
