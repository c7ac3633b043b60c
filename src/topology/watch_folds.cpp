// SPDX-License-Identifier: GPL-3.0-or-later
#include "boolean_parts.h"
#include "face_grid.h"
#include "meniscus/state/contact_line.h"
#include "merge_parts.h"
#include "placed_face.h"
#include "sorted_boxes.h"

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

using Eigen::Vector3d;

/// Faces look at each other, or away from each other, if the cosine between their normals is below this.
constexpr double opposite = -0.3;

/// A solid bends under a face if it turns by more than 30 degrees between two of its corners: the face then lies so far
/// from the solid that the surface beside the contact line may pass between them.
constexpr double cosine_of_bend = 0.8660254037844387;

/// A place is thin that is thinner than so many radii of the ball of the drop's volume.
constexpr double thin = 0.5;

/// A drop with so many times the area of the ball of its volume is no ball, however small.
constexpr double deformed = 1.3;

bool is_on_solids(const Contact* contact, const Triangle& t) {
  return is_colliding(contact[t[0]]) && is_colliding(contact[t[1]]) && is_colliding(contact[t[2]]);
}

void watch_face(std::uint8_t* watch, const Triangle& t) {
  for (const auto v : t) watch[v] = std::max(watch[v], violent_watched_calls);
}

Vector3d area_vector(const MeshView& mesh, const Triangle& t) {
  const Vector3d a = mesh.points.col(t[0]);
  return (Vector3d(mesh.points.col(t[1])) - a).cross(Vector3d(mesh.points.col(t[2])) - a);
}

/// The watch does not end where another sheet of the surface is within edge_max: vertices about to be forgotten are
/// watched on, and those of the other sheet with them. With liquid between, close is what is thin for a drop of its
/// volume: the sides of a small one are no sheets, nor are faces on solids.
void watch_close_sheets(Drop& drop, const EdgeBand& band) {
  const MeshView mesh = view_of(std::as_const(drop));
  std::uint8_t* watch = drop.seam_watch();
  const Contact* contact = drop.contact();
  const auto has = [](const Triangle& t, auto of_vertex) {
    return of_vertex(t[0]) || of_vertex(t[1]) || of_vertex(t[2]);
  };
  const auto is_ending = [&](std::uint32_t v) { return watch[v] == 1; };
  const auto is_free = [&](std::uint32_t v) { return !is_colliding(contact[v]); };
  std::vector<std::uint32_t> ending;
  Eigen::AlignedBox3d region;
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    const Triangle& t = mesh.triangles[f];
    if (t[0] == Connectivity::removed || !has(t, is_ending) || !has(t, is_free)) continue;
    ending.push_back(f);
    for (const auto v : t) region.extend(Vector3d(mesh.points.col(v)));
  }
  if (ending.empty()) return;
  const Vector3d margin = Vector3d::Constant(band.edge_max);
  std::vector<FaceBox> faces = faces_in(mesh, {region.min() - margin, region.max() + margin});
  faces.erase(std::remove_if(faces.begin(), faces.end(),
                             [&](const FaceBox& f) { return !has(mesh.triangles[f.face], is_free); }),
              faces.end());
  std::vector<Vector3d> normal;
  normal.reserve(faces.size());
  for (const FaceBox& f : faces) normal.push_back(area_vector(mesh, mesh.triangles[f.face]).stableNormalized());
  const double ball_radius = std::cbrt(0.75 * drop.target_volume() / M_PI);
  const double thickest = std::clamp(thin * ball_radius, band.edge_min, band.edge_max);
  const SortedBoxes near(faces);
  std::vector<std::uint32_t> kept;
  std::size_t k = 0;
  for (const auto f : ending) {
    while (faces[k].face != f) ++k;  // both lists are sorted
    const Triangle& s = mesh.triangles[f];
    const Eigen::AlignedBox3d& box = faces[k].box;
    near.for_each_meeting({box.min() - margin, box.max() + margin}, [&](std::uint32_t other) {
      if (!(normal[k].dot(normal[other]) < opposite)) return;
      if (normal[k].dot(faces[other].box.center() - box.center()) < -thickest) return;
      const Triangle& t = mesh.triangles[faces[other].face];
      if (boolean_parts::share_a_vertex(s, t)) return;
      kept.insert(kept.end(), s.begin(), s.end());
      kept.insert(kept.end(), t.begin(), t.end());
    });
  }
  for (const auto v : kept) watch[v] = std::max(watch[v], violent_watched_calls);
}

/// Somewhere beside the contact line the surface hangs over the solid by 30 degrees or more: so does the rim of a film
/// that runs back from where it does not like to be, and its top and underside have air on both sides.
bool overhangs(const Drop& drop) {
  const MeshView mesh = view_of(drop);
  for (const Triangle& t : mesh.triangles) {
    if (t[0] == Connectivity::removed) continue;
    const auto on_line = std::find_if(t.begin(), t.end(), [&](auto v) { return drop.contact()[v] == Contact::line; });
    const auto free = [&](std::uint32_t v) { return !is_colliding(drop.contact()[v]); };
    if (on_line == t.end() || std::none_of(t.begin(), t.end(), free)) continue;
    const Vector3d n = area_vector(mesh, t);
    if (n.dot(drop.contact_normals().col(*on_line)) < -0.5 * n.norm()) return true;
  }
  return false;
}

/// Watches where free faces that look away from each other have less than `thickness` of liquid between them.
void watch_thin_places(Drop& drop, double thickness) {
  const MeshView mesh = view_of(std::as_const(drop));
  const auto is_free = [&](std::uint32_t v) { return !is_colliding(drop.contact()[v]); };
  std::vector<FaceBox> inward;  // each face and what is under it
  std::vector<Vector3d> normal;
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    const Triangle& t = mesh.triangles[f];
    if (t[0] == Connectivity::removed || !is_free(t[0]) || !is_free(t[1]) || !is_free(t[2])) continue;
    const Vector3d n = area_vector(mesh, t).stableNormalized();
    FaceBox box{{}, f};
    for (const auto v : t) {
      box.box.extend(Vector3d(mesh.points.col(v)));
      box.box.extend(Vector3d(mesh.points.col(v) - 0.5 * thickness * n));
    }
    inward.push_back(box);
    normal.push_back(n);
  }
  const auto face_at = [&](std::uint32_t k) -> const Triangle& { return mesh.triangles[inward[k].face]; };
  std::uint8_t* const watch = drop.seam_watch();
  const auto thin_places = SortedBoxes(inward).pairs_if([&](std::uint32_t a, std::uint32_t b) {
    return normal[a].dot(normal[b]) < opposite && !boolean_parts::share_a_vertex(face_at(a), face_at(b));
  });
  for (const auto& [a, b] : thin_places)
    for (const auto k : {a, b}) watch_face(watch, face_at(k));
}

/// Where normals at wetted vertices differ by less, a solid is flat under a drop.
constexpr double flat = 0.02;

/// Watches wetted faces and others that meet, unless one of them is watched already. On a flat solid nothing free gets
/// below what is wetted; but the faces on one that bends, and the edges of the contact line, are its chords.
void watch_crossed_contact(Drop& drop) {
  const MeshView mesh = view_of(std::as_const(drop));
  const Contact* contact = drop.contact();
  std::uint8_t* const watch = drop.seam_watch();
  const auto is_watched = [&](const Triangle& t) { return watch[t[0]] != 0 && watch[t[1]] != 0 && watch[t[2]] != 0; };
  std::vector<FaceBox> wetted;
  std::vector<PlacedTriangle> placed;
  Eigen::AlignedBox3d region;
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    const Triangle& t = mesh.triangles[f];
    if (t[0] == Connectivity::removed || !is_on_solids(contact, t) || is_watched(t)) continue;
    wetted.push_back({box_of(mesh, t), f});
    placed.push_back(placed_face(mesh, f));
    region.extend(wetted.back().box);
  }
  if (wetted.empty()) return;
  const SortedBoxes near(wetted);
  for (const FaceBox& face : faces_in(mesh, region)) {
    const Triangle& t = mesh.triangles[face.face];
    if (is_on_solids(contact, t) || is_watched(t)) continue;
    const PlacedTriangle own = placed_face(mesh, face.face);
    near.for_each_meeting(face.box, [&](std::uint32_t k) {
      if (!meet(own, placed[k])) return;
      watch_face(watch, t);
      watch_face(watch, mesh.triangles[wetted[k].face]);
    });
  }
}

}  // namespace

void watch_faces(Drop& drop, const std::vector<std::uint8_t>& marked) {
  std::uint8_t* const watch = drop.seam_watch();
  for (std::size_t f = 0; f < marked.size(); ++f)
    if (marked[f] != 0) watch_face(watch, drop.connectivity().triangles()[f]);
}

void watch_bends(Drop& drop) {
  const double half_bend = std::sqrt(2 - std::sqrt(2 * (1 + cosine_of_bend)));  // the chord of half the angle
  if (!contact_normals_differ(drop, flat)) return;
  watch_crossed_contact(drop);
  if (!contact_normals_differ(drop, half_bend)) return;
  const Contact* contact = drop.contact();
  const ConstColumns n = std::as_const(drop).contact_normals();
  const auto turns = [&](std::uint32_t a, std::uint32_t b) { return n.col(a).dot(n.col(b)) < cosine_of_bend; };
  std::uint8_t* const watch = drop.seam_watch();
  for (const Triangle& t : drop.connectivity().triangles()) {
    if (t[0] == Connectivity::removed || !is_on_solids(contact, t)) continue;
    if (turns(t[0], t[1]) || turns(t[1], t[2]) || turns(t[2], t[0])) watch_face(watch, t);
  }
}

void watch_thin_sheets(Drop& drop, double area, const EdgeBand& band) {
  const double volume = drop.target_volume(), ball_area = std::cbrt(36 * M_PI * volume * volume);
  // What lies on a solid and what covers it bound no sheet with air on both sides.
  const double least_sides = deformed * ball_area;
  if (!(area > least_sides)) return;
  const double sides = area - 2 * wetted_area(drop);
  if (!(sides > least_sides)) {
    if (overhangs(drop)) watch_thin_places(drop, band.edge_min);
    return;
  }
  if (!(2 * volume < band.edge_max * sides)) return watch_thin_places(drop, band.edge_min);
  std::uint8_t* const watch = drop.seam_watch();
  for (std::uint32_t v = 0; v < drop.num_rows(); ++v)
    if (!is_colliding(drop.contact()[v])) watch[v] = std::max(watch[v], violent_watched_calls);
}

bool may_fold(const Drop& drop, const MergeOptions& options) {
  const std::uint8_t* watch = drop.seam_watch();
  return drop.num_rows() > 0 &&
         (options.self_merge || std::any_of(watch, watch + drop.num_rows(), [](std::uint8_t w) { return w != 0; }));
}

void count_down_watch(Drop& drop, const EdgeBand& band) {
  watch_close_sheets(drop, band);
  std::uint8_t* watch = drop.seam_watch();
  for (std::uint32_t v = 0; v < drop.num_rows(); ++v)
    if (watch[v] > 0) --watch[v];
}

}  // namespace meniscus
