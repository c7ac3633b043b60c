// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solve_spd_parts.h"

#include <cholmod.h>

#include <memory>

namespace meniscus::spd {

/// CHOLMOD with its workspace, its symbolic factor and the matrix in its layout.
class CompleteCholesky {
 public:
  CompleteCholesky();
  ~CompleteCholesky();
  CompleteCholesky(const CompleteCholesky&) = delete;
  CompleteCholesky& operator=(const CompleteCholesky&) = delete;

  /// Lays the matrix out anew and orders it. Returns false if CHOLMOD is out of memory.
  bool analyze(const Connectivity& connectivity);
  /// Fills the values in and factorises; fixed rows count as rows of the identity.
  /// Returns false if the matrix is not positive definite or not finite.
  bool factorize(const System& system);
  /// system.solution = A^-1 system.rhs, zero in fixed rows.
  bool solve(const System& system);

 private:
  void release();

  cholmod_common common_;
  cholmod_sparse* matrix_ = nullptr;  // lower triangle, by column, unsorted
  cholmod_factor* factor_ = nullptr;
  cholmod_dense *rhs_ = nullptr, *solution_ = nullptr, *work_ = nullptr, *more_work_ = nullptr;
};

}  // namespace meniscus::spd
