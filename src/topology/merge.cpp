// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/topology/merge.h"

#include "attribute_maps.h"
#include "boolean_parts.h"
#include "fold_finder.h"
#include "meniscus/state/contact_line.h"
#include "meniscus/state/ledger.h"
#include "meniscus/topology/split.h"
#include "merge_parts.h"
#include "watched_region.h"
#include "zip_seams.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A plane that both drops wet.
struct SharedPlane {
  Vector3d normal;
  double offset;  ///< normal . x, cm
};

/// The plane of all colliding vertices, if both drops have some and they lie on one plane.
std::optional<SharedPlane> shared_plane(const Drop& a, const Drop& b) {
  constexpr double same_direction = 1e-9, same_offset = 1e-7;  // in lengths of the cube root of the volume
  std::optional<SharedPlane> plane;
  for (const Drop* drop : {&a, &b}) {
    bool touches = false;
    for (std::uint32_t i = 0; i < drop->num_rows(); ++i) {
      if (drop->connectivity().degree(i) == 0 || !is_colliding(drop->contact()[i])) continue;
      touches = true;
      const Vector3d n = drop->contact_normals().col(i), x = drop->positions().col(i);
      if (!plane) plane = SharedPlane{n, n.dot(x)};
      if ((n - plane->normal).norm() > same_direction ||
          std::abs(plane->normal.dot(x) - plane->offset) > same_offset * std::cbrt(drop->target_volume()))
        return std::nullopt;
    }
    if (!touches) return std::nullopt;
  }
  return plane;
}

/// A drop's points turned so that the plane is z = 0, with those on it exactly there, colliding or there but for
/// rounding: faces that both drops have on the plane are then coplanar not just up to rounding.
Eigen::Matrix3Xd flattened(const Drop& drop, const SharedPlane& plane, const Matrix3d& turn) {
  const double rounding = 1e-13 * (std::abs(plane.offset) + std::cbrt(drop.target_volume()));
  Eigen::Matrix3Xd x = turn * drop.positions();
  x.row(2).array() -= plane.offset;
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i) {
    if (drop.connectivity().degree(i) == 0) continue;
    if (is_colliding(drop.contact()[i]) || std::abs(x(2, i)) < rounding) x(2, i) = 0;
  }
  return x;
}

/// Row 2 is the normal; the identity if that is z.
Matrix3d turn_to_plane(const Vector3d& normal) {
  if (normal == Vector3d::UnitZ()) return Matrix3d::Identity();
  Matrix3d turn;
  turn.row(0) = normal.unitOrthogonal();
  turn.row(2) = normal;
  turn.row(1) = turn.row(2).cross(turn.row(0));
  return turn;
}

/// The faces of a result that are new, or have a corner where `flags` says so.
std::vector<FaceBox> faces_in_doubt(const BooleanResult& result, const std::vector<std::uint8_t>& flags) {
  const MeshView mesh = boolean_parts::view_of(result);
  std::vector<FaceBox> faces;
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    const auto& [i, j, k] = mesh.triangles[f];
    if (f >= result.whole_a + result.whole_b || (flags[i] | flags[j] | flags[k]) != 0)
      faces.push_back({box_of(mesh, mesh.triangles[f]), f});
  }
  return faces;
}

/// The union of drops on a plane, with the points of kept rows to the bit as they were. None if that makes it meet
/// itself.
std::optional<BooleanResult> unite_on(const SharedPlane& plane, const Drop& a, const Drop& b,
                                      const BooleanOptions& options) {
  const Matrix3d turn = turn_to_plane(plane.normal);
  const Eigen::Matrix3Xd xa = flattened(a, plane, turn), xb = flattened(b, plane, turn);
  BooleanResult result =
      boolean({{xa.data(), xa.cols()}, a.connectivity().triangles()},
              {{xb.data(), xb.cols()}, b.connectivity().triangles()}, BooleanOperation::unite, options);
  std::vector<std::uint8_t> is_on_plane;
  for (const auto& p : result.points) is_on_plane.push_back(p[2] == 0);
  const auto set = [&](std::size_t row, const Vector3d& x) { result.points[row] = {x[0], x[1], x[2]}; };
  std::size_t row = 0;
  for (const std::uint32_t v : result.kept_a) set(row++, a.positions().col(v));
  for (const std::uint32_t v : result.kept_b) set(row++, b.positions().col(v));
  for (; row < result.points.size(); ++row) {
    const auto& p = result.points[row];
    set(row, turn.transpose() * Vector3d(p[0], p[1], p[2] + plane.offset));
  }
  if (!faces_that_meet(boolean_parts::view_of(result), faces_in_doubt(result, is_on_plane)).empty())
    return std::nullopt;
  return result;
}

BooleanResult unite(const Drop& a, const Drop& b, const MergeOptions& options) {
  BooleanOptions boolean_options;
  boolean_options.inputs_are_sound = true;
  boolean_options.keep_cavities = options.keep_air;
  if (const std::optional<SharedPlane> plane = shared_plane(a, b))
    if (std::optional<BooleanResult> result = unite_on(*plane, a, b, boolean_options)) return *std::move(result);
  return boolean(view_of(a), view_of(b), BooleanOperation::unite, boolean_options);
}

Mesh mesh_of(const BooleanResult& result) {
  Mesh mesh;
  const auto n = static_cast<Mesh::size_type>(result.points.size());
  const auto f = static_cast<Mesh::size_type>(result.triangles.size());
  mesh.reserve(n, 3 * f / 2, f);
  for (const auto& p : result.points) mesh.add_vertex(Point(p[0], p[1], p[2]));
  for (const auto& [i, j, k] : result.triangles) mesh.add_face(VertexIndex(i), VertexIndex(j), VertexIndex(k));
  return mesh;
}

AttributeSource source_of(const SurfacePoint& point) {
  const auto& [i, j, k] = point.corners;
  return {{VertexIndex(i), VertexIndex(j), VertexIndex(k)}, point.weights};
}

/// Gives the united mesh the vertex maps of both: seam vertices the mean of what each drop has there.
void carry_attributes(const Drop& a, const Drop& b, const BooleanResult& result, Mesh& mesh) {
  std::vector<AttributeSource> from_a, from_b;
  for (const std::uint32_t v : result.kept_a) from_a.push_back(same_as(VertexIndex(v)));
  for (const std::uint32_t v : result.kept_b) from_b.push_back(same_as(VertexIndex(v)));
  for (const SeamVertex& seam : result.seam) from_b.push_back(source_of(seam.on_b));
  gather_attributes(a.mesh(), mesh, from_a, 0);
  gather_attributes(b.mesh(), mesh, from_b, from_a.size());
  from_a.clear();
  for (const SeamVertex& seam : result.seam) from_a.push_back(source_of(seam.on_a));
  blend_attributes(a.mesh(), mesh, from_a, result.first_seam_row());
}

/// A point of a face that lies on a solid is on it.
bool is_on_solid(const Drop& drop, const SurfacePoint& point) {
  for (int k = 0; k < 3; ++k)
    if (point.weights[k] != 0 && !is_colliding(drop.contact()[point.corners[k]])) return false;
  return true;
}

/// By row: whether it is on a solid.
std::vector<std::uint8_t> rows_on_solids(const Drop& a, const Drop& b, const BooleanResult& result) {
  std::vector<std::uint8_t> rows;
  for (const auto v : result.kept_a) rows.push_back(is_colliding(a.contact()[v]));
  for (const auto v : result.kept_b) rows.push_back(is_colliding(b.contact()[v]));
  for (const auto& seam : result.seam) rows.push_back(is_on_solid(a, seam.on_a) || is_on_solid(b, seam.on_b));
  return rows;
}

/// The contact state of seam vertices, from the faces that they lie on; then the line anew, since what was
/// line may now lie inside the common wetted area.
void find_contact_on_seam(const Drop& a, const Drop& b, const BooleanResult& result, Drop& united) {
  const auto first = static_cast<std::uint32_t>(result.first_seam_row());
  for (std::uint32_t k = 0; k < result.seam.size(); ++k) {
    const std::uint32_t row = first + k;
    united.contact()[row] = Contact::free;
    united.contact_solid()[row] = -1;
    const SeamVertex& seam = result.seam[k];
    for (const auto& [drop, point] : {std::pair(&a, &seam.on_a), std::pair(&b, &seam.on_b)}) {
      if (!is_on_solid(*drop, *point)) continue;
      const auto nearest = std::max_element(point->weights.begin(), point->weights.end()) - point->weights.begin();
      const std::uint32_t v = point->corners[nearest];
      united.contact()[row] = Contact::wetted;
      united.contact_solid()[row] = drop->contact_solid()[v];
      united.contact_normals().col(row) = drop->contact_normals().col(v);
    }
  }
  for (std::uint32_t i = 0; i < first; ++i)
    if (is_colliding(united.contact()[i])) united.contact()[i] = Contact::wetted;
  mark_contact_line(united);
}

/// The seam is a crease; remeshing keeps to it where it is sharper than this (radians), so that the sheets
/// beside it, which are close to each other, do not pass through each other.
constexpr double crease_angle = 0.7;

/// Beside a seam two sheets fly at each other. The liquid between them would stop them: the velocities of the seam
/// and of some rings around it become smooth.
void calm_seam(Drop& drop, const std::vector<std::uint32_t>& seam) {
  constexpr int rings = 3, rounds = 10;
  std::vector<std::uint32_t> zone;
  std::vector<std::uint8_t> is_in_zone(drop.num_rows(), 0);
  const auto add = [&](std::uint32_t v) {
    if (is_in_zone[v] != 0) return;
    is_in_zone[v] = 1;
    zone.push_back(v);
  };
  for (const auto v : seam) add(v);
  for (int k = 0; k < rings; ++k) {
    const std::size_t size = zone.size();
    for (std::size_t i = 0; i < size; ++i) {
      const Ring ring = drop.connectivity().ring(zone[i]);
      for (int n = 0; n < ring.degree; ++n) add(ring.neighbour[n]);
    }
  }
  Columns u = drop.velocities();
  Eigen::Matrix3Xd mean(3, static_cast<Eigen::Index>(zone.size()));
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < zone.size(); ++i) {
      const Ring ring = drop.connectivity().ring(zone[i]);
      Vector3d sum = u.col(zone[i]);
      for (int n = 0; n < ring.degree; ++n) sum += u.col(ring.neighbour[n]);
      mean.col(static_cast<Eigen::Index>(i)) = sum / (ring.degree + 1);
    }
    for (std::size_t i = 0; i < zone.size(); ++i) u.col(zone[i]) = mean.col(static_cast<Eigen::Index>(i));
  }
}

/// restore_ledger; without the volume where giving it back makes a surface meet itself beside the seam. Sheets that lie
/// on each other but for rounding do not even bear to be moved as they are: then it gives back momentum alone.
void give_back(std::vector<Drop>& pieces, const Ledger& ledger, const MergeOptions& options) {
  std::vector<std::array<Eigen::Matrix3Xd, 2>> start;  // positions and velocities: nothing else changes
  start.reserve(pieces.size());
  for (const Drop& piece : pieces) start.push_back({piece.positions(), piece.velocities()});
  const auto meets_itself = [&](const Drop& piece) {
    const WatchedRegion region = guarded_region(piece, options.remesh.band.edge_max);
    return !region.empty() && !faces_that_meet(view_of(piece), region.faces_of(piece)).empty();
  };
  for (const bool with_volume : {true, false}) {
    restore_ledger(pieces, ledger, with_volume);
    if (std::none_of(pieces.begin(), pieces.end(), meets_itself)) return;
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      pieces[k].positions() = start[k][0];
      if (with_volume) pieces[k].velocities() = start[k][1];
    }
  }
}

}  // namespace

void take_momentum(Ledger& ledger, const Ledger& after) {
  if (!(after.volume > 0)) return;
  const double share = ledger.volume / after.volume;
  const Vector3d spin = after.angular_momentum - after.center().cross(after.momentum);
  ledger.momentum = share * after.momentum;
  ledger.angular_momentum = ledger.center().cross(ledger.momentum) + share * spin;
}

std::vector<Drop> rebuild(const Drop& a, const Drop& b, BooleanResult result, Ledger ledger, Momentum momentum,
                          double target_volume, const MergeOptions& options, Remesher& remesher, MergeReport& report) {
  const double speck = least_volume(options.remesh.band.edge_min);
  boolean_parts::drop_specks(result, speck);
  std::vector<std::uint32_t> seam = zip_seams(result, rows_on_solids(a, b, result), options.remesh.band.edge_min);
  for (auto v = static_cast<std::uint32_t>(result.first_seam_row()); v < result.points.size(); ++v) seam.push_back(v);
  Mesh mesh = mesh_of(result);
  carry_attributes(a, b, result, mesh);
  Drop united(std::move(mesh));
  united.set_id(a.id());
  united.set_target_volume(target_volume);
  find_contact_on_seam(a, b, result, united);
  for (const auto v : seam) united.seam_watch()[v] = watched_calls;
  calm_seam(united, seam);

  RemeshOptions seam_options = options.remesh;
  if (!seam_options.feature_angle && !result.seam.empty()) seam_options.feature_angle = crease_angle;
  const RemeshReport remeshed = remesher.remesh(united, seam_options);
  std::vector<Drop> pieces;
  if (remeshed.cuts > 0) {
    SplitReport split;
    pieces = split_components(std::move(united), split, speck);
    report.cuts += remeshed.cuts;
    report.deleted += split.deleted + split.deleted_empty;
  } else {
    pieces.push_back(std::move(united));
  }
  if (pieces.size() > 1)
    for (Drop& piece : pieces) calm_torn_piece(piece);
  if (!pieces.empty()) pieces.front().set_inflow(a.inflow() + (&a == &b ? 0 : b.inflow()));
  if (momentum == Momentum::of_surface) {
    Ledger own;
    for (const Drop& piece : pieces) own += measure_ledger(piece);
    take_momentum(ledger, own);
  }
  give_back(pieces, ledger, options);
  return pieces;
}

MergeReport& MergeReport::operator+=(const MergeReport& other) {
  merges += other.merges;
  folds += other.folds;
  refused += other.refused;
  taken_back += other.taken_back;
  retries += other.retries;
  cuts += other.cuts;
  deleted += other.deleted;
  overlap += other.overlap;
  return *this;
}

std::optional<std::vector<Drop>> merge_drops(const Drop& a, const Drop& b, const MergeOptions& options,
                                             Remesher& remesher, MergeReport& report) {
  const BooleanResult result = unite(a, b, options);
  report.retries += static_cast<std::size_t>(result.retries);
  if (result.outcome == BooleanOutcome::disjoint) return std::nullopt;
  if (!result.ok()) {
    ++report.refused;
    return std::nullopt;
  }
  Ledger ledger = measure_ledger(a);
  ledger += measure_ledger(b);
  ++report.merges;
  report.overlap += ledger.volume - result.volume;
  return rebuild(a, b, result, ledger, Momentum::of_ledger, a.target_volume() + b.target_volume(), options, remesher,
                 report);
}

}  // namespace meniscus
