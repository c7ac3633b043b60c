// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/geometry/solve_spd.h"

#include "complete_cholesky.h"
#include "incomplete_cholesky.h"
#include "meniscus/core/chunks.h"
#include "solve_spd_parts.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace meniscus {

using namespace spd;

struct SpdSolver::Workspace {
  Vectors vectors;
  IncompleteCholesky incomplete;
  std::optional<CompleteCholesky> complete;  // CHOLMOD's workspace is large: only for those who use it
  std::size_t num_rows = 0;
  bool incomplete_is_current = false, complete_is_current = false;

  bool prepare(const System& system);
  double start(const System& system, Progress& progress);
  void run(SolverMethod method, const System& system, Progress& progress);
  void iterate_incomplete(const System& system, Progress& progress);
  void solve_direct(const System& system, Progress& progress);
};

namespace {

/// r = b - A x and its squared norm.
Lanes residual(const System& system, Vectors& vectors) {
  constexpr int width = Connectivity::width;
  const Connectivity& connectivity = system.connectivity;
  const std::uint32_t* const neighbour = connectivity.neighbour_rows();
  const std::uint16_t* const degree = connectivity.degrees();
  const double* const weight = system.matrix.weight.data();
  const double* const inverse = vectors.inverse_diagonal.data();
  const Lanes* const x = system.solution;
  Lanes* const r = vectors.residual.data();
  Lanes norm = sum_over_chunks(connectivity.num_rows(), Lanes{}, [&](std::size_t begin, std::size_t end) {
    Lanes part{};
    for (std::size_t i = begin; i < end; ++i) {
      const Lanes row =
          row_product(weight + width * i, neighbour + width * i, system.matrix.diagonal[i], x, x[i], degree[i] > 6);
      r[i] = inverse[i] > 0 ? system.rhs[i] - row : Lanes{};
      if (degree[i] <= width) part += inverse[i] * (r[i] * r[i]);
    }
    return part;
  });
  for (std::size_t k = 0; k < connectivity.long_rings().size(); ++k) {
    const Connectivity::LongRing& ring = connectivity.long_rings()[k];
    const std::size_t i = ring.vertex;
    if (!(inverse[i] > 0)) continue;
    r[i] -= long_row(ring, system.matrix.long_weight[k], x);
    norm += inverse[i] * (r[i] * r[i]);
  }
  return norm;
}

}  // namespace

void multiply(const Connectivity& connectivity, const RingMatrix& matrix, const Lanes* x, Lanes* y) {
  multiply_and_dot({connectivity, matrix, nullptr, nullptr, nullptr}, x, y);
}

/// The inverse diagonal. Returns false if a diagonal entry is not positive and finite.
bool SpdSolver::Workspace::prepare(const System& system) {
  const std::size_t n = system.connectivity.num_rows();
  vectors.inverse_diagonal.resize(n);
  vectors.residual.resize(n);
  vectors.direction.resize(n);
  vectors.product.resize(n);
  const int unsound = sum_over_chunks(n, 0, [&](std::size_t begin, std::size_t end) {
    int part = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const double diagonal = system.matrix.diagonal[i];
      const bool fixed = system.is_fixed(i);
      const bool sound = fixed || (diagonal > 0 && std::isfinite(1 / diagonal) && std::isfinite(diagonal));
      part |= static_cast<int>(!sound);
      vectors.inverse_diagonal[i] = fixed ? 0.0 : 1 / diagonal;
    }
    return part;
  });
  return unsound == 0;
}

/// Clears the fixed rows of the start and computes its residual. Returns |B|^2.
double SpdSolver::Workspace::start(const System& system, Progress& progress) {
  struct Sums {
    Lanes norm{};
    int moving = 0;  // rows whose start is not zero
    Sums& operator+=(const Sums& other) {
      norm += other.norm;
      moving += other.moving;
      return *this;
    }
  };
  const std::size_t n = system.connectivity.num_rows();
  const Sums sums = sum_over_chunks(n, Sums{}, [&](std::size_t begin, std::size_t end) {
    Sums part;
    for (std::size_t i = begin; i < end; ++i) {
      const Lanes b = system.rhs[i];
      part.norm += vectors.inverse_diagonal[i] * (b * b);
      Lanes& x = system.solution[i];
      if (system.is_fixed(i)) x = Lanes{};
      part.moving += static_cast<int>(x[0] != 0 || x[1] != 0 || x[2] != 0);
    }
    return part;
  });
  if (sums.moving == 0) {
    for (std::size_t i = 0; i < n; ++i) vectors.residual[i] = vectors.inverse_diagonal[i] > 0 ? system.rhs[i] : Lanes{};
    progress.residual = sums.norm;
  } else {
    progress.residual = residual(system, vectors);
  }
  return total(sums.norm);
}

void SpdSolver::Workspace::iterate_incomplete(const System& system, Progress& progress) {
  if (!incomplete_is_current) incomplete.analyze(system.connectivity);
  incomplete_is_current = true;
  if (incomplete.factorize(system))
    incomplete.iterate(system, vectors, progress);
  else
    progress.broken = true;
}

void SpdSolver::Workspace::solve_direct(const System& system, Progress& progress) {
  if (!complete) complete.emplace();
  if (!complete_is_current) complete_is_current = complete->analyze(system.connectivity);
  progress.broken = !complete_is_current || !complete->factorize(system) || !complete->solve(system);
  if (!progress.broken) progress.residual = residual(system, vectors);
}

void SpdSolver::Workspace::run(SolverMethod method, const System& system, Progress& progress) {
  switch (method) {
    case SolverMethod::cholesky:
      return solve_direct(system, progress);
    case SolverMethod::conjugate_gradient_incomplete_cholesky:
      return iterate_incomplete(system, progress);
    default:
      return iterate_jacobi(system, vectors, progress);
  }
}

SpdSolver::SpdSolver() = default;
SpdSolver::~SpdSolver() = default;
SpdSolver::SpdSolver(SpdSolver&&) noexcept = default;
SpdSolver& SpdSolver::operator=(SpdSolver&&) noexcept = default;

void SpdSolver::forget() {
  if (workspace_) workspace_->incomplete_is_current = workspace_->complete_is_current = false;
}

SolveReport SpdSolver::solve(const Connectivity& connectivity, const RingMatrix& matrix, const Lanes* rhs,
                             Lanes* solution, const std::uint8_t* fixed, bool pattern_changed,
                             const SolverOptions& options) {
  if (!workspace_) workspace_ = std::make_unique<Workspace>();
  Workspace& work = *workspace_;
  const System system{connectivity, matrix, rhs, solution, fixed};
  if (pattern_changed || work.num_rows != connectivity.num_rows())
    work.incomplete_is_current = work.complete_is_current = false;
  work.num_rows = connectivity.num_rows();

  SolveReport report;
  const bool is_automatic = options.method == SolverMethod::automatic;
  report.method = is_automatic ? SolverMethod::conjugate_gradient_jacobi : options.method;
  const auto failure = [&] {
    report.converged = false;
    report.relative_residual = std::numeric_limits<double>::infinity();
    return report;
  };
  if (!work.prepare(system)) return failure();
  Progress progress{0, options.max_iterations, 0, {}, false};
  const double rhs_norm = work.start(system, progress);
  if (!std::isfinite(rhs_norm) || !is_finite(progress.residual)) return failure();
  if (rhs_norm == 0) {
    std::fill(solution, solution + connectivity.num_rows(), Lanes{});
    return report;
  }
  progress.threshold = options.tolerance * options.tolerance * rhs_norm;
  if (!progress.is_converged()) {
    if (is_automatic) report.method = choose_method(system, progress, pattern_changed);
    work.run(report.method, system, progress);
    if (is_automatic && report.method != SolverMethod::cholesky && !progress.is_converged()) {
      report.method = SolverMethod::cholesky;
      work.run(report.method, system, progress);
    }
  }
  report.iterations = progress.iterations;
  report.converged = progress.is_converged() && !progress.broken;
  const double residual_norm = total(progress.residual);
  report.relative_residual =
      std::isfinite(residual_norm) ? std::sqrt(residual_norm / rhs_norm) : std::numeric_limits<double>::infinity();
  return report;
}

}  // namespace meniscus
