// SPDX-License-Identifier: GPL-3.0-or-later
// The drop as a whole, for the level `pressure`: its volume, centre of mass, inertia and rotation.
#include "meniscus/core/chunks.h"
#include "meniscus/geometry/four_triangles.h"
#include "pressure_arrays.h"

#include <Eigen/Dense>

#include <cmath>

namespace meniscus {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A rotation as slow as this, beside the velocities, is none.
constexpr double rounding = 1e-10;

/// A sum of w r r^T.
struct Symmetric {
  Vector3d squares = Vector3d::Zero(), products = Vector3d::Zero();  ///< of x^2, y^2, z^2; of yz, zx, xy

  void add(double w, const Vector3d& r) {
    squares += w * r.cwiseAbs2();
    products += w * Vector3d(r.y() * r.z(), r.z() * r.x(), r.x() * r.y());
  }
  Symmetric& operator+=(const Symmetric& other) {
    squares += other.squares;
    products += other.products;
    return *this;
  }
  Matrix3d matrix() const {
    Matrix3d m;
    m << squares.x(), products.z(), products.y(), products.z(), squares.y(), products.x(), products.y(), products.x(),
        squares.z();
    return m;
  }
};

/// The normal equations of tangential_rotation. A motion U + rotation x r has the part P (U + rotation x r) along the
/// surface, P = I - n n^T; with R = -[r]x and q = R^T n = r x n their blocks are sums of m P, m P R = m (R - n q^T) and
/// m R^T P R = m (|r|^2 I - r r^T - q q^T).
struct TangentialFit {
  double mass = 0, squares = 0, energy = 0;  // sums of m, m |r|^2 and m |velocity|^2
  Vector3d arm = Vector3d::Zero(), momentum = Vector3d::Zero(), angular_momentum = Vector3d::Zero();
  Symmetric nn, rr_qq;
  Matrix3d nq = Matrix3d::Zero();

  void add(double m, const Vector3d& r, const Vector3d& n, const Vector3d& velocity) {
    const Vector3d q = r.cross(n), along = velocity - velocity.dot(n) * n;
    mass += m;
    squares += m * r.squaredNorm();
    energy += m * velocity.squaredNorm();
    arm += m * r;
    momentum += m * along;
    angular_momentum += m * r.cross(along);
    nn.add(m, n);
    nq += (m * n) * q.transpose();
    rr_qq.add(m, r);
    rr_qq.add(m, q);
  }
  TangentialFit& operator+=(const TangentialFit& other) {
    mass += other.mass;
    squares += other.squares;
    energy += other.energy;
    arm += other.arm;
    momentum += other.momentum;
    angular_momentum += other.angular_momentum;
    nn += other.nn;
    nq += other.nq;
    rr_qq += other.rr_qq;
    return *this;
  }
  /// 0 if it is the rounding of the velocities.
  Vector3d rotation() const {
    Matrix3d R;
    R << 0, arm.z(), -arm.y(), -arm.z(), 0, arm.x(), arm.y(), -arm.x(), 0;
    Eigen::Matrix<double, 6, 6> A;
    A.topLeftCorner<3, 3>() = mass * Matrix3d::Identity() - nn.matrix();
    A.topRightCorner<3, 3>() = R - nq;
    A.bottomLeftCorner<3, 3>() = A.topRightCorner<3, 3>().transpose();
    A.bottomRightCorner<3, 3>() = squares * Matrix3d::Identity() - rr_qq.matrix();
    Eigen::Matrix<double, 6, 1> b;
    b << momentum, angular_momentum;
    const Vector3d rotation = A.ldlt().solve(b).tail<3>();
    const bool is_motion = rotation.squaredNorm() * squares > rounding * rounding * energy;
    return is_motion && rotation.allFinite() ? rotation : Vector3d(Vector3d::Zero());
  }
};

/// 120 times the second moments about `origin` of the body between it and the surface.
Symmetric second_moments(const Vector3d& origin, const ConstColumns& x, const Connectivity& connectivity) {
  const auto& triangles = connectivity.triangles();
  return sum_over_chunks(triangles.size(), Symmetric{}, [&](std::size_t begin, std::size_t end) {
    Symmetric part;
    for (std::size_t f = begin; f < end; ++f) {
      const auto& [i, j, k] = triangles[f];
      if (i == Connectivity::removed) continue;
      const Vector3d a = x.col(i) - origin, b = x.col(j) - origin, c = x.col(k) - origin, sum = a + b + c;
      const double w = a.dot(b.cross(c));
      for (const Vector3d* r : {&a, &b, &c, &sum}) part.add(w, *r);
    }
    return part;
  });
}

/// Six times the volume and 24 times its first moment about `origin`.
struct Moments {
  double volume = 0;
  Vector3d first = Vector3d::Zero();

  Moments& operator+=(const Moments& other) {
    volume += other.volume;
    first += other.first;
    return *this;
  }
};

Moments moments_about(const Vector3d& o, const ConstColumns& x, const Connectivity& connectivity) {
  const auto& triangles = connectivity.triangles();
  const FourVectors origin = constant(o);
  return sum_over_chunks(triangles.size(), Moments{}, [&](std::size_t begin, std::size_t end) {
    Four volume{};
    FourVectors first{};
    for (std::size_t f = begin; f < end; f += 4) {
      const FourTriangles four(triangles, f, end);
      const FourVectors a = four.corner(x.data(), 0) - origin, b = four.corner(x.data(), 1) - origin,
                        c = four.corner(x.data(), 2) - origin;
      const Four w = a.dot(b.cross(c));
      volume += w;
      first += w * (a + b + c);
    }
    return Moments{sum(volume), sum(first)};
  });
}

}  // namespace

Vector3d tangential_rotation(const Drop& drop, const Vector3d& center) {
  const SurfaceGeometry& geometry = drop.workspace().geometry;
  const ConstColumns x = drop.positions(), velocity = drop.velocities();
  const double length = std::sqrt(geometry.area());
  if (!(length > 0)) return Vector3d::Zero();
  const TangentialFit fit = sum_over_chunks(drop.num_rows(), TangentialFit{}, [&](std::size_t begin, std::size_t end) {
    TangentialFit part;
    for (auto v = static_cast<std::uint32_t>(begin); v < end; ++v)
      if (drop.connectivity().degree(v) > 0)
        part.add(geometry.lumped_area(v), (x.col(v) - center) / length, geometry.normal(v), velocity.col(v));
    return part;
  });
  return fit.rotation() / length;
}

void measure_solid(const ConstColumns& x, const Connectivity& connectivity, PressureSurface& surface) {
  surface.volume = 0;
  surface.center.setZero();
  if (x.cols() == 0) return;
  const Vector3d origin = x.col(0);
  const Moments moments = moments_about(origin, x, connectivity);
  surface.volume = moments.volume / 6;
  if (surface.volume > 0) surface.center = origin + moments.first / (24 * surface.volume);
}

Matrix3d inertia_about(const Vector3d& center, const ConstColumns& x, const Connectivity& connectivity) {
  const Matrix3d second = second_moments(center, x, connectivity).matrix() / 120;
  return second.trace() * Matrix3d::Identity() - second;
}

}  // namespace meniscus
