// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/topology/split.h"
#include "step_parts.h"

namespace meniscus {
namespace {

RemeshOptions remesh_options(const StepOptions& step) {
  RemeshOptions options;
  options.band = step.band;
  options.cut_necks = step.split;
  return options;
}

}  // namespace

std::vector<Drop> remesh_and_split(Drop drop, const StepOptions& options, Remesher& remesher, StageClock& clock,
                                   StepReport& report) {
  std::vector<Drop> pieces;
  RemeshReport remeshed;
  if (options.remesh) remeshed = remesher.remesh(drop, remesh_options(options));
  report.edge_operations += remeshed.splits + remeshed.collapses + remeshed.flips + remeshed.lifts;
  report.cuts += remeshed.cuts;
  clock.done(Stage::remesh);

  if (remeshed.cuts > 0) {
    SplitReport split;
    pieces = split_components(std::move(drop), split);
    report.deleted += split.deleted + split.deleted_empty;
  } else {
    pieces.push_back(std::move(drop));
  }
  clock.done(Stage::split);
  return pieces;
}

}  // namespace meniscus
