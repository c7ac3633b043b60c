// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/io/mesh_format.h"
#include "meniscus/state/drop.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace meniscus {

class CheckpointReader;

/// What a run writes beside its table of measures.
struct FrameOptions {
  bool meshes = true;                                ///< false: measures.csv only
  std::vector<MeshFormat> formats{MeshFormat::ply};  ///< of the frames' meshes: PLY, OFF, OBJ
  double density = 1;                                ///< g/cm^3, for the momentum
};

/// The formats of a list like "ply,off,obj", PLY always first (it alone holds velocities), each once.
/// Throws UsageError for a name that is no format of frames, saying so of those still to come
/// (vtp, glb, usda).
std::vector<MeshFormat> parse_frame_formats(std::string_view list);

/// "frame_0042.ply"; more than four digits from frame 10000 on.
std::string frame_name(int frame, MeshFormat format);

/// Whether a file's name is one that frame_name gives.
bool is_frame_name(std::string_view name);

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
  /// Throws FileError.
  void write(int frame, double time, const std::vector<Drop>& drops);

  int num_frames() const { return num_frames_; }  ///< written so far

  /// For checkpoints: see frames/checkpoint_archive.h.
  template <class Self, class Archive>
  static void visit(Self& self, Archive& archive) {
    archive("num_frames", self.num_frames_);
    archive("last_frame", self.last_frame_);
    archive("measures_bytes", self.measures_bytes_);
  }

 private:
  void append_measures(const std::string& rows);

  std::filesystem::path directory_;
  FrameOptions options_;
  int num_frames_ = 0, last_frame_ = -1;
  std::uint64_t measures_bytes_ = 0;  // of measures.csv
};

}  // namespace meniscus
