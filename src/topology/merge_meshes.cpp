// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/topology/merge_meshes.h"

#include "meniscus/core/error.h"
#include "meniscus/core/index_sets.h"
#include "meniscus/geometry/inspect.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace meniscus {
namespace {

double value_at(const VertexAttribute& attribute, const SurfacePoint& at) {
  const auto value = [&](int k) { return attribute.values[at.corners[k]]; };
  if (is_integer(attribute.type))
    return value(static_cast<int>(std::max_element(at.weights.begin(), at.weights.end()) - at.weights.begin()));
  return value(0) + at.weights[1] * (value(1) - value(0)) + at.weights[2] * (value(2) - value(0));
}

double on_seam(const VertexAttribute* a, const VertexAttribute* b, const SeamVertex& vertex) {
  if (!a) return value_at(*b, vertex.on_b);
  if (!b || is_integer(a->type)) return value_at(*a, vertex.on_a);
  return 0.5 * (value_at(*a, vertex.on_a) + value_at(*b, vertex.on_b));
}

VertexAttribute gathered(const BooleanResult& result, const VertexAttribute* a, const VertexAttribute* b) {
  VertexAttribute out{(a ? a : b)->name, (a ? a : b)->type, {}};
  out.values.reserve(result.points.size());
  for (const auto v : result.kept_a) out.values.push_back(a ? a->values[v] : 0);
  for (const auto v : result.kept_b) out.values.push_back(b ? b->values[v] : 0);
  for (const auto& vertex : result.seam) out.values.push_back(on_seam(a, b, vertex));
  return out;
}

MeshData with_attributes(BooleanResult& result, const MeshData& a, const MeshData& b) {
  MeshData data;
  for (const auto& attribute : a.attributes)
    data.attributes.push_back(gathered(result, &attribute, b.attribute(attribute.name)));
  for (const auto& attribute : b.attributes)
    if (!a.attribute(attribute.name)) data.attributes.push_back(gathered(result, nullptr, &attribute));
  data.points = std::move(result.points);
  data.triangles = std::move(result.triangles);
  data.comments = a.comments;
  return data;
}

/// Gives each component one "drop", the smallest that it has.
void unify_drops(MeshData& data) {
  const auto drop =
      std::find_if(data.attributes.begin(), data.attributes.end(), [](const auto& a) { return a.name == "drop"; });
  if (drop == data.attributes.end()) return;
  IndexSets sets(data.points.size());
  for (const auto& t : data.triangles)
    for (int k = 0; k < 2; ++k) sets.unite(t[k], t[k + 1]);
  std::vector<double> least(data.points.size(), std::numeric_limits<double>::infinity());
  for (std::uint32_t v = 0; v < least.size(); ++v) {
    double& value = least[sets.find(v)];
    value = std::min(value, drop->values[v]);
  }
  for (std::uint32_t v = 0; v < least.size(); ++v) drop->values[v] = least[sets.find(v)];
}

void add(const BooleanResult& result, MeshMergeReport& report) {
  ++report.joins;
  if (result.step != BooleanStep::apart) ++report.crossings;
  report.retries += result.retries;
  report.shift = std::max(report.shift, result.shift.norm());
  report.outcome = result.outcome;
  report.step = std::max(report.step, result.step);
}

/// A mesh on the way, and the first input that is in it.
struct Part {
  MeshData mesh;
  std::size_t first;
};

std::optional<MeshData> join(const Part& a, const Part& b, BooleanOperation operation, const BooleanOptions& options,
                             MeshMergeReport& report) {
  BooleanResult result = boolean(view_of(a.mesh), view_of(b.mesh), operation, options);
  if (!result.ok()) {
    report.outcome = BooleanOutcome::refused;
    report.refusal = result.refusal;
    report.message = result.message;
    report.first = a.first;
    report.second = b.first;
    report.failed.emplace(a.mesh, b.mesh);
    return std::nullopt;
  }
  add(result, report);
  return with_attributes(result, a.mesh, b.mesh);
}

/// Joins neighbours until one is left.
std::optional<Part> join_all(std::vector<Part> parts, BooleanOperation operation, const BooleanOptions& options,
                             MeshMergeReport& report) {
  while (parts.size() > 1) {
    std::vector<Part> joined;
    for (std::size_t k = 0; k + 1 < parts.size(); k += 2) {
      auto mesh = join(parts[k], parts[k + 1], operation, options, report);
      if (!mesh) return std::nullopt;
      if (mesh->triangles.empty()) return Part{std::move(*mesh), parts[k].first};  // an empty intersection stays so
      joined.push_back({std::move(*mesh), parts[k].first});
    }
    if (parts.size() % 2 == 1) joined.push_back(std::move(parts.back()));
    parts = std::move(joined);
  }
  return std::move(parts.front());
}

/// Sets the attributes of rows that came from the cutter to those of the nearest row on the seam.
void fill_cut(const BooleanResult& result, MeshData& part) {
  const std::size_t first = result.first_seam_row();
  for (std::size_t v = result.kept_a.size(); v < first; ++v) {
    const Eigen::Vector3d p = Eigen::Vector3d::Map(part.points[v].data());
    std::size_t nearest = v;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t s = first; s < part.points.size(); ++s) {
      const double distance = (Eigen::Vector3d::Map(part.points[s].data()) - p).squaredNorm();
      if (distance < least) least = distance, nearest = s;
    }
    for (auto& attribute : part.attributes) attribute.values[v] = attribute.values[nearest];
  }
}

/// merge_meshes of meshes that are known to be sound.
std::optional<MeshData> merge_sound(const std::vector<MeshData>& meshes, BooleanOperation operation,
                                    const BooleanOptions& options, MeshMergeReport& report) {
  report = {};
  std::vector<Part> parts;
  for (std::size_t k = 0; k < meshes.size(); ++k) parts.push_back({meshes[k], k});
  std::optional<MeshData> mesh;
  if (operation == BooleanOperation::subtract && parts.size() > 1) {
    const Part first = std::move(parts.front());
    parts.erase(parts.begin());
    const auto rest = join_all(std::move(parts), BooleanOperation::unite, options, report);
    if (rest) mesh = join(first, *rest, operation, options, report);
  } else if (auto all = join_all(std::move(parts), operation, options, report)) {
    mesh = std::move(all->mesh);
  }
  if (mesh) unify_drops(*mesh);
  return mesh;
}

}  // namespace

std::optional<MeshData> merge_meshes(const std::vector<MeshData>& meshes, BooleanOperation operation,
                                     const BooleanOptions& options, MeshMergeReport& report) {
  if (meshes.empty()) throw UsageError("merge: give at least one mesh");
  if (!options.inputs_are_sound)
    for (const auto& mesh : meshes) require_sound(mesh);
  BooleanOptions trusting = options;
  trusting.inputs_are_sound = true;
  auto merged = merge_sound(meshes, operation, trusting, report);
  if (merged && (merged->triangles.empty() || options.inputs_are_sound || inspect(*merged).sound)) return merged;
  trusting.inputs_are_sound = false;  // again, each join checked whole
  const int retries = report.retries + 1;
  merged = merge_sound(meshes, operation, trusting, report);
  report.retries += retries;
  return merged;
}

void require_sound(const MeshData& mesh) {
  const Inspection inspection = inspect(mesh);
  if (inspection.sound) return;
  const Defect& defect = inspection.defects.front();
  throw GeometryError(defect.message, defect.faces, defect.vertices);
}

std::optional<std::pair<MeshData, MeshData>> divide(const MeshData& mesh, const MeshData& cutter,
                                                    const BooleanOptions& options, MeshMergeReport& report) {
  report = {};
  require_sound(mesh);
  require_sound(cutter);
  MeshData plain = cutter;
  plain.attributes.clear();
  std::pair<MeshData, MeshData> parts;
  for (const bool inside : {true, false}) {
    BooleanResult result = boolean(view_of(mesh), view_of(plain),
                                   inside ? BooleanOperation::intersect : BooleanOperation::subtract, options);
    if (!result.ok()) {
      report.refusal = result.refusal;
      report.message = result.message;
      report.failed.emplace(mesh, plain);
      return std::nullopt;
    }
    add(result, report);
    const BooleanResult rows = result;
    MeshData& part = inside ? parts.first : parts.second;
    part = with_attributes(result, mesh, plain);
    fill_cut(rows, part);
  }
  return parts;
}

MeshData half_space(const MeshData& mesh, const Eigen::Vector3d& normal, double offset) {
  const double length = normal.norm();
  if (!std::isfinite(length) || length == 0 || !std::isfinite(offset))
    throw UsageError("the plane's normal must be finite and not zero");
  const Eigen::Vector3d n = normal / length;
  const double height = offset / length;
  Eigen::AlignedBox3d box;
  for (const auto& p : mesh.points) box.extend(Eigen::Vector3d::Map(p.data()));
  if (box.isEmpty()) box.extend(Eigen::Vector3d(Eigen::Vector3d::Zero()));
  const double radius = box.sizes().norm() + std::numeric_limits<double>::min();
  const Eigen::Vector3d center = box.center() + (height - n.dot(box.center())) * n;  // of the face in the plane
  const double depth = radius + std::max(0.0, height - n.dot(box.center()));
  const Eigen::Vector3d u = n.unitOrthogonal() * radius, v = n.cross(u), down = -2 * depth * n;
  MeshData cutter;
  for (const double side : {0.0, 1.0})
    for (int k = 0; k < 4; ++k) {
      const Eigen::Vector3d p = center + side * down + (k == 0 || k == 3 ? -1 : 1) * u + (k < 2 ? -1 : 1) * v;
      cutter.points.push_back({p.x(), p.y(), p.z()});
    }
  cutter.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}};
  for (std::uint32_t k = 0; k < 4; ++k) {
    const std::uint32_t l = (k + 1) % 4;
    cutter.triangles.push_back({k, 4 + k, 4 + l});
    cutter.triangles.push_back({k, 4 + l, l});
  }
  return cutter;
}

}  // namespace meniscus
