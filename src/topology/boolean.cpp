// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/topology/boolean.h"

#include "boolean_parts.h"
#include "face_grid.h"
#include "meniscus/geometry/inspect.h"

#include <fmt/format.h>

#include <algorithm>

namespace meniscus {
namespace {

using namespace boolean_parts;

BooleanResult refuse(BooleanRefusal reason, std::string message) {
  BooleanResult result;
  result.refusal = reason;
  result.message = std::move(message);
  return result;
}

/// Coordinates beyond this overflow when they are multiplied.
constexpr double largest_coordinate = 1e90;

/// A refusal if an input is not sound; else an empty optional.
std::optional<BooleanResult> refuse_unsound(const MeshView& view, char letter) {
  const MeshData soup = soup_of(view);
  const Inspection inspection = inspect(soup);
  if (inspection.sound && view.points.cwiseAbs().maxCoeff() > largest_coordinate)
    return refuse(BooleanRefusal::unsound_input,
                  fmt::format("mesh {} has coordinates beyond {:.0e}; scale it down", letter, largest_coordinate));
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

/// One Boolean, and how much of it is taken on trust.
struct Task {
  const MeshView& a;
  const MeshView& b;
  BooleanOperation operation;
  bool check_whole;  ///< inspect the whole result, not only the seam
};

bool is_sound(const BooleanResult& result) { return result.triangles.empty() || inspect(data_of(result)).sound; }

/// Sets the volumes; false if the result's is impossible.
bool measure(const Task& task, BooleanResult& result) {
  result.volume_a = volume_of(task.a);
  result.volume_b = volume_of(task.b);
  result.volume = volume_of(view_of(result));
  return is_volume_possible(result, task.operation);
}

/// In general position: cut, check at the seam, measure.
std::optional<BooleanResult> try_local(const Task& task) {
  std::vector<std::uint32_t> near;
  auto result = cut_locally(task.a, task.b, task.operation, near);
  if (!result || !is_sound_at_seam(*result, near) || !measure(task, *result)) return std::nullopt;
  if (task.check_whole && !is_sound(*result)) return std::nullopt;
  return result;
}

/// Exact, of the whole meshes, rounded at the end: checked whole.
std::optional<BooleanResult> try_corefined(const Task& task) {
  auto result = corefine(task.a, task.b, task.operation);
  if (!result || !measure(task, *result) || !is_sound(*result)) return std::nullopt;
  result->outcome = outcome_by_volume(*result, task.operation);
  return result;
}

/// The ways that B is moved, one after another: none along an axis or a plane of anything likely.
const Eigen::Vector3d shift_directions[] = {Eigen::Vector3d(0.6017, 0.3719, 0.7069),
                                            Eigen::Vector3d(-0.4373, 0.7907, -0.4287),
                                            Eigen::Vector3d(0.2711, -0.6553, 0.7051)};

/// B moved by ever more, but little, until A and B are in general position.
std::optional<BooleanResult> try_shifted(const Task& task, double max_shift, int& retries) {
  const auto extent = [](const MeshView& view) { return box_of(view).sizes().maxCoeff(); };
  const double size = std::max(extent(task.a), extent(task.b));
  Eigen::Matrix3Xd moved;
  for (double share = 1e-13; share <= max_shift * (1 + 1e-9); share *= 10)
    for (const auto& direction : shift_directions) {
      const Eigen::Vector3d shift = share * size * direction;
      moved = task.b.points.colwise() + shift;
      const MeshView moved_b{{moved.data(), moved.cols()}, task.b.triangles};
      if (auto result = try_local({task.a, moved_b, task.operation, task.check_whole})) {
        result->step = BooleanStep::shifted;
        result->shift = shift;
        if (result->outcome == BooleanOutcome::disjoint) result->outcome = BooleanOutcome::touching;
        return result;
      }
      ++retries;
    }
  return std::nullopt;
}

/// No step gave a sound result: says whether the exact one is a 2-manifold, and where the surfaces meet.
BooleanResult refuse_result(const Task& task) {
  const bool is_manifold = corefine(task.a, task.b, task.operation).has_value();
  BooleanResult result =
      is_manifold ? refuse(BooleanRefusal::rounding, "the result is not sound once its points are rounded to doubles")
                  : refuse(BooleanRefusal::pinched,
                           "the surfaces touch or cross where the result would not be a 2-manifold; move one a little");
  find_meeting_faces(task.a, task.b, 20, result.faces_a, result.faces_b);
  return result;
}

BooleanResult by_ladder(const Task& task, double max_shift) {
  if (auto local = try_local(task)) return *std::move(local);
  int retries = 1;
  auto result = try_corefined(task);
  if (!result) {
    ++retries;
    result = try_shifted(task, max_shift, retries);
  }
  if (!result) result = refuse_result(task);
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
    case BooleanRefusal::pinched:
      return "pinched";
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
  BooleanResult result = by_ladder({a, b, operation, !options.inputs_are_sound}, options.max_shift);
  if (!options.keep_cavities && result.ok()) drop_cavities(result);
  return result;
}

}  // namespace meniscus
