// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solve_spd_parts.h"

#include <cstdint>
#include <vector>

namespace meniscus::spd {

/// Strictly triangular rows: the first `head` entries of row i stand at head * i, padded with zeros
/// that point to row n; the few rows that hold more keep the rest behind all heads.
struct TriangularRows {
  static constexpr std::size_t head = 4;

  std::vector<std::uint32_t> tail;    // n + 1: row i's further entries are [tail[i], tail[i + 1])
  std::vector<std::uint32_t> column;  // head * n, then the further ones
  std::vector<double> value;          // beside column

  /// Makes room for rows of these lengths, all entries padding.
  void resize(const std::vector<std::uint16_t>& length);
  /// The place in row i of column j, if it is there; else some place in reach.
  std::uint32_t find(std::size_t i, std::uint32_t j) const;
  std::size_t place(std::size_t i, std::size_t k) const { return k < head ? head * i + k : tail[i] + (k - head); }
};

/// A ~ (I + L) D (I + L)^T with L on the pattern of A's lower triangle, rows in the order of the
/// mesh: IC(0) of Meijerink and van der Vorst (1977). Entries i, j and k update each other where
/// ijk is a face; the rare other 3-cycles (around a neck three edges wide) are left out.
class IncompleteCholesky {
 public:
  /// Reads the pattern: which entries there are, and which update which.
  void analyze(const Connectivity& connectivity);

  /// Computes the values; fixed rows count as rows of the identity. If a pivot is not safely
  /// positive, the work is done again with the diagonal raised by a relative shift.
  /// Returns false if that does not help either (something is not finite).
  bool factorize(const System& system);

  /// Conjugate gradients with this preconditioner, from system.solution and its residual.
  void iterate(const System& system, Vectors& vectors, Progress& progress);

 private:
  /// u_target -= u_source l[place] within the row at hand.
  struct Update {
    std::uint32_t place;
    std::uint16_t target, source;
  };

  void rank_ring(const Connectivity& connectivity, std::uint32_t i);
  std::uint32_t read_row(const Ring& ring, std::uint32_t i, std::uint32_t num_updates);
  bool factorize_shifted(const System& system, double shift);
  Lanes descend(const double* inverse_diagonal, const Lanes* q, const Lanes& alpha, Lanes* r, Lanes& norm);
  void ascend(const Lanes& beta, Lanes* p);

  TriangularRows lower_, upper_;
  std::vector<std::uint16_t> lower_length_, upper_length_;
  std::vector<std::uint16_t> slot_;          // beside lower_: the entry's place in the ring
  std::vector<std::uint32_t> mirror_;        // beside lower_: its place in upper_
  std::vector<Update> updates_;              // row by row, by target
  std::vector<std::uint32_t> update_start_;  // n + 1
  std::vector<double> inverse_pivot_;        // zero in fixed rows
  std::vector<double> row_;                  // the row at hand
  std::vector<std::uint16_t> order_, rank_;  // its ring by ascending index, and back
  std::vector<Lanes> z_;                     // n + 1, the last zero
};

}  // namespace meniscus::spd
