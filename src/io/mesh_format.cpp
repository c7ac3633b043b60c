// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/io/mesh_format.h"

#include "meniscus/core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>

namespace meniscus {
namespace {

std::optional<MeshFormat> find_format(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  for (const MeshFormat format : {MeshFormat::ply, MeshFormat::off, MeshFormat::obj, MeshFormat::stl})
    if (name == format_name(format)) return format;
  return std::nullopt;
}

}  // namespace

MeshFormat format_of(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  const auto format = find_format(extension.empty() ? extension : extension.substr(1));
  if (!format)
    throw UsageError(fmt::format("{}: the extension \"{}\" names no mesh format; use .ply, .off, .obj or .stl",
                                 path.string(), extension));
  return *format;
}

MeshFormat parse_format(std::string_view name) {
  const auto format = find_format(std::string(name));
  if (!format) throw UsageError(fmt::format("\"{}\" is no mesh format; use ply, off, obj or stl", name));
  return *format;
}

std::string_view format_name(MeshFormat format) {
  switch (format) {
    case MeshFormat::ply:
      return "ply";
    case MeshFormat::off:
      return "off";
    case MeshFormat::obj:
      return "obj";
    case MeshFormat::stl:
      break;
  }
  return "stl";
}

}  // namespace meniscus
