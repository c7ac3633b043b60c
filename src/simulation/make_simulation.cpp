// SPDX-License-Identifier: GPL-3.0-or-later
#include "make_scatter.h"
#include "meniscus/core/error.h"
#include "meniscus/geometry/rigid_motion.h"
#include "meniscus/geometry/shapes.h"
#include "meniscus/io/read_mesh.h"
#include "meniscus/operators/external_forces.h"
#include "meniscus/simulation/simulation.h"
#include "place_cap.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <cmath>

namespace meniscus {
namespace {

using Eigen::Vector3d;

constexpr const char* velocity_names[] = {"vx", "vy", "vz"};

Eigen::Matrix3d rotation_matrix(const Vector3d& angles) {
  return (Eigen::AngleAxisd(angles.z(), Vector3d::UnitZ()) * Eigen::AngleAxisd(angles.y(), Vector3d::UnitY()) *
          Eigen::AngleAxisd(angles.x(), Vector3d::UnitX()))
      .toRotationMatrix();
}

/// Rotates a mesh about a point.
void rotate(Mesh& mesh, const Vector3d& angles, const Vector3d& center) {
  if (angles.isZero(0)) return;
  const Eigen::Matrix3d rotation = rotation_matrix(angles);
  Columns x = positions(mesh);
  for (Eigen::Index i = 0; i < x.cols(); ++i) x.col(i) = center + rotation * (x.col(i) - center);
}

/// Scales and rotates about the origin, then translates; velocities that the mesh brings turn along.
void place(MeshData& data, double scale, const Vector3d& angles, const Vector3d& translation) {
  const Eigen::Matrix3d rotation = rotation_matrix(angles);
  for (auto& point : data.points) {
    const Eigen::Map<Vector3d> p(point.data());
    Eigen::Map<Vector3d>(point.data()) = Vector3d(rotation * (scale * p) + translation);
  }
  VertexAttribute* component[3] = {};
  for (auto& attribute : data.attributes)
    for (int k = 0; k < 3; ++k)
      if (attribute.name == velocity_names[k]) component[k] = &attribute;
  if (!component[0] || !component[1] || !component[2] || angles.isZero(0)) return;
  for (std::size_t v = 0; v < data.points.size(); ++v) {
    const Vector3d turned =
        rotation * Vector3d(component[0]->values[v], component[1]->values[v], component[2]->values[v]);
    for (int k = 0; k < 3; ++k) component[k]->values[v] = turned[k];
  }
}

void check_coordinates(const MeshData& data) {
  for (std::size_t v = 0; v < data.points.size(); ++v)
    for (const double x : data.points[v])
      if (!(std::abs(x) <= largest_magnitude))
        throw GeometryError(fmt::format("vertex {} is at {:g} cm; scenes end at {:g} cm", v, x, largest_magnitude), {},
                            {v});
}

/// A triangle mesh that a scene names, placed as it says.
template <class Spec>
MeshData read_placed_mesh(const Scene& scene, const Spec& spec) {
  MeshData data = read_mesh(scene.locate(spec.file));
  check_coordinates(data);
  place(data, spec.scale, spec.rotation, spec.translation);
  return data;
}

const char* shape_name(DropShape shape) {
  constexpr const char* names[] = {"sphere", "ellipsoid", "box", "cap", "scatter", "mesh"};
  return names[static_cast<std::size_t>(shape)];
}

/// The solid that a cap sits on: the reader has checked that it is there.
const Solid& seat_of(const std::vector<Solid>& solids, const DropSpec& spec) {
  for (const Solid& solid : solids)
    if (solid.name == spec.on) return solid;
  throw UsageError(fmt::format("a cap sits on \"{}\", but no solid has that name", spec.on));
}

Mesh make_cap_on(const Solid& solid, const DropSpec& spec, double edge_length) {
  const double angle = spec.angle.value_or(resting_angle(solid));
  std::optional<Mesh> cap = place_cap(solid, spec.center, spec.radius, angle, edge_length);
  if (!cap)
    throw GeometryError(fmt::format(
        "\"{}\" bends or ends too near for a cap of this size; make it smaller or move its center", spec.on));
  return std::move(*cap);
}

/// The mesh of one drop that is given by its shape.
Mesh make_shape(const Scene& scene, const DropSpec& spec, const std::vector<Solid>& solids) {
  const double edge_length = 0.5 * (scene.mesh.edge_min + scene.mesh.edge_max);
  Mesh mesh;
  switch (spec.shape) {
    case DropShape::sphere:
      return make_sphere(spec.center, spec.radius, edge_length);
    case DropShape::cap:
      return make_cap_on(seat_of(solids, spec), spec, edge_length);
    case DropShape::ellipsoid:
      mesh = make_ellipsoid(spec.center, spec.semi_axes, edge_length);
      break;
    case DropShape::box:
      mesh = make_box(spec.center, spec.size, edge_length);
      break;
    case DropShape::scatter:
    case DropShape::mesh:
      throw UsageError("a mesh file or a scatter is no shape");  // make_drops_of makes them
  }
  rotate(mesh, spec.rotation, spec.center);
  return mesh;
}

/// A drop that has to be deleted at once is none.
void check_size(const Drop& drop, const EdgeBand& band) {
  const double least = std::pow(band.edge_min, 3) / std::sqrt(72.0);
  if (drop.volume() < least)
    throw GeometryError(
        fmt::format("it holds {:.3g} cm^3, less than one tetrahedron of edges of edge_min {} cm ({:.3g} "
                    "cm^3); lower mesh.edge_min and mesh.edge_max, or make the drop larger",
                    drop.volume(), band.edge_min, least));
}

/// Adds the velocity and the rotation about the centre of mass that the scene gives.
void set_in_motion(Drop& drop, const DropSpec& spec) {
  drop.workspace().geometry.compute(std::as_const(drop).positions(), drop.connectivity());
  Columns x = drop.positions(), v = drop.velocities();
  const Vector3d center = fit_rigid_motion(x, v, drop.workspace().geometry).center;
  for (Eigen::Index i = 0; i < v.cols(); ++i)
    v.col(i) += spec.velocity + spec.angular_velocity.cross(Vector3d(x.col(i)) - center);
}

/// `taken` grows by the balls of the drops.
std::vector<Drop> make_drops_of(const Scene& scene, const DropSpec& spec, const std::vector<Solid>& solids,
                                std::vector<BoundingBall>& taken) {
  std::vector<Drop> drops;
  if (spec.shape == DropShape::scatter) {
    for (Mesh& mesh : make_scatter(scene, spec, solids, taken)) drops.emplace_back(std::move(mesh));
    return drops;
  }
  if (spec.shape == DropShape::mesh)
    drops = to_drops(read_placed_mesh(scene, spec));
  else
    drops.emplace_back(make_shape(scene, spec, solids));
  for (const Drop& drop : drops) taken.push_back(bounding_ball(drop.mesh()));
  return drops;
}

/// Edges are rounded just enough for the mesh to feel them.
double edge_radius(const Scene& scene, const SolidSpec& spec) { return spec.edge_radius.value_or(scene.mesh.edge_min); }

Solid make_source(const SourceSpec& spec) {
  Solid solid = Solid::disc(spec.center, spec.normal, spec.radius);
  solid.inflow = Inflow{spec.speed, spec.center, spec.radius, spec.start, spec.stop};
  return solid;
}

Solid make_shape(const Scene& scene, const SolidSpec& spec) {
  switch (spec.shape) {
    case SolidShape::plane:
      return Solid::plane(spec.point, spec.normal);
    case SolidShape::sphere:
      return Solid::sphere(spec.center, spec.radius);
    case SolidShape::box:
      return Solid::box(spec.center, spec.size, rotation_matrix(spec.rotation), edge_radius(scene, spec));
    case SolidShape::cylinder:
      return Solid::cylinder(spec.from, spec.to, spec.radius, edge_radius(scene, spec));
    case SolidShape::capsule:
      return Solid::capsule(spec.from, spec.to, spec.radius);
    case SolidShape::mesh:
      break;
  }
  return Solid::mesh(read_placed_mesh(scene, spec));
}

/// What to call solid s in a message.
std::string label(const Scene& scene, std::size_t s) {
  const SolidSpec& spec = scene.solids[s];
  const std::string name = spec.name.empty() ? std::string() : fmt::format(" \"{}\"", spec.name);
  const std::string file =
      spec.shape == SolidShape::mesh ? fmt::format(" ({})", scene.locate(spec.file).string()) : std::string();
  return fmt::format("solid {}{}{}", s, name, file);
}

/// What to call drop d.
std::string label(const Scene& scene, const DropSpec& spec, std::size_t d) {
  return fmt::format("drop {} ({})", d,
                     spec.shape == DropShape::mesh ? scene.locate(spec.file).string() : shape_name(spec.shape));
}

}  // namespace

std::vector<Solid> make_solids(const Scene& scene) {
  std::vector<Solid> solids;
  for (std::size_t s = 0; s < scene.solids.size(); ++s) {
    const SolidSpec& spec = scene.solids[s];
    try {
      Solid solid = make_shape(scene, spec);
      solid.name = spec.name;
      solid.advancing_angle = spec.advancing_angle;
      solid.receding_angle = spec.receding_angle;
      solid.friction_speed = spec.friction_speed;
      solid.set_velocity(spec.velocity);
      std::vector<Solid::Key> keys;
      for (const PositionKey& key : spec.keys) keys.push_back({key.time, key.position});
      if (!keys.empty()) solid.set_keys(std::move(keys));
      solids.push_back(std::move(solid));
    } catch (const GeometryError& error) {
      throw GeometryError(fmt::format("{}: {}", label(scene, s), error.what()), error.faces(), error.vertices());
    }
  }
  for (const SourceSpec& source : scene.sources) solids.push_back(make_source(source));
  return solids;
}

std::vector<Drop> make_drops(const Scene& scene, const std::vector<Solid>& solids) {
  std::vector<Drop> drops;
  std::vector<BoundingBall> taken;
  for (std::size_t d = 0; d < scene.drops.size(); ++d) {
    const DropSpec& spec = scene.drops[d];
    try {
      for (Drop& drop : make_drops_of(scene, spec, solids, taken)) {
        check_size(drop, scene.mesh);
        set_in_motion(drop, spec);
        find_contact(drop, solids, 0, contact_tolerance);
        drop.set_id(static_cast<int>(drops.size()));
        drops.push_back(std::move(drop));
      }
    } catch (const GeometryError& error) {
      throw GeometryError(fmt::format("{}: {}", label(scene, spec, d), error.what()), error.faces(), error.vertices());
    } catch (const UsageError& error) {
      throw UsageError(fmt::format("{}: {}", label(scene, spec, d), error.what()));
    }
  }
  return drops;
}

StepOptions make_step_options(const Scene& scene) {
  StepOptions options;
  options.level = scene.model;
  options.gravity = scene.gravity;
  options.liquid = scene.liquid;
  options.paper = scene.paper;
  options.volume_correction = scene.volume_correction;
  options.band = scene.mesh;
  options.split = scene.topology.split;
  options.merge = scene.topology.merge;
  options.self_merge = scene.topology.self_merge;
  options.keep_air = scene.topology.keep_air;
  options.solver = scene.solver;
#ifndef NDEBUG
  options.verify = Verify::topology;
#endif
  return options;
}

}  // namespace meniscus
