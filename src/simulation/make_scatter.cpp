// SPDX-License-Identifier: GPL-3.0-or-later
#include "make_scatter.h"

#include "meniscus/core/error.h"
#include "meniscus/geometry/shapes.h"
#include "place_cap.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <random>

namespace meniscus {
namespace {

using Eigen::Vector3d;

/// Places tried for a drop before it is said not to fit.
constexpr int most_tries = 2000;

/// Uniform in [0, 1): the same on every machine, which std::uniform_real_distribution need not be.
double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

/// The radii, largest first: large drops find room while there is some.
std::vector<double> draw_radii(const DropSpec& spec, std::mt19937_64& random) {
  std::vector<double> radii;
  for (int k = 0; k < spec.count; ++k) {
    const double u = uniform(random);
    radii.push_back(spec.sizes == ScatterSizes::uniform
                        ? spec.radius_min + u * (spec.radius_max - spec.radius_min)
                        : spec.radius_min * std::pow(spec.radius_max / spec.radius_min, u));
  }
  std::sort(radii.begin(), radii.end(), std::greater<>());
  return radii;
}

Vector3d draw_point(const DropSpec& spec, std::mt19937_64& random) {
  Vector3d p;
  for (int k = 0; k < 3; ++k) p[k] = spec.center[k] + (uniform(random) - 0.5) * spec.size[k];
  return p;
}

const Solid* solid_called(const std::vector<Solid>& solids, const std::string& name) {
  if (name.empty()) return nullptr;
  const auto it = std::find_if(solids.begin(), solids.end(), [&](const Solid& solid) { return solid.name == name; });
  if (it == solids.end())
    throw UsageError(fmt::format("drops are scattered on \"{}\", but no solid has that name", name));
  return &*it;
}

bool is_free(const BoundingBall& ball, double gap, const Solid* own, const std::vector<Solid>& solids,
             const std::vector<BoundingBall>& taken) {
  for (const BoundingBall& other : taken)
    if (ball.is_near(other, gap)) return false;
  for (const Solid& solid : solids)
    if (&solid != own && solid.is_near(ball.center, 0, ball.radius) &&
        solid.query(ball.center, 0).distance < ball.radius)
      return false;
  return true;
}

}  // namespace

BoundingBall bounding_ball(const Mesh& mesh) {
  const ConstColumns x = positions(mesh);
  Eigen::AlignedBox3d box;
  for (Eigen::Index i = 0; i < x.cols(); ++i) box.extend(Vector3d(x.col(i)));
  BoundingBall ball{box.center(), 0};
  for (Eigen::Index i = 0; i < x.cols(); ++i) ball.radius = std::max(ball.radius, (x.col(i) - ball.center).norm());
  return ball;
}

std::vector<Mesh> make_scatter(const Scene& scene, const DropSpec& spec, const std::vector<Solid>& solids,
                               std::vector<BoundingBall>& taken) {
  std::mt19937_64 random(static_cast<std::uint64_t>(spec.seed));
  const Solid* own = solid_called(solids, spec.on);
  const double edge_length = 0.5 * (scene.mesh.edge_min + scene.mesh.edge_max);
  const auto place = [&](double radius) -> std::optional<Mesh> {
    const Vector3d p = draw_point(spec, random);
    if (!own) return make_sphere(p, radius, edge_length);
    return place_cap(*own, p, radius, spec.angle.value_or(resting_angle(*own)), edge_length);
  };
  std::vector<Mesh> drops;
  for (const double radius : draw_radii(spec, random)) {
    const std::size_t before = drops.size();
    for (int k = 0; k < most_tries && drops.size() == before; ++k) {
      std::optional<Mesh> mesh = place(radius);
      if (!mesh) continue;
      const BoundingBall ball = bounding_ball(*mesh);
      if (!is_free(ball, spec.gap, own, solids, taken)) continue;
      taken.push_back(ball);
      drops.push_back(std::move(*mesh));
    }
    if (drops.size() == before)
      throw UsageError(
          fmt::format("only {} of {} scattered drops fit without touching; take fewer or smaller ones, or a larger box",
                      drops.size(), spec.count));
  }
  return drops;
}

}  // namespace meniscus
