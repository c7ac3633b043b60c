// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve_spd_parts.h"

#include <algorithm>

namespace meniscus::spd {
namespace {

/// What a look at the matrix tells. Rows without neighbours and fixed rows take no part.
struct Character {
  double stiffness = 0;  // sum of weights / sum of masses: about 4 gamma dt / h^2
  double roughness = 0;  // mean square jump of the diagonal along an edge / (2 mean square of the diagonal)
  double spread = 1;     // largest / mean diagonal entry
};

/// On large meshes a sample of rows tells as much; it is spread evenly.
Character characterize(const System& system) {
  constexpr std::size_t width = Connectivity::width, sample = 2048;
  const std::size_t stride = 1 + system.connectivity.num_rows() / sample;
  const double* const diagonal = system.matrix.diagonal.data();
  double weights = 0, diagonals = 0, squares = 0, jumps = 0, largest = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < system.connectivity.num_rows(); i += stride) {
    const int degree = system.connectivity.degrees()[i];
    if (degree == 0 || system.is_fixed(i)) continue;
    if (degree > Connectivity::width) {
      const std::size_t place = system.connectivity.long_ring(static_cast<std::uint32_t>(i));
      for (const double w : system.matrix.long_weight[place]) weights += w;
    } else {
      const double* const w = &system.matrix.weight[width * i];
      weights += ((w[0] + w[1]) + (w[2] + w[3])) + ((w[4] + w[5]) + (w[6] + w[7]));
    }
    const double d = diagonal[i], jump = d - diagonal[system.connectivity.neighbour_rows()[width * i]];
    diagonals += d;
    squares += d * d;
    jumps += jump * jump;
    largest = std::max(largest, d);
    ++count;
  }
  if (count == 0) return {};
  const double masses = diagonals - weights;
  return {masses > 0 ? weights / masses : 1e30, jumps / (2 * squares),
          largest * static_cast<double>(count) / diagonals};
}

}  // namespace

SolverMethod choose_method(const System& system, const Progress& progress, bool pattern_changed) {
  const Character character = characterize(system);
  const auto n = static_cast<double>(system.connectivity.num_rows());
  const bool irregular = character.roughness > 0.005;
  // Iterations: proportional to the digits to gain and to the square root of the condition number,
  // which the size of the mesh bounds. Rows that stick out cost the diagonal some more.
  const double digits = 0.5 * std::log(total(progress.residual) / progress.threshold);
  const double condition = 2 * (1 + character.stiffness);
  const double smooth_part = digits / std::sqrt(1 / (0.16 * condition) + 1 / (0.09 * n));
  // Costs in nanoseconds a row. While the pattern stands, its analysis is paid once for many steps.
  const double jacobi = 4.2 * (smooth_part + 6 * std::log(character.spread));
  const double incomplete = 24 + (pattern_changed ? 50 + n / 1500 : 0) + 10 * (smooth_part / 2.8 + 1.5);
  const double complete = 13 * std::sqrt(n) + (pattern_changed ? 480 : 0);
  // On regular meshes right-hand sides are smooth: the diagonal serves as well as anything, and
  // iterations are far fewer than foreseen.
  const double iterative = irregular ? std::min(jacobi, incomplete) : 0.4 * jacobi;
  if (complete < 0.8 * iterative) return SolverMethod::cholesky;
  return irregular && incomplete < jacobi ? SolverMethod::conjugate_gradient_incomplete_cholesky
                                          : SolverMethod::conjugate_gradient_jacobi;
}

}  // namespace meniscus::spd
