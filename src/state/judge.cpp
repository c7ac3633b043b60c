// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/state/judge.h"

#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>

namespace meniscus::judge {

Soup soup_of(const Mesh& mesh) {
  Soup soup;
  std::vector<std::size_t> number(mesh.num_vertices(), 0);
  for (const auto v : mesh.vertices()) {
    number[v] = soup.points.size();
    soup.points.push_back(mesh.point(v));
  }
  for (const auto f : mesh.faces()) {
    std::vector<std::size_t> corners;
    for (const auto v : CGAL::vertices_around_face(mesh.halfedge(f), mesh)) corners.push_back(number.at(v));
    if (corners.size() != 3) corners = {0, 0, 0};  // found out below
    soup.triangles.push_back({corners[0], corners[1], corners[2]});
  }
  return soup;
}

std::string edges_defect(const Soup& soup) {
  std::vector<std::array<std::size_t, 2>> directed;
  std::vector<std::array<std::size_t, 3>> faces;
  std::vector<int> uses(soup.points.size(), 0);
  for (auto t : soup.triangles) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
      return fmt::format("face with a vertex twice: {} {} {}", t[0], t[1], t[2]);
    for (int k = 0; k < 3; ++k) {
      directed.push_back({t[k], t[(k + 1) % 3]});
      ++uses[t[k]];
    }
    std::sort(t.begin(), t.end());
    faces.push_back(t);
  }
  std::sort(faces.begin(), faces.end());
  if (const auto twice = std::adjacent_find(faces.begin(), faces.end()); twice != faces.end())
    return fmt::format("two faces on {} {} {}", (*twice)[0], (*twice)[1], (*twice)[2]);
  std::sort(directed.begin(), directed.end());
  if (const auto twice = std::adjacent_find(directed.begin(), directed.end()); twice != directed.end()) {
    const auto [first, end] = std::equal_range(twice, directed.end(), *twice);
    return fmt::format("edge {}-{} has {} faces on one side", (*twice)[0], (*twice)[1], end - first);
  }
  for (const auto& edge : directed)
    if (!std::binary_search(directed.begin(), directed.end(), decltype(edge){edge[1], edge[0]}))
      return fmt::format("edge {}-{} has no opposite", edge[0], edge[1]);
  for (std::size_t v = 0; v < uses.size(); ++v)
    if (uses[v] < 3) return fmt::format("vertex {} has {} faces", v, uses[v]);
  return {};
}

std::string fans_defect(const Soup& soup) {
  std::vector<std::array<std::size_t, 3>> steps;  // about a vertex: from a neighbour to the next
  for (const auto& t : soup.triangles)
    for (int k = 0; k < 3; ++k) steps.push_back({t[k], t[(k + 1) % 3], t[(k + 2) % 3]});
  std::sort(steps.begin(), steps.end());
  for (auto first = steps.begin(); first != steps.end();) {
    const std::size_t v = (*first)[0];
    const auto end = std::find_if(first, steps.end(), [&](const auto& step) { return step[0] != v; });
    std::ptrdiff_t turned = 0;
    std::size_t at = (*first)[1];
    do {
      const auto step = std::lower_bound(first, end, std::array<std::size_t, 3>{v, at, 0});
      if (step == end || (*step)[1] != at) return fmt::format("vertex {} has an open fan", v);
      at = (*step)[2];
      ++turned;
    } while (at != (*first)[1] && turned <= end - first);
    if (turned != end - first) return fmt::format("vertex {} is pinched", v);
    first = end;
  }
  return {};
}

double volume_of(const Soup& soup, const std::vector<std::size_t>& faces) {
  if (faces.empty()) return 0;
  const Point origin = soup.points[soup.triangles[faces[0]][0]];
  double six = 0;
  for (const auto f : faces) {
    const auto& t = soup.triangles[f];
    six += CGAL::scalar_product(soup.points[t[0]] - origin,
                                CGAL::cross_product(soup.points[t[1]] - origin, soup.points[t[2]] - origin));
  }
  return six / 6;
}

std::vector<std::vector<std::size_t>> components_of(const Soup& soup) {
  std::vector<std::size_t> parent(soup.points.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](std::size_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const auto& t : soup.triangles) {
    parent[root(t[1])] = root(t[0]);
    parent[root(t[2])] = root(t[0]);
  }
  std::map<std::size_t, std::vector<std::size_t>> groups;
  for (std::size_t f = 0; f < soup.triangles.size(); ++f) groups[root(soup.triangles[f][0])].push_back(f);
  std::vector<std::vector<std::size_t>> components;
  components.reserve(groups.size());
  for (auto& group : groups) components.push_back(std::move(group.second));
  return components;
}

/// Closed, 2-manifold, finite, CGAL's own invariants, and positive volume of each component but bubbles.
std::string topology_defect(const Mesh& mesh) {
  if (!mesh.is_valid(false)) return "Surface_mesh::is_valid says no";
  const Soup soup = soup_of(mesh);
  if (soup.triangles.empty()) return "no faces";
  for (const auto& p : soup.points)
    if (!std::isfinite(p.x()) || !std::isfinite(p.y()) || !std::isfinite(p.z())) return "a coordinate is not finite";
  if (auto defect = edges_defect(soup); !defect.empty()) return defect;
  if (auto defect = fans_defect(soup); !defect.empty()) return defect;
  double sum = 0;
  std::string defect;
  for (const auto& faces : components_of(soup)) {
    const double volume = volume_of(soup, faces);
    sum += volume;
    if (!(volume > 0) && defect.empty())
      defect = fmt::format("a component of {} faces has volume {}", faces.size(), volume);
  }
  const bool may_be_bubbles = !defect.empty() && sum > 0;
  return may_be_bubbles && CGAL::Polygon_mesh_processing::does_bound_a_volume(mesh) ? "" : defect;
}

bool meets_itself(const Mesh& mesh) {
  const Soup soup = soup_of(mesh);
  Mesh copy;
  for (const auto& p : soup.points) copy.add_vertex(p);
  const auto index = [](std::size_t v) { return VertexIndex(static_cast<Mesh::size_type>(v)); };
  for (const auto& t : soup.triangles) copy.add_face(index(t[0]), index(t[1]), index(t[2]));
  return CGAL::Polygon_mesh_processing::does_self_intersect(copy);
}

/// Everything that makes a mesh sound.
std::string defect(const Mesh& mesh) {
  if (auto found = topology_defect(mesh); !found.empty()) return found;
  return meets_itself(mesh) ? "the surface meets itself" : "";
}

/// The drop's flat connectivity says what a fresh rebuild says, up to where a ring starts.
std::string connectivity_defect(const Drop& drop) {
  Connectivity fresh;
  fresh.rebuild(drop.mesh());
  const Connectivity& kept = drop.connectivity();
  if (kept.num_rows() != fresh.num_rows() || kept.num_rows() != drop.num_rows()) return "row counts differ";
  if (kept.triangles() != fresh.triangles()) return "triangles differ";
  for (std::uint32_t v = 0; v < fresh.num_rows(); ++v) {
    const Ring a = kept.ring(v), b = fresh.ring(v);
    if (a.degree != b.degree) return fmt::format("vertex {}: degree {} for {}", v, a.degree, b.degree);
    if (a.degree == 0) continue;
    const auto start = std::find(a.neighbour, a.neighbour + a.degree, b.neighbour[0]) - a.neighbour;
    if (start == a.degree) return fmt::format("vertex {}: other neighbours", v);
    for (int k = 0; k < b.degree; ++k) {
      const auto j = (start + k) % a.degree;
      if (a.neighbour[j] != b.neighbour[k] || a.corner[j] != b.corner[k])
        return fmt::format("vertex {}: rings differ", v);
    }
    for (int k = a.degree <= Connectivity::width ? a.degree : 0; k < Connectivity::width; ++k)
      if (kept.neighbour_rows()[Connectivity::width * std::size_t{v} + static_cast<std::size_t>(k)] != v)
        return fmt::format("vertex {}: the row is not padded", v);
  }
  if (kept.long_rings().size() != fresh.long_rings().size()) return "long rings differ";
  return {};
}

std::string defect(const Drop& drop) {
  if (auto found = connectivity_defect(drop); !found.empty()) return found;
  return defect(drop.mesh());
}

}  // namespace meniscus::judge
