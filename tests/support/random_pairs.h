// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "boolean_cases.h"
#include "judge.h"
#include "meniscus/topology/boolean.h"
#include "random_shapes.h"

#include <fmt/format.h>

#include <optional>

/// Random drops that overlap by a random depth, and what is wrong with their Booleans; a seed names a
/// case for ever.
namespace meniscus::random_pairs {

using random_shapes::Numbers;

/// A sphere, an ellipsoid or a bumpy ball of radius about 1, turned any way.
inline MeshData drop(Numbers& numbers) {
  const double edge = numbers.between(0.15, 0.7);
  const int kind = numbers.below(3);
  const double a = numbers.between(0.6, 1.4), b = numbers.between(0.6, 1.4);
  const Mesh mesh = kind == 0   ? make_sphere({0, 0, 0}, 1, edge)
                    : kind == 1 ? make_ellipsoid({0, 0, 0}, {a, b, 1}, edge)
                                : random_shapes::bumpy_sphere({0, 0, 0}, edge);
  const double angle = numbers.between(0, 6.28);
  const Eigen::Vector3d axis = numbers.vector(1);
  return boolean_cases::rotated(to_mesh_data(mesh), angle, axis);
}

/// Moves `mesh` so that its extreme vertex lies under a random point of a random face of `on`, `depth` below it.
inline MeshData pressed_into(const MeshData& mesh, const MeshData& on, double depth, Numbers& numbers) {
  const auto& t = on.triangles[static_cast<std::size_t>(numbers.below(static_cast<int>(on.triangles.size())))];
  const auto corner = [&](int k) -> Eigen::Vector3d { return Eigen::Vector3d::Map(on.points[t[k]].data()); };
  const double s = numbers.between(0, 1), r = (1 - s) * numbers.between(0, 1);
  const Eigen::Vector3d at = corner(0) + s * (corner(1) - corner(0)) + r * (corner(2) - corner(0));
  const Eigen::Vector3d n = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
  Eigen::Vector3d lowest = Eigen::Vector3d::Map(mesh.points[0].data());
  for (const auto& p : mesh.points)
    if (n.dot(Eigen::Vector3d::Map(p.data())) < n.dot(lowest)) lowest = Eigen::Vector3d::Map(p.data());
  return boolean_cases::moved(mesh, at - depth * n - lowest);
}

/// A pair with a log-uniform depth from 1e-9 to 1.
inline boolean_cases::Case pair(unsigned seed) {
  Numbers numbers(seed);
  const MeshData a = drop(numbers), b = drop(numbers);
  const double depth = numbers.log_between(1e-9, 1);
  return {fmt::format("pair {}, depth {:.1e}", seed, depth), a, pressed_into(b, a, depth, numbers)};
}

inline MeshData data_of(const BooleanResult& result) {
  MeshData data;
  data.points = result.points;
  data.triangles = result.triangles;
  return data;
}

/// What an independent judge says of a result that is no refusal.
inline std::string defect(const BooleanResult& result) {
  if (result.triangles.empty()) return {};
  try {
    const Mesh mesh = to_mesh(data_of(result));
    const judge::Soup soup = judge::soup_of(mesh);
    if (auto found = judge::edges_defect(soup); !found.empty()) return found;
    if (auto found = judge::fans_defect(soup); !found.empty()) return found;
    return judge::meets_itself(mesh) ? "the surface meets itself" : "";
  } catch (const std::exception& error) {
    return error.what();
  }
}

/// How a pair fared in all three operations.
struct Verdict {
  int refused = 0;
  int slow_steps = 0;   ///< results that took more than the local step
  std::string failure;  ///< what is wrong; empty if nothing is
};

inline Verdict judge_pair(const boolean_cases::Case& c, const BooleanOptions& options = {}) {
  Verdict verdict;
  double volume[3] = {0, 0, 0};
  const BooleanOperation operations[] = {BooleanOperation::unite, BooleanOperation::intersect,
                                         BooleanOperation::subtract};
  for (int k = 0; k < 3; ++k) {
    const BooleanResult result = boolean(view_of(c.a), view_of(c.b), operations[k], options);
    if (!result.ok()) {
      ++verdict.refused;
      verdict.failure += fmt::format("{}: operation {} refused: {}; ", c.name, k, result.message);
      continue;
    }
    verdict.slow_steps += result.step > BooleanStep::local;
    if (const std::string found = defect(result); !found.empty())
      verdict.failure += fmt::format("{}: operation {}: {}; ", c.name, k, found);
    volume[k] = result.triangles.empty() ? 0 : boolean_cases::volume(data_of(result));
  }
  if (verdict.refused > 0) return verdict;
  const double a = boolean_cases::volume(c.a), b = boolean_cases::volume(c.b);
  if (!(std::abs(volume[0] + volume[1] - a - b) <= 1e-9 * (a + b)) ||
      !(std::abs(volume[1] + volume[2] - a) <= 1e-9 * a))
    verdict.failure +=
        fmt::format("{}: volumes {} {} {} of {} and {}; ", c.name, volume[0], volume[1], volume[2], a, b);
  return verdict;
}

/// `count` drops united one after another, each pressed into the growing whole; the verdict is that of
/// every tenth union and of the last.
inline Verdict judge_sequence(unsigned seed, int count) {
  Numbers numbers(seed);
  MeshData whole = drop(numbers);
  Verdict verdict;
  BooleanOptions options;
  options.inputs_are_sound = true;
  for (int k = 1; k < count; ++k) {
    const double depth = numbers.log_between(1e-9, 1);
    const MeshData next = pressed_into(drop(numbers), whole, depth, numbers);
    const double least = boolean_cases::volume(whole), own = boolean_cases::volume(next);
    const BooleanResult result = boolean(view_of(whole), view_of(next), BooleanOperation::unite, options);
    if (!result.ok()) {
      ++verdict.refused;
      verdict.failure += fmt::format("sequence {}, drop {}: refused: {}; ", seed, k, result.message);
      continue;
    }
    verdict.slow_steps += result.step > BooleanStep::local;
    whole = data_of(result);
    const double volume = boolean_cases::volume(whole);
    if (!(volume >= std::max(least, own) * (1 - 1e-12)) || !(volume <= (least + own) * (1 + 1e-12)))
      verdict.failure += fmt::format("sequence {}, drop {}: volume {} of {} and {}; ", seed, k, volume, least, own);
    if (k % 10 == 0 || k + 1 == count)
      if (const std::string found = defect(result); !found.empty())
        return verdict.failure += fmt::format("sequence {}, drop {}: {}; ", seed, k, found), verdict;
  }
  return verdict;
}

}  // namespace meniscus::random_pairs
