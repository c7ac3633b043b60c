// SPDX-License-Identifier: GPL-3.0-or-later
#include "pressure_arrays.h"

#include <cmath>

namespace meniscus {
namespace {

using Eigen::Vector3d;

/// y = scale (W q + stiffening L q). Returns the sum of y form.
Vector3d multiply_deformation(const PressureMass& mass, const std::vector<double>& q, std::vector<double>& y) {
  constexpr int width = Connectivity::width;
  const PressureSurface& surface = mass.surface;
  const std::uint32_t* neighbour = mass.connectivity.neighbour_rows();
  const double* weight = surface.stiffness.weight.data();
  const std::size_t n = q.size();
  Vector3d total = Vector3d::Zero();
  for (std::size_t i = 0; i < n; ++i, neighbour += width, weight += width) {
    double sum = surface.stiffness.diagonal[i] * q[i];
    for (int k = 0; k < width; ++k) sum -= weight[k] * q[neighbour[k]];
    y[i] = mass.inertia * (surface.mass[i] * q[i] + mass.stiffening * sum);
    total += y[i] * surface.form[i];
  }
  const auto& long_rings = mass.connectivity.long_rings();
  for (std::size_t r = 0; r < long_rings.size(); ++r) {
    const auto& [v, neighbours, corners] = long_rings[r];
    double sum = 0;
    for (std::size_t k = 0; k < neighbours.size(); ++k) sum += surface.stiffness.long_weight[r][k] * q[neighbours[k]];
    const double rest = mass.inertia * mass.stiffening * sum;
    y[v] -= rest;
    total -= rest * surface.form[v];
  }
  return total;
}

/// z = D^-1 r without what would change w . q. Returns r . z; `lambda` is w . D^-1 r / w . D^-1 w.
double precondition(const PressureArrays& arrays, double ww, std::vector<double>& z, double& lambda) {
  const std::vector<double>& r = arrays.residual;
  const std::vector<double>& w = arrays.surface.volume_gradient;
  double sum = 0;
  for (std::size_t i = 0; i < r.size(); ++i) {
    z[i] = arrays.fixed[i] != 0 ? 0 : r[i] * arrays.inverse_diagonal[i];
    sum += w[i] * z[i];
  }
  lambda = ww > 0 ? sum / ww : 0;
  double rz = 0;
  for (std::size_t i = 0; i < r.size(); ++i) {
    if (arrays.fixed[i] == 0) z[i] -= lambda * w[i] * arrays.inverse_diagonal[i];
    rz += r[i] * z[i];
  }
  return rz;
}

/// Zero on fixed rows, and w . q = flux.
double meet_constraints(double flux, PressureArrays& arrays) {
  const std::vector<double>& w = arrays.surface.volume_gradient;
  double ww = 0, wq = 0;
  for (std::size_t i = 0; i < w.size(); ++i) {
    if (arrays.fixed[i] != 0) {
      arrays.speed[i] = 0;
      continue;
    }
    ww += w[i] * w[i] * arrays.inverse_diagonal[i];
    wq += w[i] * arrays.speed[i];
  }
  for (std::size_t i = 0; i < w.size() && ww > 0; ++i)
    if (arrays.fixed[i] == 0) arrays.speed[i] += (flux - wq) / ww * w[i] * arrays.inverse_diagonal[i];
  return ww;
}

void find_residual(const PressureMass& mass, PressureArrays& arrays) {
  mass.multiply(arrays.speed, arrays.product, arrays.deformation);
  for (std::size_t i = 0; i < arrays.rhs.size(); ++i)
    arrays.residual[i] = arrays.fixed[i] != 0 ? 0 : arrays.rhs[i] - arrays.product[i];
}

}  // namespace

Vector3d PressureMass::translation(const std::vector<double>& q) const {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < q.size(); ++i) sum += q[i] * surface.moment[i];
  return sum / surface.volume;
}

void PressureMass::multiply(const std::vector<double>& q, std::vector<double>& y,
                            std::vector<double>& deformation) const {
  multiply(q, translation(q), y, deformation);
}

void PressureMass::multiply(const std::vector<double>& q, const Vector3d& U, std::vector<double>& y,
                            std::vector<double>& deformation) const {
  const std::size_t n = q.size();
  for (std::size_t i = 0; i < n; ++i) deformation[i] = q[i] - surface.form[i].dot(U);
  const Vector3d total = multiply_deformation(*this, deformation, y);
  const Vector3d rest = density * U - total / surface.volume;
  for (std::size_t i = 0; i < n; ++i) y[i] += surface.moment[i].dot(rest);
  if (friction)
    for (std::size_t i = 0; i < n; ++i) y[i] += (*friction)[i] * q[i];
}

void PressureMass::inverse_diagonal(std::vector<double>& inverse) const {
  for (std::size_t i = 0; i < inverse.size(); ++i) {
    double d = inertia * (surface.mass[i] + stiffening * surface.stiffness.diagonal[i]);
    if (friction) d += (*friction)[i];
    inverse[i] = d > 0 ? 1 / d : 1;  // else a row that takes no part
  }
}

ConstrainedSolve solve_constrained(const PressureMass& mass, double flux, const PressureOptions& options,
                                   PressureArrays& arrays) {
  std::vector<double>&q = arrays.speed, &r = arrays.residual, &z = arrays.preconditioned, &p = arrays.search;
  const std::size_t n = q.size();
  ConstrainedSolve result;
  const double ww = meet_constraints(flux, arrays);
  find_residual(mass, arrays);
  double lambda = 0, rz = precondition(arrays, ww, z, lambda), size = 0;
  for (std::size_t i = 0; i < n; ++i)
    if (arrays.fixed[i] == 0) size += arrays.rhs[i] * arrays.rhs[i] * arrays.inverse_diagonal[i];
  // Speeds of 1e-13 cm/s are as good as none.
  const double enough = options.tolerance * options.tolerance * size + 1e-26 * mass.density * mass.surface.volume;
  p = z;
  Vector3d U = mass.translation(p);
  while (rz > enough && result.iterations < options.max_iterations) {
    mass.multiply(p, U, arrays.product, arrays.deformation);
    double curvature = 0;
    for (std::size_t i = 0; i < n; ++i)
      if (arrays.fixed[i] == 0) curvature += p[i] * arrays.product[i];
    if (!(curvature > 0)) break;
    const double step = rz / curvature;
    for (std::size_t i = 0; i < n; ++i) {
      if (arrays.fixed[i] != 0) continue;
      q[i] += step * p[i];
      r[i] -= step * arrays.product[i];
    }
    const double rz_old = rz;
    rz = precondition(arrays, ww, z, lambda);
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = 0; i < n; ++i) {
      p[i] = z[i] + rz / rz_old * p[i];
      sum += p[i] * mass.surface.moment[i];
    }
    U = sum / mass.surface.volume;
    ++result.iterations;
  }
  result.converged = rz <= enough;
  result.pressure = lambda;
  return result;
}

}  // namespace meniscus
