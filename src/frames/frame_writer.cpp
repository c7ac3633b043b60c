// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/frames/frame_writer.h"

#include "meniscus/core/error.h"
#include "meniscus/frames/frame_time.h"
#include "meniscus/frames/measures.h"
#include "meniscus/frames/write_sequence.h"
#include "meniscus/io/write_file_atomically.h"
#include "vtp.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
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

bool is_written(const std::string& name) {
  return is_frame_name(name) || name == collection_name || name == sequence_name;
}

void remove_old_frames(const fs::path& directory) {
  std::vector<fs::path> old;
  for (const auto& entry : fs::directory_iterator(directory))
    if (is_written(entry.path().filename().string()) && entry.symlink_status().type() == fs::file_type::regular)
      old.push_back(entry.path());
  for (const fs::path& path : old) fs::remove(path);
}

void prepare(const fs::path& directory, bool meshes) {
  std::error_code error;
  fs::create_directories(directory, error);
  if (error || !fs::is_directory(directory)) {
    if (!error) error = std::make_error_code(std::errc::not_a_directory);
    fail(directory, "cannot be made the directory of the frames", error);
  }
  try {
    if (meshes) remove_old_frames(directory);
  } catch (const fs::filesystem_error& e) {
    fail(e.path1(), "an older run's frame cannot be removed", e.code());
  }
}

}  // namespace

FrameWriter::FrameWriter(fs::path directory, FrameOptions options)
    : directory_(std::move(directory)), options_(std::move(options)) {
  prepare(directory_, options_.meshes);
  write_file_atomically(directory_ / measures_name, measures_header());
}

void FrameWriter::write(int frame, double time, const std::vector<Drop>& drops) {
  if (options_.meshes) write_meshes(frame, time, drops);
  std::string rows;
  for (const Drop& drop : drops) rows += measures_row(time, measure_drop(drop, options_.density));
  append_measures(rows);
  ++num_frames_;
}

void FrameWriter::write_meshes(int frame, double time, const std::vector<Drop>& drops) {
  MeshData data = to_mesh_data(drops);
  data.comments.insert(data.comments.begin(), fmt::format("time {:.17g}", time));
  for (const FrameFormat format : options_.formats) {
    if (format == FrameFormat::usda) continue;  // finish() writes all of them
    const std::string name = frame_name(frame, format);
    write_frame(directory_ / name, format, data, time);
    if (format != FrameFormat::vtp) continue;
    collection_.emplace_back(time, name);
    write_file_atomically(directory_ / collection_name, pvd_text(collection_));
  }
}

void FrameWriter::finish() const {
  const auto& formats = options_.formats;
  if (options_.meshes && std::find(formats.begin(), formats.end(), FrameFormat::usda) != formats.end())
    write_sequence(directory_ / sequence_name, FrameFormat::usda, find_frames(directory_));
}

void FrameWriter::append_measures(const std::string& rows) const {
  const fs::path path = directory_ / measures_name;
  std::error_code error;
  const auto size = fs::file_size(path, error);
  if (error) fail(path, "cannot be written", error);
  std::ofstream out(path, std::ios::binary | std::ios::app);
  out.write(rows.data(), static_cast<std::streamsize>(rows.size()));
  out.close();
  if (out) return;
  error = {errno, std::generic_category()};
  std::error_code ignored;
  fs::resize_file(path, size, ignored);  // no half lines
  fail(path, "cannot be written", error);
}

}  // namespace meniscus
