// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/topology/boolean.h"

#include "boolean_parts.h"
#include "face_grid.h"
#include "meniscus/geometry/inspect.h"

#include <fmt/format.h>

#include <cmath>

namespace meniscus {
namespace {

using namespace boolean_parts;

BooleanResult refuse(BooleanRefusal reason, std::string message) {
  BooleanResult result;
  result.refusal = reason;
  result.message = std::move(message);
  return result;
}

/// A refusal if an input is not sound; else an empty optional.
std::optional<BooleanResult> refuse_unsound(const MeshView& view, char letter) {
  const MeshData soup = soup_of(view);
  const Inspection inspection = inspect(soup);
  if (inspection.sound) return std::nullopt;
  const Defect& defect = inspection.defects.front();
  BooleanResult result =
      refuse(BooleanRefusal::unsound_input, fmt::format("mesh {} is not sound: {}", letter, defect.message));
  for (const auto f : defect.faces)
    (letter == 'A' ? result.faces_a : result.faces_b).push_back(static_cast<std::uint32_t>(f));
  return result;
}

/// The volume of the result lies where those of A and B allow it.
bool is_volume_possible(const BooleanResult& r, BooleanOperation operation) {
  const bool unite = operation == BooleanOperation::unite, intersect = operation == BooleanOperation::intersect;
  const double low = unite ? std::max(r.volume_a, r.volume_b) : intersect ? 0 : r.volume_a - r.volume_b;
  const double high = unite ? r.volume_a + r.volume_b : intersect ? std::min(r.volume_a, r.volume_b) : r.volume_a;
  const double slack = 1e-12 * (r.volume_a + r.volume_b);
  return r.volume >= low - slack && r.volume <= high + slack;
}

/// Sets the volumes; false if the result's is impossible.
bool measure(const MeshView& a, const MeshView& b, BooleanOperation operation, BooleanResult& result) {
  result.volume_a = volume_of(a);
  result.volume_b = volume_of(b);
  result.volume = volume_of(view_of(result));
  return is_volume_possible(result, operation);
}

/// What the volumes tell of a result that has none of its own, to rounding.
BooleanOutcome outcome_by_volume(const BooleanResult& r, BooleanOperation operation) {
  const double common = operation == BooleanOperation::unite       ? r.volume_a + r.volume_b - r.volume
                        : operation == BooleanOperation::intersect ? r.volume
                                                                   : r.volume_a - r.volume;
  const double slack = 1e-12 * (r.volume_a + r.volume_b);
  const bool all_a = common >= r.volume_a - slack, all_b = common >= r.volume_b - slack;
  return all_a && all_b    ? BooleanOutcome::equal
         : all_a           ? BooleanOutcome::a_inside_b
         : all_b           ? BooleanOutcome::b_inside_a
         : common <= slack ? BooleanOutcome::touching
                           : BooleanOutcome::crossing;
}

/// In general position: cut, check at the seam, measure.
std::optional<BooleanResult> try_local(const MeshView& a, const MeshView& b, BooleanOperation operation) {
  std::vector<std::uint32_t> near;
  auto result = cut_locally(a, b, operation, near);
  if (!result || !is_sound_at_seam(*result, near) || !measure(a, b, operation, *result)) return std::nullopt;
  return result;
}

/// Exact, of the whole meshes, rounded at the end: checked whole.
std::optional<BooleanResult> try_corefined(const MeshView& a, const MeshView& b, BooleanOperation operation) {
  auto result = corefine(a, b, operation);
  if (!result || !measure(a, b, operation, *result)) return std::nullopt;
  if (!result->triangles.empty() && !inspect(data_of(*result)).sound) return std::nullopt;
  result->outcome = outcome_by_volume(*result, operation);
  return result;
}

/// The ways that B is moved, one after another: none along an axis or a plane of anything likely.
const Eigen::Vector3d shift_directions[] = {Eigen::Vector3d(0.6017, 0.3719, 0.7069),
                                            Eigen::Vector3d(-0.4373, 0.7907, -0.4287),
                                            Eigen::Vector3d(0.2711, -0.6553, 0.7051)};

/// B moved by ever more, but little, until A and B are in general position.
std::optional<BooleanResult> try_shifted(const MeshView& a, const MeshView& b, BooleanOperation operation,
                                         double max_shift, int& retries) {
  const auto extent = [](const MeshView& view) { return box_of(view).sizes().maxCoeff(); };
  const double size = std::max(extent(a), extent(b));
  Eigen::Matrix3Xd moved = b.points;
  for (double share = 1e-13; share <= max_shift * (1 + 1e-9); share *= 10)
    for (const auto& direction : shift_directions) {
      const Eigen::Vector3d shift = share * size * direction;
      moved = b.points.colwise() + shift;
      if (auto result = try_local(a, {{moved.data(), moved.cols()}, b.triangles}, operation)) {
        result->step = BooleanStep::shifted;
        result->shift = shift;
        return result;
      }
      ++retries;
    }
  return std::nullopt;
}

BooleanResult by_ladder(const MeshView& a, const MeshView& b, BooleanOperation operation, double max_shift) {
  if (auto local = try_local(a, b, operation)) return *std::move(local);
  int retries = 1;
  auto result = try_corefined(a, b, operation);
  if (!result) result = (++retries, try_shifted(a, b, operation, max_shift, retries));
  if (!result) return refuse(BooleanRefusal::rounding, "no step gave a sound result");
  result->retries = retries;
  return *std::move(result);
}

}  // namespace

const char* name(BooleanOutcome outcome) {
  switch (outcome) {
    case BooleanOutcome::refused:
      return "refused";
    case BooleanOutcome::disjoint:
      return "disjoint";
    case BooleanOutcome::a_inside_b:
      return "a_inside_b";
    case BooleanOutcome::b_inside_a:
      return "b_inside_a";
    case BooleanOutcome::equal:
      return "equal";
    case BooleanOutcome::touching:
      return "touching";
    case BooleanOutcome::crossing:
      return "crossing";
  }
  return "";
}

const char* name(BooleanRefusal refusal) {
  switch (refusal) {
    case BooleanRefusal::none:
      return "none";
    case BooleanRefusal::unsound_input:
      return "unsound_input";
    case BooleanRefusal::rounding:
      return "rounding";
  }
  return "";
}

const char* name(BooleanStep step) {
  switch (step) {
    case BooleanStep::apart:
      return "apart";
    case BooleanStep::local:
      return "local";
    case BooleanStep::corefined:
      return "corefined";
    case BooleanStep::shifted:
      return "shifted";
  }
  return "";
}

BooleanResult boolean(const MeshView& a, const MeshView& b, BooleanOperation operation, const BooleanOptions& options) {
  if (!options.inputs_are_sound) {
    if (auto refusal = refuse_unsound(a, 'A')) return *refusal;
    if (auto refusal = refuse_unsound(b, 'B')) return *refusal;
  }
  BooleanResult result = by_ladder(a, b, operation, options.max_shift);
  if (!options.keep_cavities && result.ok()) drop_cavities(result);
  return result;
}

}  // namespace meniscus
