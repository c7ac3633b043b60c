// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/state/drop.h"

#include "meniscus/core/error.h"

#include <CGAL/boost/graph/helpers.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

void check_closed_and_finite(const Mesh& mesh) {
  if (mesh.number_of_faces() == 0) throw GeometryError("the mesh is empty: a drop needs at least four faces");
  for (const auto f : mesh.faces())
    if (mesh.next(mesh.next(mesh.next(mesh.halfedge(f)))) != mesh.halfedge(f))
      throw GeometryError(fmt::format("face {} is not a triangle; triangulate the mesh first", std::size_t{f}), {f});
  for (const auto h : mesh.halfedges())
    if (mesh.is_border(h))
      throw GeometryError(fmt::format("the mesh is open at edge {}-{}; a drop must be closed: fill its holes first",
                                      std::size_t{mesh.source(h)}, std::size_t{mesh.target(h)}),
                          {}, {mesh.source(h), mesh.target(h)});
  for (const auto v : mesh.vertices()) {
    const Point& p = mesh.point(v);
    if (!std::isfinite(p.x()) || !std::isfinite(p.y()) || !std::isfinite(p.z()))
      throw GeometryError(fmt::format("vertex {} has a coordinate that is not a finite number", std::size_t{v}), {},
                          {v});
    if (mesh.is_isolated(v))
      throw GeometryError(fmt::format("vertex {} belongs to no face; remove it", std::size_t{v}), {}, {v});
  }
}

}  // namespace

Drop::Drop(Mesh mesh) : mesh_(std::move(mesh)) {
  check_closed_and_finite(mesh_);
  if (mesh_.has_garbage()) mesh_.collect_garbage();
  bind();
  connectivity_.rebuild(mesh_);
  target_volume_ = volume();
  if (!std::isfinite(target_volume_) || target_volume_ == 0)
    throw GeometryError("the volume of the mesh is beyond double precision, or none; scale its coordinates");
  if (!(target_volume_ > 0))
    throw GeometryError(
        fmt::format("the mesh encloses {} cm^3: its faces point inward; reverse their orientation", target_volume_));
}

Drop Drop::restored(Mesh mesh, const std::vector<std::uint32_t>& ring_starts) {
  check_closed_and_finite(mesh);
  if (ring_starts.size() != mesh.num_vertices())
    throw GeometryError(fmt::format("{} starts of rings for {} vertices", ring_starts.size(), mesh.num_vertices()));
  Drop drop;
  drop.mesh_ = std::move(mesh);
  drop.bind();
  std::vector<std::string> maps = drop.mesh_.properties<VertexIndex>();
  std::sort(maps.begin(), maps.end());
  if (const auto twice = std::adjacent_find(maps.begin(), maps.end()); twice != maps.end())
    throw GeometryError(fmt::format("vertex map {} is of another type than a drop's", *twice));
  drop.connectivity_.rebuild(drop.mesh_);
  for (const auto v : drop.mesh_.vertices()) drop.connectivity_.start_ring_at(v, ring_starts[v]);
  return drop;
}

Drop::Drop(const Drop& other)
    : mesh_(other.mesh_),
      connectivity_(other.connectivity_),
      target_volume_(other.target_volume_),
      topology_version_(other.topology_version_),
      flow_version_(other.flow_version_),
      rest_time_(other.rest_time_),
      inflow_(other.inflow_),
      slack_(other.slack_),
      id_(other.id_),
      stuck_substeps_(other.stuck_substeps_) {
  bind();
}

Drop& Drop::operator=(const Drop& other) {
  if (this != &other) *this = Drop(other);
  return *this;
}

void Drop::bind() {
  velocity_ = mesh_.add_property_map<VertexIndex, Vector>("v:velocity", Vector(0, 0, 0)).first;
  displacement_ = mesh_.add_property_map<VertexIndex, Vector>("v:displacement", Vector(0, 0, 0)).first;
  contact_normal_ = mesh_.add_property_map<VertexIndex, Vector>("v:contact_normal", Vector(0, 0, 0)).first;
  contact_ = mesh_.add_property_map<VertexIndex, Contact>("v:contact_state", Contact::free).first;
  contact_solid_ = mesh_.add_property_map<VertexIndex, std::int32_t>("v:contact_solid", -1).first;
  seam_watch_ = mesh_.add_property_map<VertexIndex, std::uint8_t>("v:seam_watch", 0).first;
  poor_quality_ = mesh_.add_property_map<VertexIndex, std::uint8_t>("v:poor_quality", 0).first;
  line_status_ = mesh_.add_property_map<VertexIndex, std::uint8_t>("v:line_status", 0).first;
}

bool Drop::collect_garbage(double share) {
  const auto removed = mesh_.num_vertices() - mesh_.number_of_vertices();
  if (removed == 0 || removed < share * mesh_.num_vertices()) return false;
  mesh_.collect_garbage();
  connectivity_.rebuild(mesh_);
  topology_changed();
  return true;
}

Eigen::AlignedBox3d bounding_box(const Drop& drop) {
  const ConstColumns x = drop.positions();
  const std::uint16_t* const degree = drop.connectivity().degrees();
  Eigen::AlignedBox3d box;
  // Four points are three registers of four numbers.
  using Twelve = Eigen::Array<double, 12, 1>;
  Twelve least = box.min().replicate<4, 1>(), most = box.max().replicate<4, 1>();
  const Eigen::Index n = x.cols();
  for (Eigen::Index first = 0; first < n; first += 4) {
    const std::uint16_t* const d = degree + first;
    if (first + 4 <= n && d[0] != 0 && d[1] != 0 && d[2] != 0 && d[3] != 0) {
      const Eigen::Map<const Twelve> points(x.data() + 3 * first);
      least = least.min(points);
      most = most.max(points);
    } else {
      for (Eigen::Index i = first; i < std::min(first + 4, n); ++i)
        if (degree[i] != 0) box.extend(Eigen::Vector3d(x.col(i)));
    }
  }
  for (Eigen::Index k = 0; k < 4; ++k)
    box.extend(Eigen::AlignedBox3d(Eigen::Vector3d(least.segment<3>(3 * k)), Eigen::Vector3d(most.segment<3>(3 * k))));
  return box;
}

bool touches_solid(const Drop& drop) {
  return std::any_of(drop.contact(), drop.contact() + drop.num_rows(), is_colliding);
}

Eigen::Vector3d mean_over_vertices(const Drop& drop, const ConstColumns& columns) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i) {
    if (drop.connectivity().degree(i) == 0) continue;
    sum += columns.col(i);
    ++count;
  }
  return count > 0 ? Eigen::Vector3d(sum / static_cast<double>(count)) : sum;
}

double top_speed(const Drop& drop, const Eigen::Vector3d& frame) {
  const ConstColumns u = drop.velocities();
  double squared = 0;
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i)
    if (drop.connectivity().degree(i) > 0) squared = std::max(squared, (u.col(i) - frame).squaredNorm());
  return std::sqrt(squared);
}

bool hangs_from(const Drop& drop, std::int32_t solid) {
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i)
    if (is_colliding(drop.contact()[i]) && drop.contact_solid()[i] == solid && drop.connectivity().degree(i) > 0)
      return true;
  return false;
}

}  // namespace meniscus
