// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_table.h"

#include "key_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

// Reads or writes a member, whether its owner is const or not.
#define MENISCUS_FIELD(member) ([](auto& owner) -> auto& { return owner.member; })

namespace meniscus::scene_detail {
namespace {

template <class T, class E>
std::function<std::string(const void*)> shape_namer(std::vector<std::pair<const char*, E>> words) {
  return [words](const void* item) -> std::string {
    for (const auto& word : words) {
      if (word.second == static_cast<const T*>(item)->shape) return word.first;
    }
    return {};
  };
}

Keys<PositionKey> position_keys() {
  Keys<PositionKey> keys;
  keys.number("time", "s", any_number, "when; later than the key before", MENISCUS_FIELD(time)).required();
  keys.vector("position", "cm", any_number, "displacement from the place that the shape gives",
              MENISCUS_FIELD(position))
      .required();
  return keys;
}

const std::vector<std::pair<const char*, SolidShape>> solid_shapes = {
    {"plane", SolidShape::plane},       {"sphere", SolidShape::sphere},   {"box", SolidShape::box},
    {"cylinder", SolidShape::cylinder}, {"capsule", SolidShape::capsule}, {"mesh", SolidShape::mesh}};

Keys<SolidSpec> solid_keys() {
  const Range contact_angle{0, 180, true, false};
  Keys<SolidSpec> keys;
  keys.text("name", "its name, for drops that sit on it and for reports; unlike all others", MENISCUS_FIELD(name))
      .note("none");
  keys.choice("shape", "what it is", solid_shapes, {}, MENISCUS_FIELD(shape)).required();
  keys.vector("point", "cm", any_number, "a point of the plane", MENISCUS_FIELD(point)).of({"plane"});
  keys.vector("normal", "", any_number, "direction out of the solid, of any length", MENISCUS_FIELD(normal))
      .of({"plane"})
      .nonzero();
  keys.vector("center", "cm", any_number, "its centre", MENISCUS_FIELD(center)).of({"sphere", "box"});
  keys.vector("from", "cm", any_number, "one end of its axis", MENISCUS_FIELD(from))
      .of({"cylinder", "capsule"})
      .required();
  keys.vector("to", "cm", any_number, "the other end of its axis", MENISCUS_FIELD(to))
      .of({"cylinder", "capsule"})
      .required();
  keys.number("radius", "cm", positive, "its radius", MENISCUS_FIELD(radius))
      .of({"sphere", "cylinder", "capsule"})
      .required();
  keys.vector("size", "cm", positive, "its edge lengths along x, y, z before rotation", MENISCUS_FIELD(size))
      .of({"box"})
      .required();
  keys.file("file", "a closed mesh (OFF, PLY, OBJ, STL)", MENISCUS_FIELD(file)).of({"mesh"}).required();
  keys.number("scale", "", positive, "factor on the mesh, about its origin, first", MENISCUS_FIELD(scale)).of({"mesh"});
  keys.angles("rotate_deg",
              "turns about the fixed axes x, then y, then z; a box about its centre, a mesh about its origin",
              MENISCUS_FIELD(rotation))
      .of({"box", "mesh"});
  keys.vector("translate", "cm", any_number, "shift of the mesh, last", MENISCUS_FIELD(translation)).of({"mesh"});
  keys.optional_number("edge_radius", "cm", not_negative, "its edges are rounded by this, so that liquid can pass them",
                       MENISCUS_FIELD(edge_radius))
      .of({"box", "cylinder"})
      .note("mesh.edge_min");
  keys.angle("advancing_angle_deg", contact_angle,
             "contact angle through the liquid from which on the contact line advances",
             MENISCUS_FIELD(advancing_angle));
  keys.angle("receding_angle_deg", contact_angle, "contact angle below which it recedes; at most the advancing angle",
             MENISCUS_FIELD(receding_angle))
      .note("the advancing angle");
  keys.number("friction_speed", "cm/s", not_negative,
              "speed that friction takes from touching vertices in a step (Eq 2)", MENISCUS_FIELD(friction_speed));
  keys.vector("velocity", "cm/s", any_number, "constant velocity", MENISCUS_FIELD(velocity))
      .write_if([](const SolidSpec& s) { return s.keys.empty(); });
  Items items;
  items.noun = "position key";
  keys.list("keys", "its place at times, in place of a velocity: linear between them, at rest before and after",
            MENISCUS_FIELD(keys), items, position_keys());
  return keys;
}

const std::vector<std::pair<const char*, DropShape>> drop_shapes = {
    {"sphere", DropShape::sphere}, {"ellipsoid", DropShape::ellipsoid}, {"box", DropShape::box},
    {"cap", DropShape::cap},       {"scatter", DropShape::scatter},     {"mesh", DropShape::mesh}};

Keys<DropSpec> drop_keys() {
  const std::vector<std::pair<const char*, DropShape>> named(drop_shapes.begin(), drop_shapes.end() - 1);
  Keys<DropSpec> keys;
  keys.choice("shape", "what it is; a drop from a mesh file has the key \"mesh\" in place of it", named, {},
              MENISCUS_FIELD(shape))
      .of({"sphere", "ellipsoid", "box", "cap", "scatter"})
      .required();
  keys.file("mesh", "a closed mesh (OFF, PLY, OBJ, STL), or a frame: each component or marked drop is one drop",
            MENISCUS_FIELD(file))
      .of({"mesh"})
      .required();
  keys.vector("center", "cm", any_number,
              "its centre; a cap sits at the nearest point of its solid; of the box that drops are scattered over",
              MENISCUS_FIELD(center))
      .of({"sphere", "ellipsoid", "box", "cap", "scatter"});
  keys.number("radius", "cm", positive, "its radius; a cap's is that of the ball of the same volume",
              MENISCUS_FIELD(radius))
      .of({"sphere", "cap"})
      .required();
  keys.vector("semi_axes", "cm", positive, "half its lengths along x, y, z before rotation", MENISCUS_FIELD(semi_axes))
      .of({"ellipsoid"})
      .required();
  keys.vector("size", "cm", positive,
              "its edge lengths along x, y, z before rotation; of the box that drops are scattered over",
              MENISCUS_FIELD(size))
      .of({"box", "scatter"})
      .required();
  keys.integer("count", {1, 1e6}, "how many drops", MENISCUS_FIELD(count)).of({"scatter"}).required();
  keys.integer("seed", {0, 2147483647}, "of the random numbers: the same seed, the same drops", MENISCUS_FIELD(seed))
      .of({"scatter"});
  keys.number("radius_min", "cm", positive, "least radius of the ball of a drop's volume", MENISCUS_FIELD(radius_min))
      .of({"scatter"});
  keys.number("radius_max", "cm", positive, "greatest; at least radius_min", MENISCUS_FIELD(radius_max))
      .of({"scatter"});
  keys.choice<ScatterSizes>("sizes", "how the radii are spread: each ratio as often (log_uniform), or each difference",
                            {{"log_uniform", ScatterSizes::log_uniform}, {"uniform", ScatterSizes::uniform}}, {},
                            MENISCUS_FIELD(sizes))
      .of({"scatter"});
  keys.number("gap", "cm", not_negative, "least distance from drop to drop at the start", MENISCUS_FIELD(gap))
      .of({"scatter"});
  keys.text("on",
            "the name of the solid that it sits on, as a cap; a cap needs one; scattered drops without one float as "
            "balls",
            MENISCUS_FIELD(on))
      .of({"cap", "scatter"})
      .note("none");
  keys.optional_angle("angle_deg", {0, 180, true, true}, "its contact angle", MENISCUS_FIELD(angle))
      .of({"cap", "scatter"})
      .note("midway between the solid's two angles");
  keys.number("scale", "", positive, "factor on the mesh, about its origin, first", MENISCUS_FIELD(scale)).of({"mesh"});
  keys.angles("rotate_deg",
              "turns about the fixed axes x, then y, then z; a mesh about its origin, others about the centre",
              MENISCUS_FIELD(rotation))
      .of({"ellipsoid", "box", "mesh"});
  keys.vector("translate", "cm", any_number, "shift of the mesh, last", MENISCUS_FIELD(translation)).of({"mesh"});
  keys.vector("velocity", "cm/s", any_number, "velocity at the start, on top of what a mesh file holds",
              MENISCUS_FIELD(velocity));
  keys.vector("angular_velocity", "rad/s", any_number, "rotation about its centre of mass at the start, likewise",
              MENISCUS_FIELD(angular_velocity));
  return keys;
}

const std::vector<std::pair<const char*, SourceShape>> source_shapes = {{"disc", SourceShape::disc}};

Keys<SourceSpec> source_keys() {
  Keys<SourceSpec> keys;
  keys.choice("shape", "what it is", source_shapes, {}, MENISCUS_FIELD(shape)).required();
  keys.vector("center", "cm", any_number, "its centre", MENISCUS_FIELD(center));
  keys.vector("normal", "", any_number, "where the liquid goes; of any length", MENISCUS_FIELD(normal)).nonzero();
  keys.number("radius", "cm", positive, "its radius", MENISCUS_FIELD(radius));
  keys.number("speed", "cm/s", positive, "of the liquid through it: the volume grows by speed times area times time",
              MENISCUS_FIELD(speed));
  keys.number("start", "s", not_negative, "when the liquid begins to flow", MENISCUS_FIELD(start));
  keys.number("stop", "s", not_negative, "when it ends; later than start", MENISCUS_FIELD(stop))
      .note("never")
      .write_if([](const SourceSpec& source) { return std::isfinite(source.stop); });
  return keys;
}

// What the level "auto" chooses is no value of the scene's.
template <bool GivenKeys::*flag>
bool is_fixed(const Scene& scene) {
  return !scene.accuracy || scene.given.*flag;
}

void add_model(Keys<Scene>& keys) {
  keys.choice<Level>(
          "model",
          "how closely the motion follows physics; \"auto\" takes the cheapest that measurements say is enough",
          {{"paper", Level::paper}, {"calibrated", Level::calibrated}, {"pressure", Level::pressure}},
          {"dispersive", "potential"}, MENISCUS_FIELD(model))
      .also(
          "auto", [](const Scene& scene) { return scene.accuracy.has_value(); },
          [](Scene& scene) { scene.accuracy = scene.accuracy.value_or(Accuracy::shape); });
  keys.choice<Accuracy>(
          "accuracy",
          "what is enough for the model \"auto\", and for it only: sound surfaces (look), the shape at rest "
          "within 1 %, or motion within 2 %, too",
          {{"look", Accuracy::look}, {"shape", Accuracy::shape}, {"motion", Accuracy::motion}}, {},
          MENISCUS_FIELD(accuracy))
      .note("shape");
  keys.integer("substeps", {1, 1000}, "steps that the model takes in one of time_step", MENISCUS_FIELD(substeps))
      .flag(MENISCUS_FIELD(given.substeps))
      .write_if(is_fixed<&GivenKeys::substeps>);
}

void add_sections(Keys<Scene>& keys) {
  keys.section("liquid", "the liquid; the defaults are water",
               Keys<Scene>()
                   .number("density", "g/cm^3", positive, "rho", MENISCUS_FIELD(liquid.density))
                   .number("surface_tension", "g/s^2", not_negative, "sigma", MENISCUS_FIELD(liquid.surface_tension))
                   .number("viscosity", "cm^2/s", not_negative, "nu, kinematic", MENISCUS_FIELD(liquid.viscosity)));
  keys.section("paper", "coefficients of the paper's operators, used by the model \"paper\" only",
               Keys<Scene>()
                   .number("curvature_flow_coefficient", "cm^2/s", not_negative, "gamma (Eq 4)",
                           MENISCUS_FIELD(paper.curvature_flow_coefficient))
                   .number("damping_rate", "1/s", not_negative, "mu (Eq 3)", MENISCUS_FIELD(paper.damping_rate))
                   .number("viscosity_coefficient", "cm^2/s", not_negative, "eta (Eq 3)",
                           MENISCUS_FIELD(paper.viscosity_coefficient))
                   .number("boundary_force", "cm/s", not_negative, "alpha, contact line speed per radian (Eq 8)",
                           MENISCUS_FIELD(paper.boundary_force)));
  keys.choice<VolumeCorrectionMethod>("volume_correction", "how drops keep their volume",
                                      {{"none", VolumeCorrectionMethod::none},
                                       {"local", VolumeCorrectionMethod::local},
                                       {"global", VolumeCorrectionMethod::global},
                                       {"local_then_global", VolumeCorrectionMethod::local_then_global}},
                                      {}, MENISCUS_FIELD(volume_correction))
      .flag(MENISCUS_FIELD(given.volume_correction))
      .write_if(is_fixed<&GivenKeys::volume_correction>);
  keys.section(
      "mesh", "the lengths that remeshing keeps edges in",
      Keys<Scene>()
          .number("edge_min", "cm", positive, "shorter edges are collapsed; less than half of edge_max",
                  MENISCUS_FIELD(mesh.edge_min))
          .number("edge_max", "cm", positive, "longer edges are split", MENISCUS_FIELD(mesh.edge_max))
          .number("wetted_weight", "", {0, 1, true, false},
                  "factor on lengths inside the wetted area: coarser if small", MENISCUS_FIELD(mesh.wetted_weight))
          .number("refinement", "", {1, 10}, "how many times shorter edges may be where the free surface curves",
                  MENISCUS_FIELD(mesh.refinement)));
  keys.section(
      "topology", "what may change a drop's connectivity",
      Keys<Scene>()
          .boolean("merge", "drops that touch become one", MENISCUS_FIELD(topology.merge))
          .boolean("self_merge", "a drop that touches itself fuses there, not only beside a fresh seam",
                   MENISCUS_FIELD(topology.self_merge))
          .boolean("keep_air", "air that merging shuts in stays as a bubble until the drop splits; else it is filled",
                   MENISCUS_FIELD(topology.keep_air))
          .boolean("split", "thin necks pinch off", MENISCUS_FIELD(topology.split)));
  keys.section("solver", "the linear solver of the implicit steps",
               Keys<Scene>()
                   .choice<SolverMethod>("method", "\"auto\" takes the one that is fastest by measurement",
                                         {{"auto", SolverMethod::automatic},
                                          {"conjugate_gradient_jacobi", SolverMethod::conjugate_gradient_jacobi},
                                          {"conjugate_gradient_incomplete_cholesky",
                                           SolverMethod::conjugate_gradient_incomplete_cholesky},
                                          {"cholesky", SolverMethod::cholesky}},
                                         {}, MENISCUS_FIELD(solver.method))
                   .flag(MENISCUS_FIELD(given.solver_method))
                   .write_if(is_fixed<&GivenKeys::solver_method>)
                   .number("tolerance", "", {0, 1, true, true}, "relative residual at which iterations stop",
                           MENISCUS_FIELD(solver.tolerance))
                   .flag(MENISCUS_FIELD(given.solver_tolerance))
                   .write_if(is_fixed<&GivenKeys::solver_tolerance>));
}

void add_lists(Keys<Scene>& keys) {
  Items solids;
  solids.noun = "solid";
  for (const auto& shape : solid_shapes) solids.shapes.push_back(shape.first);
  solids.shape_of = shape_namer<SolidSpec>(solid_shapes);
  solids.finish = [](void* item, const std::set<std::string>& given) {
    SolidSpec& solid = *static_cast<SolidSpec*>(item);
    if (!given.count("receding_angle_deg")) solid.receding_angle = solid.advancing_angle;
  };
  keys.list("solids", "what drops fall on and flow over", MENISCUS_FIELD(solids), solids, solid_keys());

  Items drops;
  drops.noun = "drop";
  for (const auto& shape : drop_shapes) drops.shapes.push_back(shape.first);
  drops.shape_of = shape_namer<DropSpec>(drop_shapes);
  drops.finish = [](void* item, const std::set<std::string>& given) {
    if (given.count("mesh")) static_cast<DropSpec*>(item)->shape = DropShape::mesh;
  };
  keys.list("drops", "the drops at the start; at least one, if there are no sources", MENISCUS_FIELD(drops), drops,
            drop_keys());

  Items sources;
  sources.noun = "source";
  for (const auto& shape : source_shapes) sources.shapes.push_back(shape.first);
  sources.shape_of = shape_namer<SourceSpec>(source_shapes);
  keys.list("sources", "what liquid flows from", MENISCUS_FIELD(sources), sources, source_keys());
}

}  // namespace

const std::vector<Key>& scene_keys() {
  static const std::vector<Key> table = [] {
    Keys<Scene> keys;
    keys.ignored("$schema", "the address of the schema, for editors");
    keys.number("time_step", "s", {0, 1, true, false}, "of one step", MENISCUS_FIELD(time_step));
    keys.integer("frames", {0, 1e7}, "frames to write after the first, which shows the start", MENISCUS_FIELD(frames));
    keys.integer("steps_per_frame", {1, 1e6}, "steps from a frame to the next", MENISCUS_FIELD(steps_per_frame));
    keys.vector("gravity", "cm/s^2", any_number, "acceleration of gravity", MENISCUS_FIELD(gravity));
    keys.boolean("sleep", "drops at rest are not stepped until something comes near", MENISCUS_FIELD(sleep));
    add_model(keys);
    add_sections(keys);
    add_lists(keys);
    return keys.take();
  }();
  return table;
}

std::string Range::describe() const {
  std::string text;
  if (std::isfinite(low)) text = fmt::format("{} {}", is_low_open ? ">" : ">=", low);
  if (std::isfinite(high)) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", is_high_open ? "<" : "<=", high);
  return text;
}

bool Key::applies_to(const std::string& shape) const {
  return shapes.empty() || shape.empty() || std::find(shapes.begin(), shapes.end(), shape) != shapes.end();
}

std::string Key::describe() const {
  std::vector<std::string> parts;
  std::string words;
  switch (kind) {
    case KeyKind::number:
      break;
    case KeyKind::integer:
      parts.emplace_back("a whole number");
      break;
    case KeyKind::boolean:
      parts.emplace_back("true or false");
      break;
    case KeyKind::text:
      parts.emplace_back("text");
      break;
    case KeyKind::file:
      parts.emplace_back("a file");
      break;
    case KeyKind::choice:
      for (const Choice& choice : choices) {
        if (choice.is_available) words += (words.empty() ? "one of " : ", ") + choice.name;
      }
      parts.push_back(words);
      break;
    case KeyKind::vector:
      parts.emplace_back("three numbers");
      break;
    case KeyKind::section:
      parts.emplace_back("an object");
      break;
    case KeyKind::list:
      parts.emplace_back("a list of objects");
      break;
    case KeyKind::ignored:
      parts.emplace_back("anything");
      break;
    case KeyKind::unavailable:
      parts.emplace_back("not available in this version");
      break;
  }
  if (!unit.empty()) parts.push_back(unit);
  if (!range.describe().empty()) parts.push_back(range.describe());
  if (is_nonzero) parts.emplace_back("not all 0");
  if (parts.empty()) parts.emplace_back("a number");
  return fmt::format("{}", fmt::join(parts, ", "));
}

const Key* find_key(const std::vector<Key>& keys, const std::string& name) {
  const auto it = std::find_if(keys.begin(), keys.end(), [&](const Key& key) { return key.name == name; });
  return it == keys.end() ? nullptr : &*it;
}

}  // namespace meniscus::scene_detail

#undef MENISCUS_FIELD
