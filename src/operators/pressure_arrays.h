// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/operators/pressure.h"

#include <Eigen/Geometry>

/// What the parts of the level `pressure` share. Row i of every array is vertex i, removed ones included.
namespace meniscus {

/// What a vertex is to the level `pressure`.
enum class Role : std::uint8_t {
  absent,    ///< removed
  free,      ///< on the water-air surface
  touching,  ///< the same, but on a solid and without a wetted face: it must not move into the solid
  line,      ///< on the contact line
  pinned,    ///< on a contact line that meets itself there, or without a direction: it stands still
  wetted,    ///< inside the wetted area
};

inline bool is_on_surface(Role role) { return role == Role::free || role == Role::touching; }
/// Has a speed of its own.
inline bool is_moving(Role role) { return is_on_surface(role) || role == Role::line; }

/// The drop's surface at the start of a substep. Speeds count along the normal: a vertex of speed q moves
/// by q direction, and the whole by U where q = form . U.
struct PressureSurface {
  std::vector<std::uint8_t> wet_face;  ///< by face: 1 on a solid
  std::vector<Role> role;
  std::vector<Eigen::Vector3d> direction;  ///< d, the way of a unit speed: the normal n, or m/s along the solid
  std::vector<Eigen::Vector3d> form;       ///< g: n, or s m; in coordinates of `rigid`
  std::vector<Eigen::Vector3d> moment;     ///< w (x - center) in coordinates of `rigid`, cm^3
  std::vector<double> volume_gradient;     ///< w = (dV/dx) . d, cm^2
  std::vector<double> mass;                ///< W = max(w, 0.3 of the lumped air area), cm^2
  std::vector<double> slant;               ///< s = max(m . n, 0.3) on the line, 1 elsewhere
  std::vector<double> wet_gradient;        ///< l = (dA_wet/dx) . d on the line, cm; 0 elsewhere
  std::vector<double> force;               ///< -d . d(sigma A_air + gravity)/dx, without the wetted area's part
  std::vector<double> head;                ///< the potential of gravity and rotation, g/(cm s^2)
  RingMatrix stiffness;                    ///< L of the air faces: diagonal and weights, no mass

  double air_area = 0, wet_area = 0;                      ///< cm^2
  double volume = 0;                                      ///< cm^3
  Eigen::Vector3d center = Eigen::Vector3d::Zero();       ///< of mass, cm
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();     ///< of a drop in flight, rad/s
  Eigen::Vector3d frame = Eigen::Vector3d::Zero();        ///< velocity of the solids that it sits on, cm/s
  Eigen::Vector3d wall_normal = Eigen::Vector3d::Zero();  ///< mean over the wetted area, out of the solid
  Eigen::Matrix3d rigid = Eigen::Matrix3d::Identity();    ///< columns: unit directions it can move in as a whole
  int rigid_directions = 3;                               ///< how many of them; the other columns are zero
  bool in_contact = false;                                ///< has a wetted face
};

struct PressureArrays {
  PressureSurface surface;
  std::vector<double> speed_old, speed, rhs_without_line, rhs, friction, inverse_diagonal;
  std::vector<double> residual, preconditioned, search, product, deformation;
  std::vector<std::uint8_t> fixed, blocked, status_before;
  std::vector<Eigen::Vector3d> shift;  ///< ends of a move; then by how much even_out moved each vertex, cm
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< U of the solution, in coordinates of `rigid`
};

/// The arrays of a drop, made at first use.
PressureArrays& pressure_arrays(Drop& drop);

/// Fills arrays.surface but for forces, and speed_old from the velocities.
void look_at_surface(Drop& drop, const std::vector<Solid>& solids, double time, PressureArrays& arrays);
/// Fills surface.force: tension, gravity and rotation; in flight the drop as a whole falls by gravity exactly.
void find_forces(const Drop& drop, const PressureOptions& options, PressureSurface& surface);

/// The drop's volume and centre of mass.
void measure_solid(const ConstColumns& x, const Connectivity& connectivity, PressureSurface& surface);
/// The rotation whose field, with a translation, is nearest to the velocities along the surface: of a
/// velocity U + rotation x r + u n it is the exact rotation, whatever u.
Eigen::Vector3d tangential_rotation(const Drop& drop, const Eigen::Vector3d& center);
/// Its inertia, over the density (cm^5).
Eigen::Matrix3d inertia_about(const Eigen::Vector3d& center, const ConstColumns& x, const Connectivity& connectivity);

/// M q = (rho R/2)(W + stiffening L) q for the deformation, the liquid's own mass for motion as a whole,
/// and friction on the line. Symmetric positive definite.
struct PressureMass {
  const Connectivity& connectivity;
  const PressureSurface& surface;
  double density, inertia;              ///< rho; rho R/2
  double stiffening;                    ///< cm^2
  const std::vector<double>* friction;  ///< dt xi l/s by vertex, or none

  /// U of speeds q: sum of moment q over the volume.
  Eigen::Vector3d translation(const std::vector<double>& q) const;
  /// y = M q; `deformation` is scratch.
  void multiply(const std::vector<double>& q, std::vector<double>& y, std::vector<double>& deformation) const;
  /// The same where U = translation(q) is known.
  void multiply(const std::vector<double>& q, const Eigen::Vector3d& U, std::vector<double>& y,
                std::vector<double>& deformation) const;
  /// Of the diagonal; 1 for rows that take no part.
  void inverse_diagonal(std::vector<double>& inverse) const;
};

struct ConstrainedSolve {
  int iterations = 0;
  bool converged = true;
  double pressure = 0;  ///< the multiplier of the volume, times dt
};
/// Solves M q = rhs - pressure w for arrays.speed, subject to w . q = flux and q = 0 where fixed, from
/// what arrays.speed holds, by conjugate gradients with the diagonal projected on the constraint.
ConstrainedSolve solve_constrained(const PressureMass& mass, double flux, const PressureOptions& options,
                                   PressureArrays& arrays);

/// The line's part of the right-hand side and which rows are fixed, by the status of each line vertex.
void apply_line(const Drop& drop, const std::vector<Solid>& solids, double dt, double tension, PressureArrays& arrays);
/// Vertices that stick although their reaction is too large start to slip; ones that slip the wrong way
/// stick. `product` must hold M q. Returns how many changed.
std::size_t update_line(Drop& drop, const std::vector<Solid>& solids, double dt, double tension, double pressure,
                        PressureArrays& arrays);
/// Touching vertices that would move into their solid are blocked. Returns how many more than before.
std::size_t block_touching(const Drop& drop, PressureArrays& arrays);

/// Moves each vertex options.smoothing of the way along the surface to its ring's centroid (line vertices along the
/// line, sharp turns of the line half way to straight, whatever the share), with the deformation carried along, and
/// offsets the free surface along its normals by what the drop lacks of its volume, within bounds. The normals, which
/// it computes anew, are those before that.
void even_out(Drop& drop, const PressureOptions& options, PressureArrays& arrays);

}  // namespace meniscus
