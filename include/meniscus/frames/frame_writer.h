// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/frames/frame_format.h"
#include "meniscus/state/drop.h"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace meniscus {

class CheckpointReader;

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
  /// Goes on where a checkpoint was taken: measures.csv is cut to what it was then, and later frames are
  /// removed. Throws FileError, also if measures.csv is shorter than it was.
  FrameWriter(std::filesystem::path directory, FrameOptions options, CheckpointReader& checkpoint);

  /// Writes all drops as one frame: PLY as to_mesh_data(drops) with a comment "time <s>" before the
  /// others; measures.csv gains a line a drop. No drops give an empty mesh. frame >= 0, time in s.
  /// With VTP, frames.pvd is written anew: ParaView's list of the frames so far with their times.
  /// Throws FileError.
  void write(int frame, double time, const std::vector<Drop>& drops);

  /// Writes what needs all frames: frames.usda, if asked for. Call it when the run ends.
  /// Throws FileError.
  void finish() const;

  int num_frames() const { return num_frames_; }  ///< written so far

  /// For checkpoints: see frames/checkpoint_archive.h.
  template <class Self, class Archive>
  static void visit(Self& self, Archive& archive) {
    archive("num_frames", self.num_frames_);
    archive("last_frame", self.last_frame_);
    archive("measures_bytes", self.measures_bytes_);
    archive("vtp_times", self.vtp_times_);
    archive("vtp_frames", self.vtp_frames_);
  }

 private:
  void write_meshes(int frame, double time, const std::vector<Drop>& drops);
  void append_measures(const std::string& rows);
  void write_collection() const;

  std::filesystem::path directory_;
  FrameOptions options_;
  int num_frames_ = 0, last_frame_ = -1;
  std::uint64_t measures_bytes_ = 0;  // of measures.csv
  std::vector<double> vtp_times_;     // of the VTP frames, for frames.pvd
  std::vector<int> vtp_frames_;
};

}  // namespace meniscus
