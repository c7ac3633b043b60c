// SPDX-License-Identifier: GPL-3.0-or-later
#include "soup_topology.h"

#include "scaled_triangles.h"

#include <boost/pending/disjoint_sets.hpp>

#include <algorithm>
#include <map>
#include <tuple>

namespace meniscus {
namespace {

using Sets = boost::disjoint_sets_with_storage<>;

/// One side of a triangle: its k-th vertex and the next.
struct Side {
  std::uint32_t low, high, triangle;
  std::uint8_t corner;
  bool rising;  ///< from low to high
};

std::vector<Side> sorted_sides(const MeshData& data) {
  std::vector<Side> sides;
  sides.reserve(3 * data.triangles.size());
  for (std::uint32_t t = 0; t < data.triangles.size(); ++t) {
    const auto& v = data.triangles[t];
    if (!has_valid_indices(data, v)) continue;
    for (std::uint8_t k = 0; k < 3; ++k) {
      const std::uint32_t a = v[k], b = v[(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), t, k, a < b});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  return sides;
}

/// The corner (3 t + k) of a side's triangle at its low or high vertex.
std::size_t corner_at(const Side& side, bool low) {
  const bool at_start = side.rising == low;
  return 3 * std::size_t{side.triangle} + (at_start ? side.corner : (side.corner + 1) % 3);
}

void sort_edge(SoupTopology& topology, const Side* first, const Side* last) {
  const auto edge = [&] {
    SoupTopology::Edge e{first->low, first->high, {}};
    for (const Side* s = first; s != last; ++s) e.faces.push_back(s->triangle);
    return e;
  };
  ++topology.num_edges;
  if (last - first == 1) topology.boundary.push_back(edge());
  if (last - first > 2) topology.non_manifold.push_back(edge());
  if (last - first == 2 && first->rising == first[1].rising) topology.inconsistent.push_back(edge());
}

void number_components(const MeshData& data, Sets& faces, SoupTopology& topology) {
  const std::size_t n = data.triangles.size();
  std::vector<std::uint32_t> number(n, no_component);
  topology.component.assign(n, no_component);
  for (std::size_t t = 0; t < n; ++t) {
    if (!has_valid_indices(data, data.triangles[t])) continue;
    auto& component = number[faces.find_set(t)];
    if (component == no_component) component = static_cast<std::uint32_t>(topology.num_components++);
    topology.component[t] = component;
  }
}

void find_pinched(const MeshData& data, Sets& corners, SoupTopology& topology) {
  constexpr std::size_t none = ~std::size_t{0};
  std::vector<std::size_t> fan(data.points.size(), none);  // a corner of the first fan met at each vertex
  std::vector<bool> is_pinched(data.points.size(), false);
  for (std::size_t t = 0; t < data.triangles.size(); ++t) {
    if (topology.component[t] == no_component) continue;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t v = data.triangles[t][k];
      const std::size_t root = corners.find_set(3 * t + k);
      if (fan[v] == none) {
        fan[v] = root;
        ++topology.num_vertices;
      }
      if (fan[v] != root) is_pinched[v] = true;
    }
  }
  for (std::uint32_t v = 0; v < is_pinched.size(); ++v)
    if (is_pinched[v]) topology.pinched.push_back(v);
}

void group_holes(SoupTopology& topology) {
  std::map<std::uint32_t, std::size_t> edge_at;  // an edge at each vertex of the boundary
  const auto& edges = topology.boundary;
  Sets sets(edges.size());
  for (std::size_t e = 0; e < edges.size(); ++e)
    for (const auto v : {edges[e].low, edges[e].high}) {
      const auto [place, is_new] = edge_at.emplace(v, e);
      if (!is_new) sets.union_set(e, place->second);
    }
  std::map<std::size_t, std::size_t> hole;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto [place, is_new] = hole.emplace(sets.find_set(e), topology.holes.size());
    if (is_new) topology.holes.emplace_back();
    topology.holes[place->second].push_back(static_cast<std::uint32_t>(e));
  }
}

}  // namespace

SoupTopology soup_topology(const MeshData& data) {
  SoupTopology topology;
  const std::vector<Side> sides = sorted_sides(data);
  Sets faces(data.triangles.size()), corners(3 * data.triangles.size());
  for (std::size_t i = 0, j; i < sides.size(); i = j) {
    for (j = i + 1; j < sides.size() && sides[j].low == sides[i].low && sides[j].high == sides[i].high; ++j) {
      faces.union_set(sides[i].triangle, sides[j].triangle);
      for (const bool low : {true, false}) corners.union_set(corner_at(sides[i], low), corner_at(sides[j], low));
    }
    sort_edge(topology, sides.data() + i, sides.data() + j);
  }
  number_components(data, faces, topology);
  find_pinched(data, corners, topology);
  group_holes(topology);
  return topology;
}

}  // namespace meniscus
