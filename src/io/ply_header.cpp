// SPDX-License-Identifier: GPL-3.0-or-later
#include "ply_header.h"

#include "text_scanner.h"

#include <fmt/format.h>

#include <algorithm>

namespace meniscus::io {
namespace {

struct TypeName {
  ScalarType type;
  const char *classic, *sized;
};
constexpr TypeName kTypeNames[] = {
    {ScalarType::int8, "char", "int8"},        {ScalarType::uint8, "uchar", "uint8"},
    {ScalarType::int16, "short", "int16"},     {ScalarType::uint16, "ushort", "uint16"},
    {ScalarType::int32, "int", "int32"},       {ScalarType::uint32, "uint", "uint32"},
    {ScalarType::float32, "float", "float32"}, {ScalarType::float64, "double", "float64"}};

ScalarType parse_type(const TextScanner& in, std::string_view word) {
  for (const auto& [type, classic, sized] : kTypeNames)
    if (word == classic || word == sized) return type;
  in.fail(fmt::format("{} is no PLY type; use char, uchar, short, ushort, int, uint, float or double", quote(word)));
}

std::string read_name(TextScanner& in) {
  const std::string_view word = in.word();
  if (word.empty()) in.fail("the line ends before a name; complete it");
  return std::string(word);
}

PlyEncoding read_encoding(TextScanner& in) {
  const std::string_view encoding = in.word(), version = in.word();
  if (version != "1.0") in.fail(fmt::format("PLY version {} is not supported; write version 1.0", quote(version)));
  if (encoding == "ascii") return PlyEncoding::ascii;
  if (encoding == "binary_little_endian") return PlyEncoding::binary_little_endian;
  if (encoding == "binary_big_endian") return PlyEncoding::binary_big_endian;
  in.fail(fmt::format("the PLY format {} is not supported; use ascii, binary_little_endian or binary_big_endian",
                      quote(encoding)));
}

PlyElement read_element(TextScanner& in, const std::vector<PlyElement>& earlier) {
  PlyElement element{read_name(in), in.number<std::int64_t>("the number of elements"), in.place().number, {}};
  if (std::any_of(earlier.begin(), earlier.end(), [&](const auto& e) { return e.name == element.name; }))
    in.fail(fmt::format("element {} is declared twice; remove one", quote(element.name)));
  return element;
}

PlyProperty read_property(TextScanner& in, const std::vector<PlyElement>& elements) {
  if (elements.empty()) in.fail("a property stands before any element; put it after its element");
  std::optional<ScalarType> count_type;
  std::string_view word = in.word();
  if (word == "list") {
    count_type = parse_type(in, in.word());
    word = in.word();
    if (!is_integer(*count_type)) in.fail("the length of a list is no integer; use uchar or int");
  }
  const ScalarType type = parse_type(in, word);
  PlyProperty property{read_name(in), type, count_type};
  if (elements.back().find(property.name))
    in.fail(fmt::format("property {} of element {} is declared twice; remove one", quote(property.name),
                        quote(elements.back().name)));
  return property;
}

/// The fewest bytes that an element can take: binary sizes, or one digit and one space a value.
std::size_t least_bytes(const PlyElement& element, PlyEncoding encoding) {
  std::size_t bytes = 0;
  for (const auto& property : element.properties)
    bytes += encoding == PlyEncoding::ascii ? 2 : byte_size(property.count_type.value_or(property.type));
  return bytes;
}

void check_counts(const Source& source, const PlyHeader& header) {
  std::size_t room = source.bytes.size() - header.body + (header.encoding == PlyEncoding::ascii ? 1 : 0);
  for (const auto& element : header.elements)
    room = take_room(source, {Place::Kind::line, element.line}, quote(element.name), element.count,
                     least_bytes(element, header.encoding), room);
}

}  // namespace

std::optional<std::size_t> PlyElement::find(std::string_view property) const {
  for (std::size_t i = 0; i < properties.size(); ++i)
    if (properties[i].name == property) return i;
  return std::nullopt;
}

const char* ply_name(ScalarType type) { return kTypeNames[static_cast<std::size_t>(type)].classic; }

PlyHeader read_ply_header(const Source& source) {
  TextScanner in(source);
  PlyHeader header;
  bool has_format = false;
  in.next_line();
  if (const auto magic = in.word(); magic != "ply" || !in.at_line_end())
    in.fail(fmt::format("begins with {}, not with a line \"ply\"; is this a PLY file?", quote(magic)));
  for (;;) {
    if (!in.next_line()) in.fail("the file ends before end_header; it is truncated");
    const std::string_view keyword = in.word();
    if (keyword == "comment") {
      const auto text = in.rest_of_line();
      header.comments.emplace_back(text.substr(text.empty() ? 0 : 1));
    } else if (keyword == "obj_info") {
      continue;
    } else if (keyword == "end_header") {
      break;
    } else {
      if (keyword == "format") {
        header.encoding = read_encoding(in);
        has_format = true;
      } else if (keyword == "element") {
        header.elements.push_back(read_element(in, header.elements));
      } else if (keyword == "property") {
        auto property = read_property(in, header.elements);
        header.elements.back().properties.push_back(std::move(property));
      } else {
        in.fail(fmt::format("{} is no word of a PLY header; remove the line", quote(keyword)));
      }
      in.expect_line_end("the declaration");
    }
  }
  in.expect_line_end("end_header");
  if (!has_format) in.fail("the header has no format line; add \"format ascii 1.0\" or the like");
  header.body = in.offset();
  header.body_line = in.place().number + 1;
  check_counts(source, header);
  return header;
}

}  // namespace meniscus::io
