// SPDX-License-Identifier: GPL-3.0-or-later
#include "byte_order.h"
#include "formats.h"
#include "ply_header.h"
#include "soup_builder.h"
#include "text_scanner.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace meniscus::io {
namespace {

/// The values of an ascii body: one element a line.
class AsciiValues {
 public:
  static constexpr Place::Kind kPlaces = Place::Kind::line;

  AsciiValues(const Source& source, const PlyHeader& header) : in_(source) { in_.jump(header.body, header.body_line); }

  void begin(const PlyElement& element, std::int64_t index) {
    if (!in_.next_line())
      in_.fail(fmt::format("the file ends after {} of {} elements {}; it is truncated or the count is wrong", index,
                           element.count, quote(element.name)));
  }
  template <class Number>
  Number get() {
    if constexpr (std::is_floating_point_v<Number>) {
      return in_.number<Number>("a value");
    } else {
      const auto value = in_.number<std::int64_t>("a value");
      if (value < std::int64_t{std::numeric_limits<Number>::min()} ||
          value > std::int64_t{std::numeric_limits<Number>::max()})
        in_.fail(fmt::format("{} does not fit the property's type; declare a wider one", value));
      return static_cast<Number>(value);
    }
  }
  /// Text is taken at its word, whether the header says float or double.
  double coordinate(ScalarType) { return in_.number<double>("a coordinate"); }
  void end() { in_.expect_line_end("the element's properties"); }
  void finish() {
    if (in_.next_line()) in_.fail("the file goes on after its last element; correct the counts in the header");
  }
  Place place() const { return in_.place(); }

 private:
  TextScanner in_;
};

/// The values of a binary body.
class BinaryValues {
 public:
  static constexpr Place::Kind kPlaces = Place::Kind::byte;

  BinaryValues(const Source& source, const PlyHeader& header)
      : source_(source),
        at_(header.body),
        record_(at_),
        is_big_endian_(header.encoding == PlyEncoding::binary_big_endian) {}

  void begin(const PlyElement& element, std::int64_t index) {
    element_ = &element;
    index_ = index;
    record_ = at_;
  }
  template <class Number>
  Number get() {
    if (source_.bytes.size() - at_ < sizeof(Number))
      fail(source_, {kPlaces, source_.bytes.size()},
           fmt::format("the file ends in element {} {} of {}; it is truncated", quote(element_->name), index_,
                       element_->count));
    const auto value = load<Number>(source_.bytes.data() + at_, is_big_endian_);
    at_ += sizeof(Number);
    return value;
  }
  double coordinate(ScalarType type) {
    return visit_scalar(type, [&](auto number) { return static_cast<double>(get<decltype(number)>()); });
  }
  void end() const {}
  void finish() const {
    if (at_ != source_.bytes.size())
      fail(source_, {kPlaces, at_},
           fmt::format("{} bytes follow the last element; the counts are wrong or the file is damaged",
                       source_.bytes.size() - at_));
  }
  Place place() const { return {kPlaces, record_}; }

 private:
  const Source& source_;
  std::size_t at_, record_;
  bool is_big_endian_;
  const PlyElement* element_ = nullptr;
  std::int64_t index_ = 0;
};

template <class Values>
double get_scalar(Values& values, ScalarType type) {
  return visit_scalar(type, [&](auto number) { return static_cast<double>(values.template get<decltype(number)>()); });
}

template <class Values>
std::int64_t get_integer(Values& values, ScalarType type) {
  return visit_scalar(type,
                      [&](auto number) { return static_cast<std::int64_t>(values.template get<decltype(number)>()); });
}

template <class Values>
std::int64_t get_list_length(const Source& source, Values& values, const PlyProperty& list) {
  const auto length = get_integer(values, *list.count_type);
  check_list_length(source, values.place(), length);
  return length;
}

template <class Values>
void skip(const Source& source, Values& values, const PlyProperty& property) {
  const std::int64_t n = property.count_type ? get_list_length(source, values, property) : 1;
  for (std::int64_t i = 0; i < n; ++i) get_scalar(values, property.type);
}

template <class Values>
void read_vertices(const Source& source, Values& values, const PlyElement& element, MeshData& data) {
  constexpr int kAttribute = 3, kSkipped = 4;  // 0, 1, 2: the coordinates
  const auto count = static_cast<std::size_t>(element.count);
  std::vector<int> roles;
  for (const auto& property : element.properties) {
    const auto axis = property.name.size() == 1 ? std::string_view("xyz").find(property.name[0]) : std::string::npos;
    roles.push_back(property.count_type ? kSkipped : axis < 3 ? static_cast<int>(axis) : kAttribute);
    if (roles.back() != kAttribute) continue;
    data.attributes.push_back({property.name, property.type, {}});
    data.attributes.back().values.reserve(count);
  }
  data.points.resize(count);
  for (std::size_t v = 0; v < count; ++v) {
    values.begin(element, static_cast<std::int64_t>(v));
    auto attribute = data.attributes.begin();
    for (std::size_t i = 0; i < roles.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      if (roles[i] < kAttribute)
        data.points[v][static_cast<std::size_t>(roles[i])] = values.coordinate(property.type);
      else if (roles[i] == kAttribute)
        (attribute++)->values.push_back(get_scalar(values, property.type));
      else
        skip(source, values, property);
    }
    values.end();
  }
}

/// The list of a face element that names its corners.
std::optional<std::size_t> find_corners(const PlyElement& element) {
  const auto list = element.find("vertex_indices");
  return list ? list : element.find("vertex_index");
}

template <class Values>
void read_faces(const Source& source, Values& values, const PlyElement& element, SoupBuilder& soup) {
  const std::size_t list = *find_corners(element);
  soup.reserve_faces(static_cast<std::size_t>(element.count));
  std::vector<std::int64_t> corners;
  for (std::int64_t f = 0; f < element.count; ++f) {
    values.begin(element, f);
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      if (i != list) {
        skip(source, values, property);
        continue;
      }
      corners.clear();
      for (auto n = get_list_length(source, values, property); n > 0; --n)
        corners.push_back(get_integer(values, property.type));
    }
    values.end();
    soup.add_face(corners, values.place().number);
  }
}

template <class Values>
MeshData read_body(const Source& source, PlyHeader header) {
  Values values(source, header);
  SoupBuilder soup(source, Values::kPlaces);
  soup.data.comments = std::move(header.comments);
  for (const auto& element : header.elements) {
    if (element.name == "vertex") {
      read_vertices(source, values, element, soup.data);
    } else if (element.name == "face") {
      read_faces(source, values, element, soup);
    } else if (!element.properties.empty()) {
      for (std::int64_t i = 0; i < element.count; ++i) {
        values.begin(element, i);
        for (const auto& property : element.properties) skip(source, values, property);
        values.end();
      }
    }
  }
  values.finish();
  return std::move(soup).finish();
}

/// Throws unless the header declares vertices with coordinates and faces with corners.
void check_elements(const Source& source, const PlyHeader& header) {
  bool has_vertices = false, has_faces = false;
  for (const auto& element : header.elements) {
    const auto fail = [&](const char* what) { io::fail(source, {Place::Kind::line, element.line}, what); };
    if (element.name == "vertex") {
      has_vertices = true;
      for (const char* axis : {"x", "y", "z"})
        if (const auto i = element.find(axis); !i || element.properties[*i].count_type)
          fail("element vertex lacks a number x, y or z; add the property");
    } else if (element.name == "face") {
      has_faces = true;
      const auto i = find_corners(element);
      if (!i || !element.properties[*i].count_type || !is_integer(element.properties[*i].type))
        fail("element face lacks a list of integers vertex_indices; add it");
    }
  }
  if (!has_vertices || !has_faces)
    io::fail(source, {Place::Kind::line, header.body_line - 1},
             has_vertices ? "the header has no element face; points or strips are no mesh, so write faces"
                          : "the header has no element vertex; add it");
}

}  // namespace

MeshData read_ply(const Source& source) {
  PlyHeader header = read_ply_header(source);
  check_elements(source, header);
  if (header.encoding != PlyEncoding::ascii) return read_body<BinaryValues>(source, std::move(header));
  refuse_nul_bytes(source);
  return read_body<AsciiValues>(source, std::move(header));
}

}  // namespace meniscus::io
