// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/state/ledger.h"

#include "meniscus/core/chunks.h"
#include "meniscus/geometry/four_triangles.h"
#include "meniscus/geometry/rigid_motion.h"
#include "meniscus/state/offset_to_volume.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>

namespace meniscus {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

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

/// Sums over tetrahedra between the reference point and faces, of the volume, its first and its second moments.
struct VolumeSums {
  double volume = 0;
  Vector3d first = Vector3d::Zero(), squares = Vector3d::Zero();  // squares: xx, yy, zz
  Vector3d products = Vector3d::Zero();                           // yz, zx, xy

  VolumeSums& operator+=(const VolumeSums& other) {
    volume += other.volume;
    first += other.first;
    squares += other.squares;
    products += other.products;
    return *this;
  }
};

VolumeMoments volume_moments(const Drop& drop) {
  const auto& triangles = drop.connectivity().triangles();
  const ConstColumns x = drop.positions();
  const Vector3d reference = reference_point(drop);
  const FourVectors origin = constant(reference);
  const VolumeSums sums = sum_over_chunks(triangles.size(), VolumeSums{}, [&](std::size_t begin, std::size_t end) {
    Four volume{};
    FourVectors first{}, squares{}, products{};
    for (std::size_t k = begin; k < end; k += 4) {
      const FourTriangles four(triangles, k, end);
      const FourVectors p = four.corner(x.data(), 0) - origin, q = four.corner(x.data(), 1) - origin,
                        r = four.corner(x.data(), 2) - origin;
      const FourVectors s = p + q + r;
      const Four six = p.dot(q.cross(r));
      volume += six;
      first += six * s;
      squares.x += six * (p.x * p.x + q.x * q.x + r.x * r.x + s.x * s.x);
      squares.y += six * (p.y * p.y + q.y * q.y + r.y * r.y + s.y * s.y);
      squares.z += six * (p.z * p.z + q.z * q.z + r.z * r.z + s.z * s.z);
      products.x += six * (p.y * p.z + q.y * q.z + r.y * r.z + s.y * s.z);
      products.y += six * (p.z * p.x + q.z * q.x + r.z * r.x + s.z * s.x);
      products.z += six * (p.x * p.y + q.x * q.y + r.x * r.y + s.x * s.y);
    }
    return VolumeSums{sum(volume) / 6, sum(first) / 24, sum(squares) / 120, sum(products) / 120};
  });
  VolumeMoments moments;
  moments.volume = sums.volume;
  if (moments.volume == 0) return moments;
  const Vector3d mean = sums.first / moments.volume;
  moments.center = reference + mean;
  const Vector3d &a = sums.squares, &b = sums.products;
  Matrix3d second;
  second << a.x(), b.z(), b.y(), b.z(), a.y(), b.x(), b.y(), b.x(), a.z();
  second -= moments.volume * mean * mean.transpose();
  moments.inertia = second.trace() * Matrix3d::Identity() - second;
  return moments;
}

Vector3d fitted_rotation(const Drop& drop, const SurfaceGeometry& geometry) {
  return fit_rigid_motion(drop.positions(), drop.velocities(), geometry).rotation;
}

/// The enclosed volume and its first moment; flux, and momentum for a density of 1, of a field given at vertices.
/// Moment and momentum are about `reference`.
struct Motions {
  double volume = 0, flux = 0;
  Vector3d first = Vector3d::Zero(), momentum = Vector3d::Zero();
  Vector3d reference = Vector3d::Zero();

  Motions& operator+=(const Motions& other) {
    volume += other.volume;
    flux += other.flux;
    first += other.first;
    momentum += other.momentum;
    return *this;
  }
  Vector3d momentum_about(const Vector3d& c) const { return momentum - flux * (c - reference); }
};

/// Four faces at a time.
Motions motions_of(const Drop& drop, const ConstColumns& u) {
  const auto& triangles = drop.connectivity().triangles();
  const ConstColumns x = drop.positions();
  Motions none;
  none.reference = reference_point(drop);
  const FourVectors origin = constant(none.reference);
  return sum_over_chunks(triangles.size(), none, [&](std::size_t begin, std::size_t end) {
    Four volumes{}, fluxes{};
    FourVectors first{}, momentum{};
    for (std::size_t k = begin; k < end; k += 4) {
      const FourTriangles four(triangles, k, end);
      const FourVectors p = four.corner(x.data(), 0) - origin, q = four.corner(x.data(), 1) - origin,
                        r = four.corner(x.data(), 2) - origin, area = (q - p).cross(r - p);
      const Four volume = p.dot(area);
      volumes += volume;
      first += volume * (p + q + r);
      const Four at_p = four.corner(u.data(), 0).dot(area), at_q = four.corner(u.data(), 1).dot(area),
                 at_r = four.corner(u.data(), 2).dot(area), flux = at_p + at_q + at_r;
      fluxes += flux;
      momentum += (flux + at_p) * p + (flux + at_q) * q + (flux + at_r) * r;
    }
    return Motions{sum(volumes) / 6, sum(fluxes) / 6, sum(first) / 24, sum(momentum) / 24, none.reference};
  });
}

/// u += c + s n, so that the flux vanishes and the momentum about `center` is the wanted one. A constant field has no
/// flux, and V c of momentum.
void fit_momentum(Drop& drop, const SurfaceGeometry& geometry, const Vector3d& center, const Vector3d& momentum) {
  const Motions normals = motions_of(drop, geometry.normals());
  if (!(normals.flux > 0)) return;
  Columns u = drop.velocities();
  for (int round = 0; round < 2; ++round) {  // the second takes the rounding of the first
    const Motions now = motions_of(drop, u);
    const double s = -now.flux / normals.flux;
    const Vector3d c = (momentum - now.momentum_about(center) - s * normals.momentum_about(center)) / normals.volume;
    for (std::uint32_t i = 0; i < drop.num_rows(); ++i)
      if (drop.connectivity().degree(i) > 0) u.col(i) += c + s * geometry.normal(i);
  }
}

/// What restore_ledger adds leaves no vertex faster, about the mean motion, than this many times the fastest before.
constexpr double most_restored = 2;

}  // namespace

MeanMotion mean_motion(const Drop& drop) {
  const Motions sums = motions_of(drop, drop.velocities());
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
  if (!(ledger.volume > 0) || !(drop.volume() > 0)) return;
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
  if (pieces.size() == 1) return restore_ledger(pieces.front(), ledger, with_volume);
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
  return density * motions_of(drop, drop.velocities()).momentum_about(c);
}

}  // namespace meniscus
