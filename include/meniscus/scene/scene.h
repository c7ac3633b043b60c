// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/geometry/solve_spd.h"
#include "meniscus/state/parameters.h"

#include <Eigen/Core>

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

/// A scene as its file describes it: plain values, nothing built yet. cm, g, s; radians.
/// docs/SCENE.md explains every key; the defaults below are the file's defaults.
namespace meniscus {

inline constexpr double pi = 3.14159265358979323846;

enum class SolidShape { plane, sphere, box, cylinder, capsule, mesh };
enum class DropShape { sphere, ellipsoid, box, cap, scatter, mesh };
/// How the radii of scattered drops are spread between their bounds.
enum class ScatterSizes { log_uniform, uniform };

/// Where a moving solid is at a time, as a displacement from the place that its shape gives.
/// Linear between keys; held before the first and after the last.
struct PositionKey {
  double time = 0;                                     ///< s
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< cm
};

/// A solid. Only the parameters of its shape count.
struct SolidSpec {
  std::string name;  ///< empty, or unlike every other solid's
  SolidShape shape = SolidShape::plane;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();        ///< plane: a point of it, cm
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();      ///< plane: out of the solid; any length but zero
  Eigen::Vector3d center = Eigen::Vector3d::Zero();       ///< sphere, box: cm
  double radius = 1;                                      ///< sphere, cylinder, capsule: cm
  Eigen::Vector3d size = Eigen::Vector3d::Ones();         ///< box: full edge lengths, cm
  Eigen::Vector3d from = Eigen::Vector3d::Zero();         ///< cylinder, capsule: one end of the axis, cm
  Eigen::Vector3d to = Eigen::Vector3d::UnitZ();          ///< cylinder, capsule: the other end, cm
  std::filesystem::path file;                             ///< mesh: as written; see Scene::locate
  double scale = 1;                                       ///< mesh: applied first, about the origin
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();     ///< box, mesh: about x, then y, then z (fixed axes)
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< mesh: applied last, cm
  std::optional<double> edge_radius;                      ///< box, cylinder: of their edges, cm; none: edge_min
  double advancing_angle = pi / 2;
  double receding_angle = pi / 2;                      ///< at most the advancing angle
  double friction_speed = 0.1;                         ///< epsilon of Eq 2, cm/s
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< cm/s; zero if there are keys
  std::vector<PositionKey> keys;                       ///< strictly increasing in time
};

/// A drop at the start. Only the parameters of its shape count.
struct DropSpec {
  DropShape shape = DropShape::sphere;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< cm; cap: its middle is the solid's nearest point to this
  double radius = 0.2;                               ///< sphere: cm; cap: of the ball of the same volume
  Eigen::Vector3d semi_axes = Eigen::Vector3d::Constant(0.2);  ///< ellipsoid: along x, y, z before rotation, cm
  Eigen::Vector3d size = Eigen::Vector3d::Constant(0.3);       ///< box: full edge lengths, cm
  std::string on;               ///< cap: the name of the solid that it sits on; scatter: likewise, or empty
  std::optional<double> angle;  ///< cap, scatter: the contact angle; none: midway between the solid's two angles
  int count = 100;              ///< scatter: how many drops; `center` and `size` are the box that they come from
  int seed = 1;                 ///< scatter: of its random numbers
  double radius_min = 0.05, radius_max = 0.2;                  ///< scatter: of the balls of the drops' volumes, cm
  ScatterSizes sizes = ScatterSizes::log_uniform;              ///< scatter
  double gap = 0;                                              ///< scatter: the least distance between drops, cm
  std::filesystem::path file;                                  ///< mesh: as written; see Scene::locate
  double scale = 1;                                            ///< mesh: applied first, about the origin
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();          ///< ellipsoid, box (about center), mesh: as for solids
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();       ///< mesh: applied last, cm
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< cm/s; adds to what a mesh file holds
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< rad/s, about the centre of mass; adds as well
};

enum class SourceShape { disc };

/// A disc from which liquid flows.
struct SourceSpec {
  SourceShape shape = SourceShape::disc;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();       ///< cm
  Eigen::Vector3d normal{0, 0, -1};                       ///< where the liquid goes; any length but zero
  double radius = 0.1;                                    ///< cm
  double speed = 10;                                      ///< of the liquid through the disc, cm/s
  double start = 0;                                       ///< s
  double stop = std::numeric_limits<double>::infinity();  ///< s, > start
};

/// What may change a drop's connectivity.
struct Topology {
  bool merge = true;        ///< drops that touch become one
  bool self_merge = false;  ///< a drop that touches itself fuses there; else only beside a fresh seam
  bool keep_air = false;    ///< air that merging shuts in stays as a bubble if the mesh can hold it; else it is filled
  bool split = true;        ///< necks pinch off
};

/// What the level "auto" has to reach, in numbers: simulation/choose_model.h.
enum class Accuracy {
  look,    ///< sound surfaces that keep their volume, at the least cost
  shape,   ///< and drops at rest of the right shape
  motion,  ///< and drops that swing at the right frequency, undamped but for their viscosity
};

/// What of the keys that the level "auto" may choose a scene has set itself: that is left alone.
struct GivenKeys {
  bool volume_correction = false;
  bool solver_method = false;
  bool solver_tolerance = false;
  bool substeps = false;
};

struct Scene {
  double time_step = 1.0 / 240;  ///< of one step, s
  int frames = 120;              ///< frames after the first, which shows the start
  int steps_per_frame = 4;
  Eigen::Vector3d gravity{0, 0, -981};  ///< cm/s^2
  Liquid liquid;
  Level model = Level::calibrated;   ///< without effect if there is an accuracy
  std::optional<Accuracy> accuracy;  ///< the level "auto": the model, and what is not given, is chosen for it
  GivenKeys given;                   ///< read only if there is an accuracy
  int substeps = 1;                  ///< steps that the model takes in one of time_step
  PaperCoefficients paper;
  VolumeCorrectionMethod volume_correction = VolumeCorrectionMethod::global;
  EdgeBand mesh;
  Topology topology;
  SolverOptions solver;  ///< max_iterations is not part of the file
  std::vector<SolidSpec> solids;
  std::vector<DropSpec> drops;
  std::vector<SourceSpec> sources;
  bool sleep = false;  ///< drops at rest are not stepped until something comes near

  std::filesystem::path file;       ///< where the scene came from; empty if from no file
  std::filesystem::path directory;  ///< what relative file names in it are relative to

  /// A file that the scene names, ready to open.
  std::filesystem::path locate(const std::filesystem::path& named) const {
    return (directory / named).lexically_normal();
  }
};

/// No number of a scene, nor a coordinate of a mesh that it names, is larger in magnitude.
inline constexpr double largest_magnitude = 1e9;

/// The scene that meshes given without a scene evolve in: all defaults, no solids, no drops yet.
Scene default_scene();

}  // namespace meniscus
