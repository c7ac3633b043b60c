// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/core/error.h"
#include "meniscus/geometry/self_intersection.h"
#include "meniscus/topology/remesh_isotropic.h"
#include "meniscus/topology/split.h"
#include "remesh_state.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

constexpr std::size_t most_pairs = 1000;

/// Where the surface meets itself: the middle of each face at fault.
struct Meetings {
  std::vector<Eigen::Vector3d> places;
  std::vector<std::size_t> faces;
};

Meetings meetings_of(const Mesh& mesh) {
  const MeshData data = to_mesh_data(mesh);
  Meetings meetings;
  for (const auto& pair : self_intersections(data, most_pairs))
    for (const auto f : pair) {
      Eigen::Vector3d middle = Eigen::Vector3d::Zero();
      for (const auto v : data.triangles[f]) middle += Eigen::Map<const Eigen::Vector3d>(data.points[v].data()) / 3;
      meetings.places.push_back(middle);
      meetings.faces.push_back(f);
    }
  return meetings;
}

/// Those that are not near one that was there before.
Meetings new_ones(const Meetings& found, const Meetings& before, double reach) {
  Meetings result;
  for (std::size_t i = 0; i < found.places.size(); ++i) {
    const bool is_old = std::any_of(before.places.begin(), before.places.end(),
                                    [&](const Eigen::Vector3d& p) { return (p - found.places[i]).norm() < reach; });
    if (is_old) continue;
    result.places.push_back(found.places[i]);
    result.faces.push_back(found.faces[i]);
  }
  return result;
}

void check_number_of_faces(const Drop& drop, const RemeshOptions& options) {
  const EdgeBand& band = options.band;
  double area = 0;
  const auto x = drop.positions();
  for (const auto& t : drop.connectivity().triangles())
    if (t[0] != Connectivity::removed)
      area += 0.5 * Eigen::Vector3d(x.col(t[1]) - x.col(t[0])).cross(Eigen::Vector3d(x.col(t[2]) - x.col(t[0]))).norm();
  const double faces = estimated_faces(area, 0.5 * (band.edge_min + band.edge_max));
  if (faces > options.max_faces)
    throw UsageError(
        fmt::format("edges of {} to {} cm on an area of {:.3g} cm^2 would need about {:.3g} faces (at most "
                    "{:.3g}); take longer edges",
                    band.edge_min, band.edge_max, area, faces, options.max_faces));
}

/// Takes out the tetrahedra and the components inside out that cuts left, if anything else is there.
std::size_t delete_specks(Drop& drop) {
  SplitReport split;
  const auto pieces = split_components(drop, split);
  const std::size_t deleted = split.deleted + split.deleted_empty;
  if (deleted == 0 || pieces.empty()) return 0;
  Mesh mesh = pieces[0].mesh();
  for (std::size_t k = 1; k < pieces.size(); ++k) mesh += pieces[k].mesh();
  Drop rest(std::move(mesh));
  rest.set_target_volume(drop.target_volume());
  rest.set_id(drop.id());
  drop = std::move(rest);
  return deleted;
}

}  // namespace

double estimated_faces(double area, double edge) { return area / (0.4330127018922193 * edge * edge); }

RemeshReport remesh_to_band(Drop& drop, const RemeshOptions& options, int max_retries) {
  check_options(options);
  check_number_of_faces(drop, options);
  const Drop kept = drop;
  Remesher::Scratch scratch;
  std::optional<Meetings> before;  // looked for only when the result meets itself
  for (int retry = 0;; ++retry) {
    RemeshReport report = remesh_with(scratch, drop, options);
    report.retries = retry;
    if (report.cuts > 0) report.deleted = delete_specks(drop);
    Meetings found = meetings_of(drop.mesh());
    if (!found.places.empty()) {
      if (!before) before = meetings_of(kept.mesh());
      found = new_ones(found, *before, 2 * options.band.edge_max);
    }
    if (found.places.empty()) return report;
    drop = kept;
    if (retry == max_retries)
      throw GeometryError(
          fmt::format("refused: the surface would meet itself at {} faces, first near ({:.4g}, {:.4g}, "
                      "{:.4g}), after {} attempts; take shorter edges, or cut the thin places first",
                      found.faces.size(), found.places[0].x(), found.places[0].y(), found.places[0].z(), retry + 1),
          found.faces);
    const double radius = options.band.edge_max * (1 + retry);
    for (const auto& place : found.places) scratch.forbidden.push_back({place, radius});
  }
}

}  // namespace meniscus
