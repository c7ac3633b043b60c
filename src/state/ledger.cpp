// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/state/ledger.h"

#include "meniscus/core/chunks.h"
#include "meniscus/geometry/four_triangles.h"
#include "meniscus/geometry/rigid_motion.h"
#include "meniscus/state/offset_to_volume.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace meniscus {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Vector3d;
using Eigen::Vector4d;

/// Calls visit(a, b, c) for each face that is there.
template <class Visit>
void for_each_face(const Drop& drop, Visit visit) {
  for (const auto& [a, b, c] : drop.connectivity().triangles())
    if (a != Connectivity::removed) visit(a, b, c);
}

/// Where positions are measured from, so that a drop far from the origin loses no digits.
Vector3d reference_point(const Drop& drop) {
  for (const auto& [a, b, c] : drop.connectivity().triangles())
    if (a != Connectivity::removed) return drop.positions().col(a);
  return Vector3d::Zero();
}

/// Integrals over the enclosed volume.
struct VolumeMoments {
  double volume = 0;
  Vector3d center = Vector3d::Zero();
  Matrix3d inertia = Matrix3d::Zero();  ///< about the centre, density 1
};

VolumeMoments volume_moments(const Drop& drop) {
  const ConstColumns x = drop.positions();
  const Vector3d origin = reference_point(drop);
  VolumeMoments moments;
  Vector3d first = Vector3d::Zero();
  Matrix3d second = Matrix3d::Zero();
  for_each_face(drop, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const Vector3d p = x.col(a) - origin, q = x.col(b) - origin, r = x.col(c) - origin, s = p + q + r;
    const double tetrahedron = p.dot(q.cross(r)) / 6;
    moments.volume += tetrahedron;
    first += tetrahedron / 4 * s;
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j)
        second(i, j) += tetrahedron / 20 * (p[i] * p[j] + q[i] * q[j] + r[i] * r[j] + s[i] * s[j]);
  });
  second.triangularView<Eigen::StrictlyLower>() = second.transpose();
  if (moments.volume == 0) return moments;
  const Vector3d mean = first / moments.volume;
  moments.center = origin + mean;
  second -= moments.volume * mean * mean.transpose();
  moments.inertia = second.trace() * Matrix3d::Identity() - second;
  return moments;
}

Vector3d fitted_rotation(const Drop& drop, const SurfaceGeometry& geometry) {
  return fit_rigid_motion(drop.positions(), drop.velocities(), geometry).rotation;
}

/// Flux and momentum about `center` of n velocity fields, as one vector (flux, P) each: fields(i) is what they are at
/// vertex i.
template <std::size_t n, class Fields>
std::array<Vector4d, n> flux_and_momentum(const Drop& drop, const Vector3d& center, Fields fields) {
  const ConstColumns x = drop.positions();
  std::array<Vector4d, n> sums;
  sums.fill(Vector4d::Zero());
  for_each_face(drop, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    const Vector3d p = x.col(i), q = x.col(j), r = x.col(k);
    const Vector3d area = 0.5 * (q - p).cross(r - p), from_p = p - center, from_q = q - center, from_r = r - center;
    const std::array<Vector3d, n> u = fields(i), v = fields(j), w = fields(k);
    for (std::size_t f = 0; f < n; ++f) {
      const double flux_i = u[f].dot(area), flux_j = v[f].dot(area), flux_k = w[f].dot(area);
      const double flux = flux_i + flux_j + flux_k;
      sums[f][0] += flux / 3;
      sums[f].template tail<3>() +=
          ((flux + flux_i) * from_p + (flux + flux_j) * from_q + (flux + flux_k) * from_r) / 12;
    }
  });
  return sums;
}

Vector4d flux_and_momentum(const Drop& drop, const Vector3d& center) {
  const ConstColumns u = drop.velocities();
  return flux_and_momentum<1>(drop, center, [&](std::uint32_t i) { return std::array<Vector3d, 1>{u.col(i)}; })[0];
}

/// u += c + s n off solids, so that the flux vanishes and the momentum about `center` is the wanted one.
void fit_momentum(Drop& drop, const SurfaceGeometry& geometry, const Vector3d& center, const Vector3d& momentum) {
  Columns u = drop.velocities();
  const auto basis = [&](std::uint32_t i) -> std::array<Vector3d, 4> {
    if (!is_off_solids(drop, i)) return {Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};
    return {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ(), geometry.normal(i)};
  };
  const std::array<Vector4d, 4> columns = flux_and_momentum<4>(drop, center, basis);
  Matrix4d matrix;
  for (int k = 0; k < 4; ++k) matrix.col(k) = columns[static_cast<std::size_t>(k)];
  // In units in which a sphere of radius 1 gives numbers near 1.
  const double length = std::cbrt(geometry.volume());
  const Vector4d scale(length * length, length * length * length, length * length * length, length * length * length);
  const Eigen::FullPivLU<Matrix4d> solver(scale.cwiseInverse().asDiagonal() * matrix);
  if (!solver.isInvertible()) return;
  for (int round = 0; round < 2; ++round) {  // the second takes the rounding of the first
    Vector4d wanted;
    wanted << 0, momentum;
    wanted -= flux_and_momentum(drop, center);
    const Vector4d c = solver.solve(wanted.cwiseQuotient(scale));
    for (std::uint32_t i = 0; i < drop.num_rows(); ++i)
      if (is_off_solids(drop, i)) u.col(i) += c.head<3>() + c[3] * geometry.normal(i);
  }
}

/// What restore_ledger adds leaves no vertex faster, about the mean motion, than this many times the fastest before.
constexpr double most_restored = 2;

/// What mean_motion sums over faces, four at a time, times 6, 6, 24 and 24: enclosed volume, flux of the velocity,
/// first moment of the volume, and momentum about the origin.
struct FourMotions {
  Four volume{}, flux{};
  FourVectors first{}, momentum{};
};

Vector3d sum_of(const FourVectors& v) { return {sum(v.x), sum(v.y), sum(v.z)}; }

struct Motions {
  double volume = 0, flux = 0;
  Vector3d first = Vector3d::Zero(), momentum = Vector3d::Zero();

  Motions& operator+=(const Motions& other) {
    volume += other.volume;
    flux += other.flux;
    first += other.first;
    momentum += other.momentum;
    return *this;
  }
};

}  // namespace

MeanMotion mean_motion(const Drop& drop) {
  const auto& triangles = drop.connectivity().triangles();
  const ConstColumns x = drop.positions(), u = drop.velocities();
  const Vector3d o = reference_point(drop);
  const FourVectors origin{constant(o.x()), constant(o.y()), constant(o.z())};
  const Motions sums = sum_over_chunks(triangles.size(), Motions{}, [&](std::size_t begin, std::size_t end) {
    FourMotions part;
    for (std::size_t first = begin; first < end; first += 4) {
      const FourTriangles four(triangles, first, end);
      const FourVectors p = four.corner(x.data(), 0) - origin, q = four.corner(x.data(), 1) - origin,
                        r = four.corner(x.data(), 2) - origin, area = (q - p).cross(r - p);
      const Four volume = p.dot(area);
      part.volume += volume;
      part.first.x += volume * (p.x + q.x + r.x);
      part.first.y += volume * (p.y + q.y + r.y);
      part.first.z += volume * (p.z + q.z + r.z);
      const Four at_p = four.corner(u.data(), 0).dot(area), at_q = four.corner(u.data(), 1).dot(area),
                 at_r = four.corner(u.data(), 2).dot(area), flux = at_p + at_q + at_r;
      part.flux += flux;
      part.momentum.x += (flux + at_p) * p.x + (flux + at_q) * q.x + (flux + at_r) * r.x;
      part.momentum.y += (flux + at_p) * p.y + (flux + at_q) * q.y + (flux + at_r) * r.y;
      part.momentum.z += (flux + at_p) * p.z + (flux + at_q) * q.z + (flux + at_r) * r.z;
    }
    return Motions{sum(part.volume) / 6, sum(part.flux) / 6, sum_of(part.first) / 24, sum_of(part.momentum) / 24};
  });
  if (!(sums.volume > 0)) return {};
  return {sums.volume, (sums.momentum - sums.flux / sums.volume * sums.first) / sums.volume};
}

bool calm_torn_piece(Drop& piece) {
  constexpr double rounding = 1e-9;
  const Vector3d mean = mean_over_vertices(piece, piece.velocities());
  if ((mean_motion(piece).velocity - mean).norm() <= top_speed(piece, mean) + rounding * mean.norm()) return false;
  piece.velocities().colwise() = mean;
  return true;
}

Ledger& Ledger::operator+=(const Ledger& other) {
  volume += other.volume;
  moment += other.moment;
  momentum += other.momentum;
  angular_momentum += other.angular_momentum;
  return *this;
}

namespace {

Ledger measure_ledger(const Drop& drop, const SurfaceGeometry& geometry) {
  const VolumeMoments moments = volume_moments(drop);
  if (!(moments.volume > 0)) return {};
  Ledger ledger;
  ledger.volume = moments.volume;
  ledger.moment = moments.volume * moments.center;
  ledger.momentum = surface_momentum(drop, 1, moments.center);
  ledger.angular_momentum = moments.center.cross(ledger.momentum) + moments.inertia * fitted_rotation(drop, geometry);
  return ledger;
}

/// `geometry`: the drop's as it is.
void restore_ledger(Drop& drop, SurfaceGeometry& geometry, const Ledger& ledger, bool with_volume) {
  if (!(ledger.volume > 0)) return;
  if (with_volume) {
    constexpr double unbounded = std::numeric_limits<double>::infinity();
    offset_to_volume(drop, geometry, free_area(drop, geometry), ledger.volume, -unbounded, unbounded);
  }
  if (touches_solid(drop)) return;
  if (with_volume) geometry.compute(std::as_const(drop).positions(), drop.connectivity());
  VolumeMoments moments = volume_moments(drop);
  if (!(moments.volume > 0)) return;
  const Vector3d shift = ledger.center() - moments.center;
  drop.positions().colwise() += shift;
  moments.center += shift;
  const Vector3d mean = ledger.momentum / ledger.volume, momentum = moments.volume * mean;
  const double fastest = most_restored * top_speed(drop, mean);
  Eigen::Matrix3Xd before = drop.velocities();
  fit_momentum(drop, geometry, moments.center, momentum);
  if (top_speed(drop, mean) > fastest) {
    drop.velocities() = before;
    return;
  }
  before = drop.velocities();
  const Vector3d spin = moments.volume / ledger.volume * ledger.angular_momentum - moments.center.cross(momentum);
  const Vector3d turn = moments.inertia.ldlt().solve(spin) - fitted_rotation(drop, geometry);
  if (!turn.allFinite()) return;
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i)
    drop.velocities().col(i) += turn.cross(Vector3d(drop.positions().col(i) - moments.center));
  if (top_speed(drop, mean) > fastest) drop.velocities() = before;
}

SurfaceGeometry geometry_of(const Drop& drop) {
  SurfaceGeometry geometry;
  geometry.compute(drop.positions(), drop.connectivity());
  return geometry;
}

}  // namespace

Ledger measure_ledger(const Drop& drop) { return measure_ledger(drop, geometry_of(drop)); }

void restore_ledger(Drop& drop, const Ledger& ledger, bool with_volume) {
  SurfaceGeometry geometry = geometry_of(drop);
  restore_ledger(drop, geometry, ledger, with_volume);
}

void restore_ledger(std::vector<Drop>& pieces, const Ledger& ledger, bool with_volume) {
  std::vector<SurfaceGeometry> geometries;
  std::vector<Ledger> own;
  Ledger sum;
  for (const Drop& piece : pieces) {
    geometries.push_back(geometry_of(piece));
    own.push_back(measure_ledger(piece, geometries.back()));
    sum += own.back();
  }
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const double share = own[k].volume / sum.volume;
    own[k].volume += share * (ledger.volume - sum.volume);
    own[k].moment += share * (ledger.moment - sum.moment);
    own[k].momentum += share * (ledger.momentum - sum.momentum);
    own[k].angular_momentum += share * (ledger.angular_momentum - sum.angular_momentum);
    restore_ledger(pieces[k], geometries[k], own[k], with_volume);
  }
}

Vector3d volume_centroid(const Drop& drop) { return volume_moments(drop).center; }

Vector3d surface_momentum(const Drop& drop, double density, const Vector3d& c) {
  return density * flux_and_momentum(drop, c).tail<3>();
}

}  // namespace meniscus
