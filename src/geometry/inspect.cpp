// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/geometry/inspect.h"

#include "meniscus/geometry/self_intersection.h"
#include "nesting.h"
#include "scaled_triangles.h"
#include "soup_topology.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <tuple>

namespace meniscus {
namespace {

constexpr std::size_t max_ids = 20;      // of a defect
constexpr std::size_t max_holes = 20;    // listed one by one
constexpr std::size_t max_pairs = 1000;  // of intersecting triangles, before the search stops

using Indices = std::vector<std::uint32_t>;
using Pairs = std::vector<std::array<std::uint32_t, 2>>;

/// Collects defects, translating triangles to the file's faces.
class Findings {
 public:
  explicit Findings(const MeshData& data) : data_(data) {}

  /// A defect unless there are none. The message's {} is how many there are.
  void add(DefectKind kind, fmt::string_view message, std::size_t count, const Indices& faces,
           const Indices& vertices = {}) {
    if (count == 0) return;
    Defect defect{kind, fmt::format(fmt::runtime(message), count), {}, {}};
    for (std::size_t i = 0; i < std::min(max_ids, faces.size()); ++i)
      defect.faces.push_back(data_.face_in_file(faces[i]));
    defect.vertices.assign(vertices.begin(), vertices.begin() + std::min(max_ids, vertices.size()));
    defects_.push_back(std::move(defect));
  }
  std::vector<Defect> take() { return std::move(defects_); }

 private:
  const MeshData& data_;
  std::vector<Defect> defects_;
};

template <class Condition>
Indices triangles_where(const MeshData& data, Condition condition) {
  Indices found;
  for (std::uint32_t t = 0; t < data.triangles.size(); ++t)
    if (condition(data.triangles[t])) found.push_back(t);
  return found;
}

bool is_index_out_of_range(const MeshData& data, const std::array<std::uint32_t, 3>& t) {
  return std::max({t[0], t[1], t[2]}) >= data.points.size();
}

bool is_degenerate(const MeshData& data, const std::array<std::uint32_t, 3>& t) {
  return is_measurable(data, t) &&
         CGAL::collinear(to_point(point(data, t[0])), to_point(point(data, t[1])), to_point(point(data, t[2])));
}

Indices non_finite_vertices(const MeshData& data) {
  Indices found;
  for (std::uint32_t v = 0; v < data.points.size(); ++v)
    if (!is_finite(data.points[v])) found.push_back(v);
  return found;
}

/// Triangles that repeat the vertices of one before them.
Indices duplicates(const MeshData& data) {
  std::vector<std::pair<std::array<std::uint32_t, 3>, std::uint32_t>> keys;
  keys.reserve(data.triangles.size());
  for (std::uint32_t t = 0; t < data.triangles.size(); ++t) {
    auto key = data.triangles[t];
    if (!has_valid_indices(data, key)) continue;
    std::sort(key.begin(), key.end());
    keys.emplace_back(key, t);
  }
  std::sort(keys.begin(), keys.end());
  Indices found;
  for (std::size_t i = 1; i < keys.size(); ++i)
    if (keys[i].first == keys[i - 1].first) found.push_back(keys[i].second);
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<bool> used_vertices(const MeshData& data) {
  std::vector<bool> used(data.points.size(), false);
  for (const auto& triangle : data.triangles)
    for (const auto v : triangle)
      if (v < used.size()) used[v] = true;
  return used;
}

Indices isolated_vertices(const MeshData& data) {
  const std::vector<bool> used = used_vertices(data);
  Indices found;
  for (std::uint32_t v = 0; v < used.size(); ++v)
    if (!used[v]) found.push_back(v);
  return found;
}

/// Vertices of faces that lie where another one lies, those of one place in a row.
Indices coincident_vertices(const MeshData& data) {
  const std::vector<bool> used = used_vertices(data);
  Indices order;
  for (std::uint32_t v = 0; v < used.size(); ++v)
    if (used[v] && is_finite(data.points[v])) order.push_back(v);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::tie(data.points[a], a) < std::tie(data.points[b], b);
  });
  const auto same = [&](std::size_t i, std::size_t j) { return data.points[order[i]] == data.points[order[j]]; };
  Indices found;
  for (std::size_t i = 0; i < order.size(); ++i)
    if ((i > 0 && same(i - 1, i)) || (i + 1 < order.size() && same(i, i + 1))) found.push_back(order[i]);
  return found;
}

/// The ends of some edges, and their faces.
struct Ends {
  Indices vertices, faces;
  explicit Ends(const std::vector<SoupTopology::Edge>& edges) {
    for (const auto& edge : edges) {
      vertices.insert(vertices.end(), {edge.low, edge.high});
      faces.insert(faces.end(), edge.faces.begin(), edge.faces.end());
    }
  }
};

void add_holes(const SoupTopology& topology, Findings& findings) {
  for (std::size_t h = 0; h < std::min(max_holes, topology.holes.size()); ++h) {
    std::vector<SoupTopology::Edge> edges;
    for (const auto e : topology.holes[h]) edges.push_back(topology.boundary[e]);
    Ends ends(edges);
    std::sort(ends.vertices.begin(), ends.vertices.end());
    ends.vertices.erase(std::unique(ends.vertices.begin(), ends.vertices.end()), ends.vertices.end());
    findings.add(DefectKind::boundary_edge, "the mesh is open along a hole of {} edges; close it", edges.size(),
                 ends.faces, ends.vertices);
  }
  if (topology.holes.size() > max_holes)
    findings.add(DefectKind::boundary_edge, "the mesh has {} more holes", topology.holes.size() - max_holes, {});
}

void add_faulty_elements(const MeshData& data, Findings& findings) {
  if (data.triangles.empty()) findings.add(DefectKind::empty_mesh, "the mesh has no faces", 1, {});
  const Indices non_finite = non_finite_vertices(data);
  findings.add(DefectKind::non_finite_coordinate, "coordinates of {} vertices are not finite numbers; correct them",
               non_finite.size(), {}, non_finite);
  const Indices out = triangles_where(data, [&](const auto& t) { return is_index_out_of_range(data, t); });
  findings.add(DefectKind::index_out_of_range, "{} faces name vertices that are not there; remove them", out.size(),
               out);
  const Indices repeated =
      triangles_where(data, [&](const auto& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  findings.add(DefectKind::repeated_vertex_in_face, "{} faces name a vertex twice; remove them", repeated.size(),
               repeated);
  const Indices degenerate = triangles_where(data, [&](const auto& t) { return is_degenerate(data, t); });
  findings.add(DefectKind::degenerate_face,
               "{} faces have no area: their vertices lie on a line; collapse or flip them", degenerate.size(),
               degenerate);
  const Indices copies = duplicates(data);
  findings.add(DefectKind::duplicate_face, "{} faces repeat the vertices of another; remove them", copies.size(),
               copies);
}

void add_faulty_joints(const MeshData& data, const SoupTopology& topology, Findings& findings) {
  add_holes(topology, findings);
  const Ends fat(topology.non_manifold), clash(topology.inconsistent);
  findings.add(DefectKind::non_manifold_edge, "{} edges have more than two faces; separate the sheets there",
               topology.non_manifold.size(), fat.faces, fat.vertices);
  findings.add(DefectKind::inconsistent_orientation,
               "across {} edges the outside changes sides; turn the faces of one side around",
               topology.inconsistent.size(), clash.faces, clash.vertices);
  findings.add(DefectKind::pinched_vertex,
               "at {} vertices the faces form more than one fan; duplicate the vertex, one copy a fan",
               topology.pinched.size(), {}, topology.pinched);
  const Indices isolated = isolated_vertices(data);
  findings.add(DefectKind::isolated_vertex, "{} vertices belong to no face; remove them", isolated.size(), {},
               isolated);
  const Indices coincident = coincident_vertices(data);
  findings.add(DefectKind::coincident_vertices,
               "{} vertices lie exactly where another does but are not joined to it; weld or part them",
               coincident.size(), {}, coincident);
}

/// The sign of each component's volume; 0 if rounding may have made it.
std::vector<int> volume_signs(const MeshData& data, const SoupTopology& topology) {
  struct Sum {
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();
    double volume = 0, size = 0;
    bool is_new = true;
  };
  std::vector<Sum> sums(topology.num_components);
  std::size_t t = 0;  // all triangles are measurable, so that they are visited one by one
  for_each_triangle_scaled_by_axis(data, [&](const Corners& p) {
    Sum& sum = sums[topology.component[t++]];
    if (sum.is_new) sum.origin = p[0], sum.is_new = false;
    const Eigen::Vector3d a = p[0] - sum.origin, b = p[1] - sum.origin, c = p[2] - sum.origin;
    const double volume = a.dot(b.cross(c));
    sum.volume += volume;
    sum.size += std::abs(volume);
  });
  std::vector<int> signs;
  signs.reserve(sums.size());
  for (const auto& sum : sums) signs.push_back(std::abs(sum.volume) <= 1e-13 * sum.size ? 0 : sum.volume > 0 ? 1 : -1);
  return signs;
}

/// Pairs of components of which triangles meet.
Pairs crossing_components(const SoupTopology& topology, const Pairs& triangles) {
  Pairs crossing;
  for (const auto& [s, t] : triangles) {
    const std::uint32_t a = topology.component[s], b = topology.component[t];
    if (a != b) crossing.push_back({std::min(a, b), std::max(a, b)});
  }
  std::sort(crossing.begin(), crossing.end());
  crossing.erase(std::unique(crossing.begin(), crossing.end()), crossing.end());
  return crossing;
}

/// Judges each component's orientation. Precondition: closed, consistent, all triangles measurable.
void judge_orientation(const MeshData& data, const SoupTopology& topology, const Pairs& meeting, Inspection& result,
                       Findings& findings) {
  const std::vector<int> signs = volume_signs(data, topology);
  const std::vector<int> depths =
      nesting_depths(data, topology.component, topology.num_components, crossing_components(topology, meeting));
  Indices first_face(topology.num_components, no_component), flat, inward, outward_cavities;
  for (std::uint32_t t = 0; t < data.triangles.size(); ++t)
    if (auto& first = first_face[topology.component[t]]; first == no_component) first = t;
  result.outward = true;
  for (std::size_t c = 0; c < signs.size(); ++c) {
    const int expected = depths[c] % 2 == 0 ? 1 : -1;
    if (depths[c] == 0 && signs[c] <= 0) result.outward = false;
    if (signs[c] == expected) continue;
    (signs[c] == 0 ? flat : expected > 0 ? inward : outward_cavities).push_back(first_face[c]);
  }
  findings.add(DefectKind::inside_out_component, "{} components enclose no volume; remove them", flat.size(), flat);
  findings.add(DefectKind::inside_out_component, "{} components are inside out; turn their faces around", inward.size(),
               inward);
  findings.add(DefectKind::inside_out_component,
               "{} components lie inside the liquid of another and face outward; remove them, or turn their faces "
               "around if they are cavities",
               outward_cavities.size(), outward_cavities);
  result.bounds_volume = result.manifold && result.outward && !result.self_intersecting && flat.empty() &&
                         inward.empty() && outward_cavities.empty();
}

void add_intersections(const Pairs& meeting, Findings& findings) {
  Indices faces;
  for (const auto& pair : meeting) faces.insert(faces.end(), pair.begin(), pair.end());
  findings.add(DefectKind::self_intersection,
               meeting.size() < max_pairs ? "{} pairs of faces meet where they are not joined"
                                          : "at least {} pairs of faces meet where they are not joined",
               meeting.size(), faces);
}

/// The sum of the components' genera: each has V - E + F = 2 - 2 g.
std::int64_t total_genus(const SoupTopology& topology, std::size_t num_faces) {
  const auto characteristic =
      std::int64_t(topology.num_vertices) - std::int64_t(topology.num_edges) + std::int64_t(num_faces);
  return std::int64_t(topology.num_components) - characteristic / 2;
}

}  // namespace

const char* name(DefectKind kind) {
  switch (kind) {
    case DefectKind::empty_mesh:
      return "empty_mesh";
    case DefectKind::non_finite_coordinate:
      return "non_finite_coordinate";
    case DefectKind::index_out_of_range:
      return "index_out_of_range";
    case DefectKind::repeated_vertex_in_face:
      return "repeated_vertex_in_face";
    case DefectKind::degenerate_face:
      return "degenerate_face";
    case DefectKind::duplicate_face:
      return "duplicate_face";
    case DefectKind::boundary_edge:
      return "boundary_edge";
    case DefectKind::non_manifold_edge:
      return "non_manifold_edge";
    case DefectKind::inconsistent_orientation:
      return "inconsistent_orientation";
    case DefectKind::pinched_vertex:
      return "pinched_vertex";
    case DefectKind::isolated_vertex:
      return "isolated_vertex";
    case DefectKind::coincident_vertices:
      return "coincident_vertices";
    case DefectKind::inside_out_component:
      return "inside_out_component";
    case DefectKind::self_intersection:
      return "self_intersection";
  }
  return "unknown";
}

Inspection inspect(const MeshData& data) {
  Inspection result;
  Findings findings(data);
  add_faulty_elements(data, findings);
  const SoupTopology topology = soup_topology(data);
  add_faulty_joints(data, topology, findings);

  const auto all = [&](auto condition) {
    return std::all_of(data.triangles.begin(), data.triangles.end(), [&](const auto& t) { return condition(data, t); });
  };
  const bool valid = all(has_valid_indices);
  const bool consistent = topology.inconsistent.empty() && topology.non_manifold.empty();
  result.vertices = data.points.size();
  result.faces = data.triangles.size();
  result.components = topology.num_components;
  result.closed = valid && !data.triangles.empty() && topology.boundary.empty();
  result.manifold = valid && topology.non_manifold.empty() && topology.pinched.empty();
  if (result.closed && result.manifold && consistent) result.genus = total_genus(topology, data.triangles.size());

  const Pairs meeting = self_intersections(data, max_pairs);
  result.self_intersecting = !meeting.empty();
  if (result.closed && consistent && all(is_measurable)) judge_orientation(data, topology, meeting, result, findings);
  add_intersections(meeting, findings);

  result.volume = enclosed_volume(data);
  result.area = surface_area(data);
  result.edge_length = edge_lengths(data);
  result.angle = angles(data);
  result.defects = findings.take();
  result.sound = result.bounds_volume && result.defects.empty();  // the first says closed, manifold and so on
  return result;
}

}  // namespace meniscus
