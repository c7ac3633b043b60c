// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/drop.h"

#include <optional>
#include <string>

namespace meniscus {

/// What a frame's table says of one drop. cm, g, s; radians. The drop is a closed mesh; removed
/// elements do not count.
struct DropMeasures {
  int drop = 0;  ///< its id
  double volume = 0;
  double target_volume = 0;
  double area = 0;         ///< of the whole surface
  double wetted_area = 0;  ///< of the faces whose corners are all on a solid and that face into it
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  ///< of the volume
  Eigen::Vector3d momentum = Eigen::Vector3d::Zero();  ///< g cm/s: see surface_momentum
  std::optional<double> mean_contact_angle;            ///< nothing without a contact line
  std::size_t triangles = 0;
  double edge_min = 0, edge_mean = 0, edge_max = 0;  ///< lengths; zero for a drop without edges
  double least_angle = 0;                            ///< of any corner
};

/// Measures one drop; `density` is the liquid's, g/cm^3.
DropMeasures measure_drop(const Drop& drop, double density);

/// The first line of measures.csv, with its line end: the columns' names.
std::string measures_header();

/// One drop's line of measures.csv, with its line end: 17 significant digits, angles in degrees, an
/// empty field where there is nothing to tell.
std::string measures_row(double time, const DropMeasures& measures);

}  // namespace meniscus
