// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/mesh_data.h"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace meniscus {

/// A mesh as VTK XML PolyData: float64 points; vx, vy, vz as one vector "velocity", the active one; the other
/// attributes with their types; TimeValue (s) as field data. Arrays are inline base64.
std::string vtp_bytes(const MeshData& data, double time);

/// A ParaView collection: the files, relative to it, with their times (s).
std::string pvd_text(const std::vector<std::pair<double, std::string>>& files);

}  // namespace meniscus
