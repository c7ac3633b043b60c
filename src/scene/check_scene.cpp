// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/scene/nearest_name.h"
#include "scene_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace meniscus::scene_detail {
namespace {

constexpr double most_faces = 50e6;

// The area of a closed drop, cm^2; 0 for a mesh, which is measured when it is read.
double drop_area(const DropSpec& drop, double cap_angle) {
  switch (drop.shape) {
    case DropShape::sphere:
      return 4 * pi * drop.radius * drop.radius;
    case DropShape::ellipsoid: {  // Thomsen's approximation, within 1.1 %
      const double p = 1.6075;
      const Eigen::Array3d q = drop.semi_axes.array().pow(p);
      return 4 * pi * std::pow((q[0] * q[1] + q[1] * q[2] + q[2] * q[0]) / 3, 1 / p);
    }
    case DropShape::box:
      return 2 * (drop.size[0] * drop.size[1] + drop.size[1] * drop.size[2] + drop.size[2] * drop.size[0]);
    case DropShape::scatter:  // of the largest there may be
      return 4 * pi * drop.radius_max * drop.radius_max;
    case DropShape::cap: {  // of a ball of radius r: V = pi r^3 (2 - 3 c + c^3)/3
      const double c = std::cos(cap_angle);
      const double r = drop.radius * std::cbrt(4 / (2 - 3 * c + c * c * c));
      return pi * r * r * (2 * (1 - c) + 1 - c * c);
    }
    case DropShape::mesh:
      return 0;
  }
  return 0;
}

// Equilateral triangles of this edge length that cover an area.
double num_triangles(double area, double edge) { return area / (std::sqrt(3.0) / 4 * edge * edge); }

class SceneCheck {
 public:
  SceneCheck(const Node& root, const Scene& scene, std::vector<Problem>& problems)
      : root_(root), scene_(scene), problems_(problems) {
    for (const Problem& problem : problems) known_.push_back(problem.pointer);
  }

  void run() {
    check_accuracy();
    check_mesh_band();
    check_solid_names();
    for (std::size_t i = 0; i < scene_.solids.size(); ++i) check_solid(scene_.solids[i], child_pointer("/solids", i));
    check_any_liquid();
    for (std::size_t i = 0; i < scene_.drops.size(); ++i) {
      const std::string pointer = child_pointer("/drops", i);
      if (scene_.drops[i].shape == DropShape::cap) check_cap(scene_.drops[i], pointer);
      if (scene_.drops[i].shape == DropShape::scatter) check_scatter(scene_.drops[i], pointer);
    }
    for (std::size_t i = 0; i < scene_.sources.size(); ++i)
      check_source(scene_.sources[i], child_pointer("/sources", i));
    check_num_faces();
  }

 private:
  // Whether neither the value at the pointer, nor what holds it, nor what it holds has a problem.
  bool is_sound(const std::string& pointer) const {
    const auto is_inside = [](const std::string& inner, const std::string& outer) {
      return inner.compare(0, outer.size(), outer) == 0 && (inner.size() == outer.size() || inner[outer.size()] == '/');
    };
    return std::none_of(known_.begin(), known_.end(), [&](const std::string& at) {
      return is_inside(at, pointer) || (!at.empty() && is_inside(pointer, at));
    });
  }

  void report(const std::string& pointer, std::string message) {
    problems_.push_back({deepest(root_, pointer).place, pointer, std::move(message)});
  }

  // The one of two pointers that the scene really has.
  std::string written(const std::string& first, const std::string& second) const {
    const Place& a = deepest(root_, first).place;
    const Place& parent = deepest(root_, first.substr(0, first.rfind('/'))).place;
    return &a == &parent ? second : first;
  }

  void check_accuracy() {
    const Node* model = root_.find("model");
    if (!root_.find("accuracy") || !is_sound("/accuracy") || !is_sound("/model")) return;
    if (model && model->scalar == "auto") return;
    report("/accuracy", "only \"model\": \"auto\" has an accuracy; set that, or leave \"accuracy\" out");
  }

  void check_mesh_band() {
    const EdgeBand& band = scene_.mesh;
    if (!is_sound("/mesh/edge_min") || !is_sound("/mesh/edge_max")) return;
    if (band.edge_min < band.edge_max / 2) return;
    report(written("/mesh/edge_min", "/mesh/edge_max"),
           fmt::format("edge_min {} must be less than half of edge_max {}, or every split would be undone",
                       band.edge_min, band.edge_max));
  }

  void check_solid_names() {
    std::map<std::string, std::size_t> first;
    for (std::size_t i = 0; i < scene_.solids.size(); ++i) {
      const std::string& name = scene_.solids[i].name;
      const std::size_t index = first.emplace(name, i).first->second;
      if (name.empty() || index == i) continue;
      report(child_pointer("/solids", i) + "/name", fmt::format("solid {} already has the name \"{}\"", index, name));
    }
  }

  void check_solid(const SolidSpec& solid, const std::string& pointer) {
    const std::string advancing = pointer + "/advancing_angle_deg", receding = pointer + "/receding_angle_deg";
    if (is_sound(advancing) && is_sound(receding) && solid.receding_angle > solid.advancing_angle) {
      report(receding, fmt::format("the receding angle {:.6g} exceeds the advancing angle {:.6g}",
                                   solid.receding_angle * 180 / pi, solid.advancing_angle * 180 / pi));
    }
    const bool has_axis = solid.shape == SolidShape::cylinder || solid.shape == SolidShape::capsule;
    if (has_axis && is_sound(pointer + "/from") && is_sound(pointer + "/to") && is_sound(pointer) &&
        (solid.to - solid.from).norm() < 1e-12) {
      report(pointer + "/to", "\"from\" and \"to\" are the same point; the axis has no direction");
    }
    if (is_sound(pointer + "/keys") && !solid.keys.empty()) check_keys(solid, pointer);
  }

  void check_keys(const SolidSpec& solid, const std::string& pointer) {
    if (deepest(root_, pointer).find("velocity")) {
      report(pointer + "/velocity", "\"velocity\" and \"keys\" exclude each other");
    }
    for (std::size_t i = 1; i < solid.keys.size(); ++i) {
      if (solid.keys[i].time > solid.keys[i - 1].time) continue;
      report(child_pointer(pointer + "/keys", i) + "/time", "times must increase from key to key");
    }
  }

  void check_any_liquid() {
    if (!scene_.sources.empty() || !scene_.drops.empty() || !is_sound("/drops") || !is_sound("/sources")) return;
    if (root_.find("drops"))
      report("/drops", "there are no drops; give at least one");
    else
      report("", "missing \"drops\" (a list of objects), and there are no \"sources\"");
  }

  void check_cap(const DropSpec& drop, const std::string& pointer) {
    if (!is_sound(pointer)) return;
    if (drop.on.empty()) return report(pointer, "missing \"on\" (text)");
    check_seat(drop, pointer);
  }

  void check_scatter(const DropSpec& drop, const std::string& pointer) {
    const std::string least = pointer + "/radius_min", greatest = pointer + "/radius_max";
    if (is_sound(least) && is_sound(greatest) && drop.radius_max < drop.radius_min)
      report(written(greatest, least),
             fmt::format("radius_max {} is less than radius_min {}", drop.radius_max, drop.radius_min));
    if (!drop.on.empty()) check_seat(drop, pointer);
  }

  void check_source(const SourceSpec& source, const std::string& pointer) {
    if (is_sound(pointer + "/start") && is_sound(pointer + "/stop") && source.stop <= source.start)
      report(written(pointer + "/stop", pointer + "/start"),
             fmt::format("a source that starts at {} s must stop later than that", source.start));
    if (is_sound("/mesh") && is_sound(pointer) && source.radius < scene_.mesh.edge_min)
      report(written(pointer + "/radius", pointer),
             fmt::format("a source of radius {} cm is too small for edges of edge_min {} cm; lower mesh.edge_min and "
                         "mesh.edge_max, or make it larger",
                         source.radius, scene_.mesh.edge_min));
  }

  // The solid that a drop sits on, which must have its name.
  void check_seat(const DropSpec& drop, const std::string& pointer) {
    if (!is_sound(pointer + "/on")) return;
    const SolidSpec* solid = solid_called(drop.on);
    std::vector<std::string> names;
    for (const SolidSpec& other : scene_.solids) names.push_back(other.name);
    if (!solid) {
      const std::string nearest = nearest_name(drop.on, names);
      report(pointer + "/on", fmt::format("no solid has the name \"{}\"{}", drop.on,
                                          nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", nearest)));
    } else if (!drop.angle && is_sound("/solids") && solid->advancing_angle + solid->receding_angle >= 2 * pi) {
      report(pointer, "nothing wets that solid (its angles are 180 degrees); give the cap an \"angle_deg\"");
    }
  }

  const SolidSpec* solid_called(const std::string& name) const {
    const auto it = std::find_if(scene_.solids.begin(), scene_.solids.end(),
                                 [&](const SolidSpec& solid) { return solid.name == name; });
    return it == scene_.solids.end() ? nullptr : &*it;
  }

  double cap_angle(const DropSpec& drop) const {
    const SolidSpec* solid = solid_called(drop.on);
    const double between = solid ? (solid->advancing_angle + solid->receding_angle) / 2 : pi / 2;
    return std::clamp(drop.angle.value_or(between), 1e-3, pi);
  }

  void check_num_faces() {
    if (!is_sound("/mesh")) return;
    const EdgeBand& band = scene_.mesh;
    const double edge = (band.edge_min + band.edge_max) / 2;
    double total = 0;
    bool is_reported = false;
    for (std::size_t i = 0; i < scene_.drops.size(); ++i) {
      const std::string pointer = child_pointer("/drops", i);
      if (!is_sound(pointer)) continue;
      const double area = drop_area(scene_.drops[i], cap_angle(scene_.drops[i]));
      const double faces = num_triangles(area, edge);
      const bool is_scatter = scene_.drops[i].shape == DropShape::scatter;
      const double least =
          is_scatter ? area * std::pow(scene_.drops[i].radius_min / scene_.drops[i].radius_max, 2) : area;
      total += is_scatter ? scene_.drops[i].count * faces : faces;
      if (faces > most_faces) {
        report(pointer,
               fmt::format("edges of {:.3g} cm need {:.3g} million faces, more than 50 million; raise mesh.edge_min "
                           "and mesh.edge_max, or make the drop smaller",
                           edge, faces / 1e6));
        is_reported = true;
      } else if (least > 0 && num_triangles(least, band.edge_min) < 4) {
        report(pointer,
               fmt::format("the drop is smaller than one tetrahedron of edges of edge_min {} cm; lower mesh.edge_min "
                           "and mesh.edge_max, or make the drop larger",
                           band.edge_min));
      }
    }
    if (total > most_faces && !is_reported) {
      report("/drops",
             fmt::format("edges of {:.3g} cm need {:.3g} million faces for all drops, more than 50 million; raise "
                         "mesh.edge_min and mesh.edge_max",
                         edge, total / 1e6));
    }
  }

  const Node& root_;
  const Scene& scene_;
  std::vector<Problem>& problems_;
  std::vector<std::string> known_;
};

}  // namespace

void check_scene(const Node& root, const Scene& scene, std::vector<Problem>& problems) {
  if (!root.is_bad && root.is_object()) SceneCheck(root, scene, problems).run();
}

}  // namespace meniscus::scene_detail
