// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/frames/frame_format.h"
#include "meniscus/state/drop.h"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace meniscus {

/// What a run writes beside its table of measures.
struct FrameOptions {
  bool meshes = true;                                  ///< false: measures.csv only
  std::vector<FrameFormat> formats{FrameFormat::ply};  ///< of the frames' meshes
  double density = 1;                                  ///< g/cm^3, for the momentum
};

/// Writes the frames of a run into a directory: the meshes, one file a frame and format, each whole
/// or not at all, and measures.csv, which grows by whole lines.
class FrameWriter {
 public:
  /// Makes the directory if need be, starts measures.csv and removes what an older run left:
  /// files that is_frame_name knows, and nothing else (nothing at all without options.meshes).
  /// Throws FileError if any of this fails.
  FrameWriter(std::filesystem::path directory, FrameOptions options = {});

  /// Writes all drops as one frame: PLY as to_mesh_data(drops) with a comment "time <s>" before the
  /// others; measures.csv gains a line a drop. No drops give an empty mesh. frame >= 0, time in s.
  /// With VTP, frames.pvd is written anew: ParaView's list of the frames so far with their times.
  /// Throws FileError.
  void write(int frame, double time, const std::vector<Drop>& drops);

  /// Writes what needs all frames: frames.usda, if asked for. Call it when the run ends.
  /// Throws FileError.
  void finish() const;

  int num_frames() const { return num_frames_; }  ///< written so far

 private:
  void write_meshes(int frame, double time, const std::vector<Drop>& drops);
  void append_measures(const std::string& rows) const;

  std::filesystem::path directory_;
  FrameOptions options_;
  std::vector<std::pair<double, std::string>> collection_;  // times and names of the VTP frames
  int num_frames_ = 0;
};

}  // namespace meniscus
