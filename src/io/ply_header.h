// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/mesh_data.h"
#include "source.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace meniscus::io {

enum class PlyEncoding { ascii, binary_little_endian, binary_big_endian };

struct PlyProperty {
  std::string name;
  ScalarType type;                       ///< of the value, or of each of a list's
  std::optional<ScalarType> count_type;  ///< of a list's length; none: not a list
};

struct PlyElement {
  std::string name;
  std::int64_t count;
  std::size_t line;  ///< of the header
  std::vector<PlyProperty> properties;

  /// The index of a property, if it is there.
  std::optional<std::size_t> find(std::string_view property) const;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::ascii;
  std::vector<PlyElement> elements;
  std::vector<std::string> comments;
  std::size_t body = 0, body_line = 0;  ///< where the data begins: offset and line
};

/// Reads the header and checks that the counts can be true given the bytes that follow.
PlyHeader read_ply_header(const Source& source);

/// The classic name, as "uchar"; reading takes "uint8" as well.
const char* ply_name(ScalarType type);

/// Calls f with a value-initialised number of the C++ type that `type` stands for.
template <class F>
decltype(auto) visit_scalar(ScalarType type, F&& f) {
  switch (type) {
    case ScalarType::int8:
      return f(std::int8_t{});
    case ScalarType::uint8:
      return f(std::uint8_t{});
    case ScalarType::int16:
      return f(std::int16_t{});
    case ScalarType::uint16:
      return f(std::uint16_t{});
    case ScalarType::int32:
      return f(std::int32_t{});
    case ScalarType::uint32:
      return f(std::uint32_t{});
    case ScalarType::float32:
      return f(float{});
    case ScalarType::float64:
      break;
  }
  return f(double{});
}

inline std::size_t byte_size(ScalarType type) {
  return visit_scalar(type, [](auto number) { return sizeof number; });
}

}  // namespace meniscus::io
