// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/drop.h"

#include <array>
#include <string>
#include <vector>

/// An independent judge of meshes: it reads points and triangles and shares no code with the operators that it
/// judges (nor with geometry/inspect.h, which the verb `check` uses). Functions that return a text say what is
/// wrong, or nothing. Tests ask it after each change of topology; so do debug builds and `evolve --verify`.
namespace meniscus::judge {

struct Soup {
  std::vector<Point> points;
  std::vector<std::array<std::size_t, 3>> triangles;  ///< of what is no triangle: 0 0 0
};

/// The mesh without its removed elements.
Soup soup_of(const Mesh& mesh);
/// Faces by connected component.
std::vector<std::vector<std::size_t>> components_of(const Soup& soup);
/// cm^3, signed: positive if the faces look outward.
double volume_of(const Soup& soup, const std::vector<std::size_t>& faces);

/// Every directed edge has exactly one opposite, no face twice, no vertex without faces.
std::string edges_defect(const Soup& soup);
/// The faces of each vertex form one fan. Precondition: edges_defect is empty.
std::string fans_defect(const Soup& soup);

/// Closed, 2-manifold, finite, CGAL's own invariants, and positive volume of each component but bubbles in the liquid.
std::string topology_defect(const Mesh& mesh);
/// Whether faces meet that share no vertex or edge, or more than that (exact). Precondition: no topology_defect.
bool meets_itself(const Mesh& mesh);
/// Everything that makes a mesh sound.
std::string defect(const Mesh& mesh);
/// The drop's flat connectivity says what a fresh rebuild says, up to where a ring starts.
std::string connectivity_defect(const Drop& drop);
/// connectivity_defect, then that of the mesh.
std::string defect(const Drop& drop);

}  // namespace meniscus::judge
