// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/mesh_data.h"

#include <functional>
#include <string>
#include <vector>

/// Meshes as binary glTF 2.0. glTF is in metres with y up: the node "drops" turns and scales our cm with z up.
/// Positions and velocities stay in cm and cm/s, as float32; the material is clear, with water's index of refraction.
namespace meniscus {

/// One mesh, with normals, _VELOCITY (cm/s), _DROP and _CONTACT where the mesh has them.
std::string glb_still(const MeshData& data);

/// Frames as an animation: frame k, a node of its own, is shown (scale 1, else 0) from times[k] (s) to times[k + 1].
/// Positions and normals only; triangles that equal the frame before's are stored once.
/// `read` gives frame k. Throws FileError, naming `name`, if there would be 4 GiB or more.
std::string glb_flipbook(const std::vector<double>& times, const std::function<MeshData(std::size_t)>& read,
                         const std::string& name);

}  // namespace meniscus
