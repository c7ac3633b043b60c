// SPDX-License-Identifier: GPL-3.0-or-later
#include "complete_cholesky.h"

#include <algorithm>

namespace meniscus::spd {

CompleteCholesky::CompleteCholesky() {
  cholmod_start(&common_);
  common_.print = 0;
  common_.error_handler = nullptr;
  common_.supernodal_switch = 200;  // flops per entry; by measurement with the reference BLAS
  common_.nmethods = 1;
  common_.method[0].ordering = CHOLMOD_AMD;
  common_.final_ll = 1;  // so that a pivot that is not positive is always an error
  common_.quick_return_if_not_posdef = 1;
}

CompleteCholesky::~CompleteCholesky() {
  release();
  cholmod_finish(&common_);
}

void CompleteCholesky::release() {
  cholmod_free_sparse(&matrix_, &common_);
  cholmod_free_factor(&factor_, &common_);
  cholmod_free_dense(&rhs_, &common_);
  cholmod_free_dense(&solution_, &common_);
  cholmod_free_dense(&work_, &common_);
  cholmod_free_dense(&more_work_, &common_);
}

bool CompleteCholesky::analyze(const Connectivity& connectivity) {
  release();
  const auto n = static_cast<std::uint32_t>(connectivity.num_rows());
  std::size_t nonzeros = n;
  for (std::uint32_t j = 0; j < n; ++j) {
    const Ring ring = connectivity.ring(j);
    nonzeros += static_cast<std::size_t>(
        std::count_if(ring.neighbour, ring.neighbour + ring.degree, [j](auto i) { return i > j; }));
  }
  matrix_ = cholmod_allocate_sparse(n, n, nonzeros, 0, 1, -1, CHOLMOD_REAL, &common_);
  rhs_ = cholmod_allocate_dense(n, 3, n, CHOLMOD_REAL, &common_);
  if (matrix_ == nullptr || rhs_ == nullptr) return false;
  int* const start = static_cast<int*>(matrix_->p);
  int* const row = static_cast<int*>(matrix_->i);
  double* const value = static_cast<double*>(matrix_->x);
  int next = 0;
  for (std::uint32_t j = 0; j < n; ++j) {
    start[j] = next;
    row[next++] = static_cast<int>(j);
    const Ring ring = connectivity.ring(j);
    for (int k = 0; k < ring.degree; ++k)
      if (ring.neighbour[k] > j) row[next++] = static_cast<int>(ring.neighbour[k]);
  }
  start[n] = next;
  std::fill(value, value + nonzeros, 0.0);
  factor_ = cholmod_analyze(matrix_, &common_);
  return factor_ != nullptr && common_.status >= CHOLMOD_OK;
}

bool CompleteCholesky::factorize(const System& system) {
  constexpr std::size_t width = Connectivity::width;
  const auto n = static_cast<std::uint32_t>(system.connectivity.num_rows());
  double* const value = static_cast<double*>(matrix_->x);
  std::size_t next = 0, num_long = 0;
  for (std::uint32_t j = 0; j < n; ++j) {
    const bool fixed = system.is_fixed(j);
    value[next++] = fixed ? 1.0 : system.matrix.diagonal[j];
    const Ring ring = system.connectivity.ring(j);
    const double* const weight = ring.degree > static_cast<int>(width) ? system.matrix.long_weight[num_long++].data()
                                                                       : &system.matrix.weight[width * j];
    for (int k = 0; k < ring.degree; ++k) {
      const std::uint32_t i = ring.neighbour[k];
      if (i > j) value[next++] = fixed || system.is_fixed(i) ? 0.0 : -weight[k];
    }
  }
  if (!std::all_of(value, value + next, [](double v) { return std::isfinite(v); })) return false;
  cholmod_factorize(matrix_, factor_, &common_);
  return common_.status == CHOLMOD_OK && factor_->minor == n;
}

bool CompleteCholesky::solve(const System& system) {
  const std::size_t n = system.connectivity.num_rows();
  double* const b = static_cast<double*>(rhs_->x);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t c = 0; c < 3; ++c) b[c * n + i] = system.is_fixed(i) ? 0.0 : system.rhs[i][c];
  if (!cholmod_solve2(CHOLMOD_A, factor_, rhs_, nullptr, &solution_, nullptr, &work_, &more_work_, &common_))
    return false;
  const double* const x = static_cast<const double*>(solution_->x);
  for (std::size_t i = 0; i < n; ++i) system.solution[i] = Lanes{x[i], x[n + i], x[2 * n + i], 0};
  return true;
}

}  // namespace meniscus::spd
