// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/frames/frame_writer.h"

#include "meniscus/core/error.h"
#include "meniscus/frames/checkpoint_archive.h"
#include "meniscus/frames/measures.h"
#include "meniscus/io/write_file_atomically.h"
#include "meniscus/io/write_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <system_error>

namespace meniscus {
namespace {

namespace fs = std::filesystem;

constexpr const char* measures_name = "measures.csv";
constexpr MeshFormat frame_formats[] = {MeshFormat::ply, MeshFormat::off, MeshFormat::obj};
constexpr const char* later_formats[] = {"vtp", "glb", "usda"};

[[noreturn]] void fail(const fs::path& path, const std::string& what, const std::error_code& error) {
  throw FileError(fmt::format("{}: {} ({}); check the directory, its permissions and the space left", path.string(),
                              what, error.message()));
}

MeshFormat parse_frame_format(std::string_view name) {
  for (const MeshFormat format : frame_formats)
    if (name == format_name(format)) return format;
  if (std::find(std::begin(later_formats), std::end(later_formats), name) != std::end(later_formats))
    throw UsageError(fmt::format("frames as {}: not available in this version; use ply, off or obj", name));
  throw UsageError(fmt::format("\"{}\" is no format of frames; use ply, off or obj, joined by commas", name));
}

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
    if (is_frame_name(name) && frame_number(name) > last && entry.symlink_status().type() == fs::file_type::regular)
      old.push_back(entry.path());
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

std::vector<MeshFormat> parse_frame_formats(std::string_view list) {
  std::vector<MeshFormat> formats{MeshFormat::ply};
  for (std::size_t start = 0; start <= list.size();) {
    const std::size_t end = std::min(list.find(',', start), list.size());
    const MeshFormat format = parse_frame_format(list.substr(start, end - start));
    if (std::find(formats.begin(), formats.end(), format) == formats.end()) formats.push_back(format);
    start = end + 1;
  }
  return formats;
}

std::string frame_name(int frame, MeshFormat format) {
  return fmt::format("frame_{:04}.{}", frame, format_name(format));
}

bool is_frame_name(std::string_view name) {
  constexpr std::string_view start = "frame_";
  if (name.substr(0, start.size()) != start) return false;
  name.remove_prefix(start.size());
  const std::size_t digits = std::min(name.find_first_not_of("0123456789"), name.size());
  if (digits < 4 || (digits > 4 && name.front() == '0') || digits == name.size() || name[digits] != '.') return false;
  return std::any_of(std::begin(frame_formats), std::end(frame_formats),
                     [&](MeshFormat format) { return name.substr(digits + 1) == format_name(format); });
}

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
}

void FrameWriter::write(int frame, double time, const std::vector<Drop>& drops) {
  if (options_.meshes) {
    MeshData data = to_mesh_data(drops);
    data.comments.insert(data.comments.begin(), fmt::format("time {:.17g}", time));
    for (const MeshFormat format : options_.formats) write_mesh(directory_ / frame_name(frame, format), data);
  }
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

}  // namespace meniscus
