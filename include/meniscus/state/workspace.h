// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/geometry/solve_spd.h"
#include "meniscus/geometry/surface_geometry.h"
#include "meniscus/state/contact.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace meniscus {

class Drop;
struct PressureArrays;  ///< of operators/pressure.h

/// What operators write of a drop, kept so that a bad substep can be taken back, but for the last displacements, which
/// restore() sets to zero. Operators never change elements, so flat copies do. Allocates nothing for a drop of no more
/// rows than it has held.
class KeptState {
 public:
  void keep(Drop& drop);
  /// Precondition: the drop's elements are those of the last keep().
  void restore(Drop& drop) const;
  ConstColumns positions() const { return {positions_.data(), rows_}; }
  /// The same precondition. Whether no vertex has touched or left a solid since.
  bool has_contact_of(const Drop& drop) const;
  /// The same precondition. How far (cm) some vertex has moved since, at most; infinite if that is more than `limit`.
  double moved(const Drop& drop, double limit) const;

 private:
  Eigen::Index rows_ = 0;
  std::vector<double> positions_, velocities_, contact_normals_;  ///< three a row
  std::vector<Contact> contact_;
  std::vector<std::int32_t> contact_solid_;
  std::vector<std::uint8_t> line_status_;
  double target_volume_ = 0;
  bool touched_ = false;  ///< a solid; what belongs to contact is kept only then
};

/// The arrays that operators need within a step, kept so that an unchanged mesh allocates nothing. What comes out of
/// a step does not depend on what is in them at its start.
struct Workspace {
  SurfaceGeometry geometry;
  RingMatrix matrix;
  SpdSolver solver;
  std::vector<Lanes> rhs, solution;
  std::vector<Eigen::Vector3d> vectors;
  std::vector<double> scalars, more_scalars;
  std::vector<std::uint8_t> fixed;
  std::vector<std::uint32_t> line;  ///< vertices of the contact line
  std::vector<std::uint8_t> films;  ///< by vertex, of the last lift_films: 1 in a film too thin to show; empty if none
  KeptState kept;                   ///< at the start of the substep
  std::vector<std::uint8_t> violent_faces;   ///< by face, of the last FaceChanges
  std::shared_ptr<PressureArrays> pressure;  ///< made at first use
};

}  // namespace meniscus
