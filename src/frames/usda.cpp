// SPDX-License-Identifier: GPL-3.0-or-later
#include "usda.h"

#include "frame_attributes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace meniscus {
namespace {

using Out = std::back_insert_iterator<std::string>;

/// "[(x, y, z), ...]", as float32, the fewest digits that read back to the same bits.
template <class Vectors>
std::string tuples(const Vectors& vectors) {
  std::string text = "[";
  for (const auto& [x, y, z] : vectors)
    fmt::format_to(Out(text), "{}({}, {}, {})", text.size() > 1 ? ", " : "", static_cast<float>(x),
                   static_cast<float>(y), static_cast<float>(z));
  return text + ']';
}

std::string tuples_of(const std::vector<double>& flat) {
  std::vector<std::array<double, 3>> vectors;
  for (std::size_t k = 0; k + 2 < flat.size(); k += 3) vectors.push_back({flat[k], flat[k + 1], flat[k + 2]});
  return tuples(vectors);
}

std::string integers(const VertexAttribute* attribute) {
  if (!attribute) return {};
  std::string text = "[";
  for (const double value : attribute->values)
    fmt::format_to(Out(text), "{}{}", text.size() > 1 ? ", " : "", std::lround(value));
  return text + ']';
}

std::string corners_of(const MeshData& data) {
  std::string text = "[";
  for (const auto& [a, b, c] : data.triangles)
    fmt::format_to(Out(text), "{}{}, {}, {}", text.size() > 1 ? ", " : "", a, b, c);
  return text + ']';
}

std::string counts_of(const MeshData& data) {
  std::string text = "[";
  for (std::size_t t = 0; t < data.triangles.size(); ++t) text += t == 0 ? "3" : ", 3";
  return text + ']';
}

std::string extent_of(const MeshData& data) {
  if (data.points.empty()) return "[(0, 0, 0), (0, 0, 0)]";
  std::array<std::array<double, 3>, 2> extent{data.points[0], data.points[0]};
  for (const auto& point : data.points)
    for (std::size_t k = 0; k < 3; ++k) {
      extent[0][k] = std::min(extent[0][k], point[k]);
      extent[1][k] = std::max(extent[1][k], point[k]);
    }
  return tuples(extent);
}

std::string header(const std::string& times) {
  return fmt::format(
      "#usda 1.0\n(\n    defaultPrim = \"drops\"\n    metersPerUnit = 0.01\n    upAxis = \"Z\"\n{})\n\n"
      "def Xform \"drops\"\n{{\n    def Mesh \"liquid\"\n    {{\n        uniform token subdivisionScheme = \"none\"\n"
      "        uniform token orientation = \"rightHanded\"\n",
      times);
}

constexpr const char* ending = "    }\n}\n";

/// The attributes, in the order of UsdaValues.
struct Attribute {
  const char* name;
  bool is_primvar;  ///< one value a vertex, which has to be said
};
constexpr Attribute attributes[] = {{"float3[] extent", false},         {"int[] faceVertexCounts", false},
                                    {"int[] faceVertexIndices", false}, {"point3f[] points", false},
                                    {"vector3f[] velocities", false},   {"int[] primvars:drop", true},
                                    {"int[] primvars:contact", true}};
constexpr const char* per_vertex = " (\n            interpolation = \"vertex\"\n        )";

UsdaValues values_of(const MeshData& data) {
  check_finite(data);
  const std::vector<double> velocity = velocities(data);
  return {extent_of(data),
          counts_of(data),
          corners_of(data),
          tuples(data.points),
          velocity.empty() ? std::string() : tuples_of(velocity),
          integers(data.attribute("drop")),
          integers(data.attribute("contact"))};
}

}  // namespace

std::string usda_still(const MeshData& data) {
  const UsdaValues values = values_of(data);
  std::string out = header("");
  for (std::size_t k = 0; k < values.size(); ++k)
    if (!values[k].empty())
      out +=
          fmt::format("        {} = {}{}\n", attributes[k].name, values[k], attributes[k].is_primvar ? per_vertex : "");
  return out + ending;
}

void UsdaSequence::add(const MeshData& data, double time) {
  frames_.push_back(values_of(data));
  times_.push_back(time);
}

double UsdaSequence::codes_per_second() const {
  const double spacing = times_.size() < 2 ? 0 : times_[1] - times_[0];
  return spacing > 0 ? std::round(1e6 / spacing) / 1e6 : 24;
}

std::string UsdaSequence::text() const {
  const double rate = codes_per_second();
  const auto code = [&](std::size_t frame) {  // whole where frames are evenly spaced, to rounding
    const double exact = (times_[frame] - times_[0]) * rate;
    return std::abs(exact - std::round(exact)) < 1e-3 ? std::round(exact) : exact;
  };
  std::string out = header(times_.empty() ? ""
                                          : fmt::format("    startTimeCode = 0\n    endTimeCode = {}\n"
                                                        "    timeCodesPerSecond = {}\n    framesPerSecond = {}\n",
                                                        code(times_.size() - 1), rate, rate));
  for (std::size_t k = 0; k < std::size(attributes); ++k) {
    const auto lacks = [k](const UsdaValues& frame) { return frame[k].empty(); };
    if (frames_.empty() || lacks(frames_.front())) continue;  // of one run all frames have the same
    if (attributes[k].is_primvar)  // a default too: there are readers that take no metadata without a value
      out += fmt::format("        {} = {}{}\n", attributes[k].name, frames_.front()[k], per_vertex);
    out += fmt::format("        {}.timeSamples = {{\n", attributes[k].name);
    for (std::size_t frame = 0; frame < frames_.size(); ++frame)
      if (!lacks(frames_[frame])) fmt::format_to(Out(out), "            {}: {},\n", code(frame), frames_[frame][k]);
    out += "        }\n";
  }
  return out + ending;
}

}  // namespace meniscus
