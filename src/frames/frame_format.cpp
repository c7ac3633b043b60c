// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/frames/frame_format.h"

#include "glb.h"
#include "meniscus/core/error.h"
#include "meniscus/io/write_file_atomically.h"
#include "meniscus/io/write_mesh.h"
#include "usda.h"
#include "vtp.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

constexpr FrameFormat all_formats[] = {FrameFormat::ply, FrameFormat::off, FrameFormat::obj,
                                       FrameFormat::vtp, FrameFormat::glb, FrameFormat::usda};
constexpr std::string_view names[] = {"ply", "off", "obj", "vtp", "glb", "usda"};

}  // namespace

std::string_view format_name(FrameFormat format) { return names[static_cast<std::size_t>(format)]; }

std::optional<FrameFormat> find_frame_format(std::string_view name) {
  for (const FrameFormat format : all_formats)
    if (name == format_name(format)) return format;
  return std::nullopt;
}

std::vector<FrameFormat> parse_frame_formats(std::string_view list) {
  std::vector<FrameFormat> formats{FrameFormat::ply};
  for (std::size_t start = 0; start <= list.size();) {
    const std::size_t end = std::min(list.find(',', start), list.size());
    const std::string_view name = list.substr(start, end - start);
    const std::optional<FrameFormat> format = find_frame_format(name);
    if (!format)
      throw UsageError(
          fmt::format("\"{}\" is no format of frames; use {}, joined by commas", name, fmt::join(names, ", ")));
    if (std::find(formats.begin(), formats.end(), *format) == formats.end()) formats.push_back(*format);
    start = end + 1;
  }
  return formats;
}

std::string frame_name(int frame, FrameFormat format) {
  return fmt::format("frame_{:04}.{}", frame, format_name(format));
}

bool is_frame_name(std::string_view name) {
  constexpr std::string_view start = "frame_";
  if (name.substr(0, start.size()) != start) return false;
  name.remove_prefix(start.size());
  const std::size_t digits = std::min(name.find_first_not_of("0123456789"), name.size());
  if (digits < 4 || (digits > 4 && name.front() == '0') || digits == name.size() || name[digits] != '.') return false;
  return find_frame_format(name.substr(digits + 1)).has_value();
}

void write_frame(const std::filesystem::path& path, FrameFormat format, const MeshData& data, double time) {
  switch (format) {
    case FrameFormat::vtp:
      return write_file_atomically(path, vtp_bytes(data, time));
    case FrameFormat::glb:
      return write_file_atomically(path, glb_still(data));
    case FrameFormat::usda:
      return write_file_atomically(path, usda_still(data));
    default:
      return write_mesh(path, data);
  }
}

}  // namespace meniscus
