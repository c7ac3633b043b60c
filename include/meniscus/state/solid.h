// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/mesh_data.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace meniscus {

/// Where a solid is in respect to a point.
struct SolidContact {
  double distance;         ///< cm to the solid's surface; negative inside the solid
  Eigen::Vector3d point;   ///< the nearest point of the surface
  Eigen::Vector3d normal;  ///< the solid's outward unit normal there: the gradient of the distance
};

class TriangleMeshDistance;

/// What makes a disc a source: liquid that comes out of it along its normal.
struct Inflow {
  double speed = 0;            ///< cm/s, through the whole disc
  Eigen::Vector3d center;      ///< of the disc at offset 0, cm
  double radius = 0;           ///< of the disc, cm
  double start = 0, stop = 0;  ///< s
  /// The seconds of (from, to] in which it flows.
  double seconds_between(double from, double to) const {
    return std::max(0.0, std::min(to, stop) - std::max(from, start));
  }
  double speed_at(double time) const { return time > start && time <= stop ? speed : 0; }
};

/// A solid that drops touch: its shape, how it moves (translations only) and how liquid clings to it.
///
/// Where the nearest point or the normal is not unique, the choice is fixed: a face before others
/// by the order of axes (box), the side before the ends (cylinder), any one direction at the centre
/// (sphere) or on the axis (cylinder, capsule). At an edge or corner the normal points from the
/// nearest point to x, if x is outside. All queries are const and may run in parallel.
class Solid {
 public:
  /// A position of the solid, as an offset from where its shape says (cm), at a time (s).
  struct Key {
    double time;
    Eigen::Vector3d position;
  };

  // Shapes. They throw UsageError for numbers that are not finite, sizes that are not positive, a zero
  // normal and a cylinder or capsule without length.

  /// The half space on the other side of `normal` (any length > 0).
  static Solid plane(const Eigen::Vector3d& point, const Eigen::Vector3d& normal);
  static Solid sphere(const Eigen::Vector3d& center, double radius);
  /// `size` is that of the whole box; `rotation` turns it about its centre. Edges and corners are rounded by
  /// `edge_radius` (cm, >= 0, cut to half the least size), so that the normal turns with the surface there.
  static Solid box(const Eigen::Vector3d& center, const Eigen::Vector3d& size,
                   const Eigen::Matrix3d& rotation = Eigen::Matrix3d::Identity(), double edge_radius = 0);
  /// From a to b, with flat ends, whose rims are rounded likewise.
  static Solid cylinder(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius, double edge_radius = 0);
  /// From a to b, with half balls beyond both.
  static Solid capsule(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius);
  /// A mesh that bounds a volume (see Inspection); throws GeometryError otherwise. The sign is that
  /// of the angle-weighted normal of the nearest face, edge or vertex (Baerentzen and Aanaes 2005).
  static Solid mesh(const MeshData& data);
  /// The mouth of a source: liquid is on the side that `normal` (any length > 0) points to. What comes to the other
  /// side within a radius of the disc is inside it.
  static Solid disc(const Eigen::Vector3d& center, const Eigen::Vector3d& normal, double radius);

  /// Moves it at constant velocity (cm/s), from where its shape says at time 0.
  /// Throws UsageError if it is not finite.
  void set_velocity(const Eigen::Vector3d& velocity);
  /// Moves it along keys, straight between them, at rest before the first and after the last.
  /// Throws UsageError unless they are finite and times strictly increase. No keys: at rest.
  void set_keys(std::vector<Key> keys);

  /// The distance, nearest point and normal at x at a time (s).
  SolidContact query(const Eigen::Vector3d& x, double time) const;

  /// Its velocity (cm/s) at a time; at a key, that of the way to it.
  Eigen::Vector3d velocity(double time) const;

  /// Its offset from where its shape says (cm).
  Eigen::Vector3d offset(double time) const;

  /// Where the contact line of a source is held: the point of the disc's rim on the side of x if x is no further from
  /// the rim than the middle of a chord of two edges (cm) and in the disc's outer third, else (and for any other shape)
  /// the nearest point.
  Eigen::Vector3d rim_point(const Eigen::Vector3d& x, double time, double edge) const;

  bool is_plane() const { return std::holds_alternative<Plane>(shape_); }

  /// Whether anything in the box may be within `margin` (cm) of the solid or inside it: a fast test
  /// that misses nothing but rounding. An empty box is near nothing.
  bool is_near(const Eigen::AlignedBox3d& box, double time, double margin) const;
  /// The same for a point.
  bool is_near(const Eigen::Vector3d& x, double time, double margin) const;

  std::string name;                              ///< may be empty
  double advancing_angle = 1.57079632679489662;  ///< theta_a, radians, through the liquid
  double receding_angle = 1.57079632679489662;   ///< theta_r, radians, at most theta_a
  double friction_speed = 0.1;                   ///< epsilon of Eq 2, cm/s
  std::optional<Inflow> inflow;                  ///< of a source's disc

 private:
  struct Plane {
    Eigen::Vector3d point, normal;
  };
  struct Sphere {
    Eigen::Vector3d center;
    double radius;
  };
  struct Box {
    Eigen::Vector3d center, half_size;
    Eigen::Matrix3d rotation;  // from the box' axes to ours
    double edge_radius;
  };
  struct Cylinder {
    Eigen::Vector3d start, axis;  // unit
    double length, radius, edge_radius;
  };
  struct Disc {
    Eigen::Vector3d center, normal;
    double radius;
  };
  struct Capsule {
    Eigen::Vector3d start, axis;
    double length, radius;
  };
  struct TriangleMesh {
    std::shared_ptr<const TriangleMeshDistance> distance;
  };
  using Shape = std::variant<Plane, Sphere, Box, Cylinder, Capsule, TriangleMesh, Disc>;

  explicit Solid(Shape shape) : shape_(std::move(shape)) {}
  static SolidContact contact(const Plane& plane, const Eigen::Vector3d& x);
  static SolidContact contact(const Sphere& sphere, const Eigen::Vector3d& x);
  static SolidContact contact(const Box& box, const Eigen::Vector3d& x);
  static SolidContact contact(const Cylinder& cylinder, const Eigen::Vector3d& x);
  static SolidContact contact(const Capsule& capsule, const Eigen::Vector3d& x);
  static SolidContact contact(const TriangleMesh& mesh, const Eigen::Vector3d& x);
  static SolidContact contact(const Disc& disc, const Eigen::Vector3d& x);

  Shape shape_;
  Eigen::AlignedBox3d bounds_;  // at offset 0; empty for a plane
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
  std::vector<Key> keys_;
};

}  // namespace meniscus
