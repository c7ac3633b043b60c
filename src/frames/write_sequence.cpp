// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/frames/write_sequence.h"

#include "glb.h"
#include "meniscus/core/error.h"
#include "meniscus/frames/frame_time.h"
#include "meniscus/io/read_mesh.h"
#include "meniscus/io/write_file_atomically.h"
#include "usda.h"

#include <fmt/format.h>

namespace meniscus {
namespace {

namespace fs = std::filesystem;

/// The times that the frames tell, or even ones if any of them is silent.
std::vector<double> times_of(const std::vector<fs::path>& frames) {
  std::vector<double> times;
  for (const fs::path& frame : frames) {
    const std::optional<double> time = frame_time(read_mesh(frame));
    if (!time) {
      times.clear();
      for (std::size_t k = 0; k < frames.size(); ++k) times.push_back(static_cast<double>(k) / 24);
      break;
    }
    times.push_back(*time);
  }
  return times;
}

}  // namespace

void write_sequence(const fs::path& output, FrameFormat format, const std::vector<fs::path>& frames) {
  if (format != FrameFormat::usda && format != FrameFormat::glb)
    throw UsageError(fmt::format("{}: a {} file holds one frame; use usda or glb for all of them", output.string(),
                                 format_name(format)));
  const std::vector<double> times = times_of(frames);
  std::size_t at = 0;
  const auto read = [&](std::size_t k) { return read_mesh(frames[at = k]); };
  try {
    if (format == FrameFormat::glb) return write_file_atomically(output, glb_flipbook(times, read, output.string()));
    UsdaSequence sequence;
    for (std::size_t k = 0; k < frames.size(); ++k) sequence.add(read(k), times[k]);
    write_file_atomically(output, sequence.text());
  } catch (const GeometryError& error) {
    throw GeometryError(frames[at].string() + ": " + error.what(), error.faces(), error.vertices());
  }
}

}  // namespace meniscus
