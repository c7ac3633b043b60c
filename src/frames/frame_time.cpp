// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/frames/frame_time.h"

#include "meniscus/core/error.h"
#include "meniscus/frames/frame_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace meniscus {
namespace {

namespace fs = std::filesystem;

/// Longer numbers come later, as frame_9999.ply, frame_10000.ply do.
bool is_before(const fs::path& a, const fs::path& b) {
  const std::string left = a.filename().string(), right = b.filename().string();
  return left.size() != right.size() ? left.size() < right.size() : left < right;
}

}  // namespace

std::optional<double> frame_time(const MeshData& data) {
  for (const std::string& comment : data.comments) {
    if (comment.rfind("time ", 0) != 0) continue;
    const char* start = comment.c_str() + 5;
    char* end = nullptr;
    const double time = std::strtod(start, &end);
    if (end != start && *end == '\0' && std::isfinite(time)) return time;
  }
  return std::nullopt;
}

std::vector<fs::path> find_frames(const fs::path& directory) {
  std::vector<fs::path> frames;
  std::error_code error;
  for (fs::directory_iterator entry(directory, error), end; !error && entry != end; entry.increment(error))
    if (is_frame_name(entry->path().filename().string()) && entry->path().extension() == ".ply")
      frames.push_back(entry->path());
  if (error) throw FileError(fmt::format("{}: cannot be listed ({})", directory.string(), error.message()));
  std::sort(frames.begin(), frames.end(), is_before);
  return frames;
}

}  // namespace meniscus
