// SPDX-License-Identifier: GPL-3.0-or-later
#include "incomplete_cholesky.h"

#include <algorithm>

namespace meniscus::spd {
namespace {

/// sum_k value_k x[column_k] over row i.
inline Lanes row_sum(const TriangularRows& rows, std::size_t i, const Lanes* x) {
  constexpr std::size_t head = TriangularRows::head;
  const double* const value = rows.value.data();
  const std::uint32_t* const column = rows.column.data();
  const double* const v = value + head * i;
  const std::uint32_t* const c = column + head * i;
  Lanes a = v[0] * x[c[0]] + v[1] * x[c[1]];
  a += v[2] * x[c[2]] + v[3] * x[c[3]];
  for (std::uint32_t e = rows.tail[i]; e < rows.tail[i + 1]; ++e) a += value[e] * x[column[e]];
  return a;
}

}  // namespace

void TriangularRows::resize(const std::vector<std::uint16_t>& length) {
  const std::size_t n = length.size();
  tail.resize(n + 1);
  tail[0] = static_cast<std::uint32_t>(head * n);
  for (std::size_t i = 0; i < n; ++i)
    tail[i + 1] = tail[i] + (length[i] > head ? static_cast<std::uint32_t>(length[i] - head) : 0u);
  column.resize(tail[n]);
  value.resize(tail[n]);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = length[i]; k < head; ++k) {
      column[head * i + k] = static_cast<std::uint32_t>(n);
      value[head * i + k] = 0;
    }
}

std::uint32_t TriangularRows::find(std::size_t i, std::uint32_t j) const {
  for (std::size_t place = head * i; place < head * i + head; ++place)
    if (column[place] == j) return static_cast<std::uint32_t>(place);
  const auto first = column.begin() + tail[i], end = column.begin() + tail[i + 1];
  return static_cast<std::uint32_t>(std::lower_bound(first, end, j) - column.begin());
}

void IncompleteCholesky::analyze(const Connectivity& connectivity) {
  const auto n = static_cast<std::uint32_t>(connectivity.num_rows());
  lower_length_.resize(n);
  upper_length_.resize(n);
  std::size_t longest = Connectivity::width, num_updates = 0;
  for (std::uint32_t i = 0; i < n; ++i) {
    const Ring ring = connectivity.ring(i);
    int below = 0;
    for (int k = 0; k < ring.degree; ++k) below += ring.neighbour[k] < i ? 1 : 0;
    lower_length_[i] = static_cast<std::uint16_t>(below);
    upper_length_[i] = static_cast<std::uint16_t>(ring.degree - below);
    longest = std::max(longest, static_cast<std::size_t>(ring.degree));
    num_updates += static_cast<std::size_t>(below);
  }
  lower_.resize(lower_length_);
  upper_.resize(upper_length_);
  slot_.resize(lower_.column.size());
  mirror_.resize(lower_.column.size());
  update_start_.resize(n + 1);
  updates_.resize(num_updates);  // more than enough: one a face
  row_.resize(longest);
  order_.resize(longest);
  rank_.resize(longest);
  inverse_pivot_.resize(n);
  z_.assign(n + 1, Lanes{});
  std::fill(upper_length_.begin(), upper_length_.end(), std::uint16_t{0});
  update_start_[0] = 0;
  for (std::uint32_t i = 0; i < n; ++i) {
    rank_ring(connectivity, i);
    update_start_[i + 1] = read_row(connectivity.ring(i), i, update_start_[i]);
  }
}

/// rank_[k]: how many neighbours have a smaller index than the k-th.
void IncompleteCholesky::rank_ring(const Connectivity& connectivity, std::uint32_t i) {
  constexpr int width = Connectivity::width;
  const Ring ring = connectivity.ring(i);
  if (ring.degree > width) {
    for (int k = 0; k < ring.degree; ++k) order_[static_cast<std::size_t>(k)] = static_cast<std::uint16_t>(k);
    std::sort(order_.begin(), order_.begin() + ring.degree,
              [&](int a, int b) { return ring.neighbour[a] < ring.neighbour[b]; });
    for (int t = 0; t < ring.degree; ++t) rank_[order_[static_cast<std::size_t>(t)]] = static_cast<std::uint16_t>(t);
    return;
  }
  const std::uint32_t* const row = connectivity.neighbour_rows() + width * std::size_t{i};
  std::uint32_t rank[width] = {};
  for (int m = 0; m < width; ++m)  // padding is i itself: never below a lower neighbour
    for (int k = 0; k < width; ++k) rank[k] += row[m] < row[k] ? 1u : 0u;
  for (int k = 0; k < ring.degree; ++k) {
    rank_[static_cast<std::size_t>(k)] = static_cast<std::uint16_t>(rank[k]);
    order_[rank[k]] = static_cast<std::uint16_t>(k);
  }
}

/// The entries of row i by ascending column, their mirror images, and their updates: face ijk with
/// k < j < i makes u_ij -= u_ik l_jk. Returns where the next row's updates start.
std::uint32_t IncompleteCholesky::read_row(const Ring& ring, std::uint32_t i, std::uint32_t num_updates) {
  const int last = ring.degree - 1;
  for (std::size_t t = 0; t < lower_length_[i]; ++t) {
    const int slot = order_[t];
    const std::uint32_t j = ring.neighbour[slot];
    const std::size_t entry = lower_.place(i, t), mirrored = upper_.place(j, upper_length_[j]++);
    lower_.column[entry] = j;
    slot_[entry] = static_cast<std::uint16_t>(slot);
    mirror_[entry] = static_cast<std::uint32_t>(mirrored);
    upper_.column[mirrored] = i;
    for (const int side : {slot == 0 ? last : slot - 1, slot == last ? 0 : slot + 1}) {
      const std::uint32_t k = ring.neighbour[side];
      if (k < j)
        updates_[num_updates++] = {lower_.find(j, k), static_cast<std::uint16_t>(t),
                                   rank_[static_cast<std::size_t>(side)]};
    }
  }
  return num_updates;
}

bool IncompleteCholesky::factorize(const System& system) {
  if (factorize_shifted(system, 0)) return true;
  for (double shift = 1e-3; shift < 100; shift *= 10)
    if (factorize_shifted(system, shift)) return true;
  return false;
}

bool IncompleteCholesky::factorize_shifted(const System& system, double shift) {
  constexpr std::size_t width = Connectivity::width;
  constexpr double least_pivot = 1e-6;  // of the diagonal entry
  const std::size_t n = inverse_pivot_.size();
  std::size_t num_long = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const bool is_long = system.connectivity.degrees()[i] > width;
    const double* const weight =
        is_long ? system.matrix.long_weight[num_long].data() : &system.matrix.weight[width * i];
    num_long += is_long ? 1 : 0;
    const bool fixed = system.is_fixed(i);
    const std::size_t length = lower_length_[i];
    for (std::size_t t = 0; t < length; ++t) row_[t] = -weight[slot_[lower_.place(i, t)]];
    for (std::uint32_t e = update_start_[i]; e < update_start_[i + 1]; ++e)
      row_[updates_[e].target] -= row_[updates_[e].source] * lower_.value[updates_[e].place];
    const double diagonal = system.matrix.diagonal[i] * (1 + shift);
    double pivot = diagonal;
    for (std::size_t t = 0; t < length; ++t) {
      const std::size_t entry = lower_.place(i, t);
      const double l = fixed ? 0.0 : row_[t] * inverse_pivot_[lower_.column[entry]];
      pivot -= row_[t] * l;
      lower_.value[entry] = upper_.value[mirror_[entry]] = l;
    }
    if (fixed)
      inverse_pivot_[i] = 0;
    else if (pivot > least_pivot * diagonal && std::isfinite(pivot))
      inverse_pivot_[i] = 1 / pivot;
    else
      return false;
  }
  return true;
}

/// r -= alpha q, then z = (I + L)^-1 r. Returns r . (preconditioned r); `norm` becomes r . D^-1 r.
Lanes IncompleteCholesky::descend(const double* inverse_diagonal, const Lanes* q, const Lanes& alpha, Lanes* r,
                                  Lanes& norm) {
  Lanes* const z = z_.data();
  Lanes rz{}, rr{};
  for (std::size_t i = 0; i < inverse_pivot_.size(); ++i) {
    const Lanes ri = r[i] - alpha * q[i];
    r[i] = ri;
    rr += inverse_diagonal[i] * (ri * ri);
    const Lanes zi = ri - row_sum(lower_, i, z);
    z[i] = zi;
    rz += inverse_pivot_[i] * (zi * zi);
  }
  norm = rr;
  return rz;
}

/// z = (I + L)^-T D^-1 z, then p = z + beta p.
void IncompleteCholesky::ascend(const Lanes& beta, Lanes* p) {
  Lanes* const z = z_.data();
  for (std::size_t i = inverse_pivot_.size(); i-- > 0;) {
    const Lanes zi = inverse_pivot_[i] * z[i] - row_sum(upper_, i, z);
    z[i] = zi;
    p[i] = zi + beta * p[i];
  }
}

void IncompleteCholesky::iterate(const System& system, Vectors& vectors, Progress& progress) {
  const double* const inverse = vectors.inverse_diagonal.data();
  const std::size_t n = inverse_pivot_.size();
  Lanes* const x = system.solution;
  Lanes* const r = vectors.residual.data();
  Lanes* const p = vectors.direction.data();
  Lanes* const q = vectors.product.data();
  std::fill(q, q + n, Lanes{});
  std::fill(p, p + n, Lanes{});
  Lanes rz = descend(inverse, q, Lanes{}, r, progress.residual);
  ascend(Lanes{}, p);
  while (!progress.is_converged() && progress.iterations < progress.max_iterations) {
    const Lanes pq = multiply_and_dot(system, p, q);
    const Lanes alpha = ratio(rz, pq);
    if (!is_step(pq, alpha)) {
      progress.broken = true;
      return;
    }
    for (std::size_t i = 0; i < n; ++i) x[i] += alpha * p[i];
    const Lanes rz_new = descend(inverse, q, alpha, r, progress.residual);
    ++progress.iterations;
    if (progress.is_converged()) break;
    ascend(ratio(rz_new, rz), p);
    rz = rz_new;
  }
}

}  // namespace meniscus::spd
