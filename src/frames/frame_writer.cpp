// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/frames/frame_writer.h"

#include "meniscus/core/error.h"
#include "meniscus/frames/checkpoint_archive.h"
#include "meniscus/frames/frame_time.h"
#include "meniscus/frames/measures.h"
#include "meniscus/frames/write_sequence.h"
#include "meniscus/io/write_file_atomically.h"
#include "vtp.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <system_error>

namespace meniscus {
namespace {

namespace fs = std::filesystem;

constexpr const char* measures_name = "measures.csv";
constexpr const char* collection_name = "frames.pvd";
constexpr const char* sequence_name = "frames.usda";

[[noreturn]] void fail(const fs::path& path, const std::string& what, const std::error_code& error) {
  throw FileError(fmt::format("{}: {} ({}); check the directory, its permissions and the space left", path.string(),
                              what, error.message()));
}

bool is_of_all_frames(const std::string& name) { return name == collection_name || name == sequence_name; }

/// The number in a name that is_frame_name knows.
int frame_number(const std::string& name) {
  int frame = std::numeric_limits<int>::max();  // stays if there are too many digits
  std::from_chars(name.data() + name.find('_') + 1, name.data() + name.size(), frame);
  return frame;
}

/// Removes the frames after `last`.
void remove_frames(const fs::path& directory, int last) {
  std::vector<fs::path> old;
  for (const auto& entry : fs::directory_iterator(directory)) {
    const std::string name = entry.path().filename().string();
    const bool is_later = is_frame_name(name) ? frame_number(name) > last : last < 0 && is_of_all_frames(name);
    if (is_later && entry.symlink_status().type() == fs::file_type::regular) old.push_back(entry.path());
  }
  for (const fs::path& path : old) fs::remove(path);
}

void prepare(const fs::path& directory, bool meshes, int last_frame) {
  std::error_code error;
  fs::create_directories(directory, error);
  if (error || !fs::is_directory(directory)) {
    if (!error) error = std::make_error_code(std::errc::not_a_directory);
    fail(directory, "cannot be made the directory of the frames", error);
  }
  try {
    if (meshes) remove_frames(directory, last_frame);
  } catch (const fs::filesystem_error& e) {
    fail(e.path1(), "an older frame cannot be removed", e.code());
  }
}

}  // namespace

FrameWriter::FrameWriter(fs::path directory, FrameOptions options)
    : directory_(std::move(directory)), options_(std::move(options)) {
  prepare(directory_, options_.meshes, -1);
  write_file_atomically(directory_ / measures_name, measures_header());
  measures_bytes_ = measures_header().size();
}

FrameWriter::FrameWriter(fs::path directory, FrameOptions options, CheckpointReader& checkpoint)
    : directory_(std::move(directory)), options_(std::move(options)) {
  checkpoint("frames", *this);
  prepare(directory_, options_.meshes, last_frame_);
  const fs::path path = directory_ / measures_name;
  std::error_code error;
  const auto size = fs::file_size(path, error);
  if (!error && size < measures_bytes_)
    throw FileError(fmt::format("{}: is shorter than when the checkpoint was taken: {} bytes of {}; start over",
                                path.string(), size, measures_bytes_));
  if (!error) fs::resize_file(path, measures_bytes_, error);
  if (error) fail(path, "cannot be continued", error);
  if (options_.meshes && !vtp_frames_.empty()) write_collection();
}

void FrameWriter::write(int frame, double time, const std::vector<Drop>& drops) {
  if (options_.meshes) write_meshes(frame, time, drops);
  std::string rows;
  for (const Drop& drop : drops) rows += measures_row(time, measure_drop(drop, options_.density));
  append_measures(rows);
  ++num_frames_;
  last_frame_ = frame;
}

void FrameWriter::append_measures(const std::string& rows) {
  append_to_file(directory_ / measures_name, rows);
  measures_bytes_ += rows.size();
}

void FrameWriter::write_meshes(int frame, double time, const std::vector<Drop>& drops) {
  MeshData data = to_mesh_data(drops);
  data.comments.insert(data.comments.begin(), fmt::format("time {:.17g}", time));
  for (const FrameFormat format : options_.formats) {
    if (format == FrameFormat::usda) continue;  // finish() writes all of them
    const std::string name = frame_name(frame, format);
    write_frame(directory_ / name, format, data, time);
    if (format != FrameFormat::vtp) continue;
    vtp_times_.push_back(time);
    vtp_frames_.push_back(frame);
    write_collection();
  }
}

void FrameWriter::finish() const {
  const auto& formats = options_.formats;
  if (options_.meshes && std::find(formats.begin(), formats.end(), FrameFormat::usda) != formats.end())
    write_sequence(directory_ / sequence_name, FrameFormat::usda, find_frames(directory_));
}

void FrameWriter::write_collection() const {
  std::vector<std::pair<double, std::string>> files;
  for (std::size_t k = 0; k < vtp_frames_.size(); ++k)
    files.emplace_back(vtp_times_[k], frame_name(vtp_frames_[k], FrameFormat::vtp));
  write_file_atomically(directory_ / collection_name, pvd_text(files));
}

}  // namespace meniscus
