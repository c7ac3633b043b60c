// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/scene/scene.h"
#include "meniscus/simulation/source.h"
#include "meniscus/simulation/step.h"

#include <vector>

namespace meniscus {

/// Drops that start within this distance of a solid start on it (cm).
inline constexpr double contact_tolerance = 1e-9;

/// The solids that a scene describes, and behind them the discs of its sources. Throws FileError, UsageError or
/// GeometryError, naming the solid.
std::vector<Solid> make_solids(const Scene& scene);

/// The drops that a scene describes, numbered from 0 in its order; a mesh file of several drops
/// gives them all. Throws FileError, UsageError or GeometryError, naming the drop.
std::vector<Drop> make_drops(const Scene& scene, const std::vector<Solid>& solids);

/// The options of a step that a scene asks for.
StepOptions make_step_options(const Scene& scene);

/// Drops and solids that go through time together. Drops are stepped in parallel (TBB); the result
/// does not depend on the number of threads.
class Simulation {
 public:
  /// Builds everything that the scene describes.
  explicit Simulation(const Scene& scene);
  /// The scene's solids and parameters, with these drops instead of its own.
  Simulation(const Scene& scene, std::vector<Drop> drops);

  /// Takes one step of scene.time_step. Throws NumericsError; the state is then that before the step
  /// for some drops and after it for others, and fit for inspection only.
  StepReport step();

  const std::vector<Drop>& drops() const { return drops_; }
  const std::vector<Solid>& solids() const { return solids_; }
  double time() const { return time_; }                 ///< s
  std::size_t num_steps() const { return num_steps_; }  ///< taken so far
  double volume() const;                                ///< of all drops, cm^3
  double target_volume() const;                         ///< of all drops, cm^3
  /// For stage times: see StepOptions::clock.
  void set_clock(double (*clock)()) { options_.clock = clock; }

 private:
  std::vector<Solid> solids_;
  std::vector<Drop> drops_;
  StepOptions options_;
  SourceFeed feed_;
  bool sleep_ = false;
  double time_step_ = 0, time_ = 0;
  std::size_t num_steps_ = 0;
  int next_id_ = 0;
};

}  // namespace meniscus
