// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/types.h"

#include <utility>

namespace meniscus {

/// Five vertices and six faces, outward, some 0.01 cm across: a small triangle with one vertex far above it and one
/// just below. Its normals do not add up to nothing.
inline Mesh make_knot() {
  Mesh mesh;
  const auto at = [&](double x, double y, double z) { return mesh.add_vertex(Point(x, y, z)); };
  const auto a = at(0.004, 0, 0), b = at(-0.002, 0.003, 0), c = at(-0.002, -0.003, 0), top = at(0, 0, 0.009),
             bottom = at(0.001, 0.001, -0.002);
  for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
    mesh.add_face(p, q, top);
    mesh.add_face(q, p, bottom);
  }
  return mesh;
}

}  // namespace meniscus
