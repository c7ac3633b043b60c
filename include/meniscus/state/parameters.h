// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// The words of a scene that both its reader and the operators understand. cm, g, s; radians.
namespace meniscus {

/// The liquid; the defaults are water.
struct Liquid {
  double density = 1;           ///< rho, g/cm^3, > 0
  double surface_tension = 72;  ///< sigma, g/s^2, >= 0
  double viscosity = 0.01;      ///< nu, kinematic, cm^2/s, >= 0
};

/// How closely the motion follows physics (docs/MODELS.md).
enum class Level {
  paper,       ///< as the paper writes it, with the least change that makes it stable
  calibrated,  ///< the same operators, with coefficients from the liquid: the same motion at any time step
  pressure,    ///< forces from one energy, Newton's motion of the whole, a sticking contact line
};

/// The paper's own coefficients, read by Level::paper only.
struct PaperCoefficients {
  double curvature_flow_coefficient = 0.2;  ///< gamma, cm^2/s (Eq 4)
  double damping_rate = 0.4;                ///< mu, 1/s (Eq 3)
  double viscosity_coefficient = 0.05;      ///< eta, cm^2/s (Eq 3)
  double boundary_force = 1.0;              ///< alpha, cm/s of contact line speed per radian and step (Eq 8)
};

/// Which volume correction runs (Section 4.4 of the paper).
enum class VolumeCorrectionMethod { none, local, global, local_then_global };

/// The band that remeshing keeps edge lengths in (Section 5 of the paper).
struct EdgeBand {
  double edge_min = 0.04;      ///< cm, > 0
  double edge_max = 0.12;      ///< cm, > 2 edge_min
  double wetted_weight = 0.5;  ///< factor on the length of an edge inside the wetted area, in (0, 1]
  double refinement = 1;       ///< how many times shorter edges may be where the free surface curves, >= 1
};

}  // namespace meniscus
