// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtp.h"

#include "frame_attributes.h"
#include "meniscus/io/base64.h"

#include <fmt/format.h>

#include <cstring>

namespace meniscus {
namespace {

const char* vtk_name(ScalarType type) {
  constexpr const char* names[] = {"Int8", "UInt8", "Int16", "UInt16", "Int32", "UInt32", "Float32", "Float64"};
  return names[static_cast<std::size_t>(type)];
}

/// Numbers as VTK wants them: how many bytes, then the bytes.
template <class Number>
std::string encoded(const std::vector<Number>& numbers) {
  const std::uint64_t size = numbers.size() * sizeof(Number);
  std::string bytes(sizeof size + size, '\0');
  std::memcpy(bytes.data(), &size, sizeof size);
  if (size > 0) std::memcpy(bytes.data() + sizeof size, numbers.data(), size);
  return base64(bytes);
}

template <class Number>
std::string array(const char* type, const std::string& name, int components, const std::vector<Number>& numbers) {
  return fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"binary\">{}</DataArray>\n",
                     type, name, components, encoded(numbers));
}

std::string array(const VertexAttribute& attribute) {
  std::string text;
  const auto add = [&](auto zero) {
    std::vector<decltype(zero)> numbers;
    for (const double value : attribute.values) numbers.push_back(static_cast<decltype(zero)>(value));
    text = array(vtk_name(attribute.type), attribute.name, 1, numbers);
  };
  switch (attribute.type) {
    case ScalarType::int8:
      add(std::int8_t{});
      break;
    case ScalarType::uint8:
      add(std::uint8_t{});
      break;
    case ScalarType::int16:
      add(std::int16_t{});
      break;
    case ScalarType::uint16:
      add(std::uint16_t{});
      break;
    case ScalarType::int32:
      add(std::int32_t{});
      break;
    case ScalarType::uint32:
      add(std::uint32_t{});
      break;
    case ScalarType::float32:
      add(float{});
      break;
    case ScalarType::float64:
      add(double{});
      break;
  }
  return text;
}

std::string point_data(const MeshData& data) {
  std::string text;
  const std::vector<double> velocity = velocities(data);
  text += velocity.empty() ? "<PointData>\n" : "<PointData Vectors=\"velocity\">\n";
  if (!velocity.empty()) text += array("Float64", "velocity", 3, velocity);
  for (const VertexAttribute& attribute : data.attributes)
    if (!is_velocity(attribute)) text += array(attribute);
  return text + "</PointData>\n";
}

std::string polys(const MeshData& data) {
  std::vector<std::int64_t> corners, ends;
  for (const auto& triangle : data.triangles) {
    corners.insert(corners.end(), triangle.begin(), triangle.end());
    ends.push_back(static_cast<std::int64_t>(corners.size()));
  }
  return "<Polys>\n" + array("Int64", "connectivity", 1, corners) + array("Int64", "offsets", 1, ends) + "</Polys>\n";
}

}  // namespace

std::string vtp_bytes(const MeshData& data, double time) {
  std::vector<double> points;
  for (const auto& point : data.points) points.insert(points.end(), point.begin(), point.end());
  return fmt::format(
             "<?xml version=\"1.0\"?>\n"
             "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
             "header_type=\"UInt64\">\n<PolyData>\n"
             "<FieldData><DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{:.17g}"
             "</DataArray></FieldData>\n<Piece NumberOfPoints=\"{}\" NumberOfPolys=\"{}\">\n",
             time, data.points.size(), data.triangles.size()) +
         point_data(data) + "<Points>\n" + array("Float64", "points", 3, points) + "</Points>\n" + polys(data) +
         "</Piece>\n</PolyData>\n</VTKFile>\n";
}

std::string pvd_text(const std::vector<std::pair<double, std::string>>& files) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
      "byte_order=\"LittleEndian\">\n<Collection>\n";
  for (const auto& [time, file] : files)
    text += fmt::format("<DataSet timestep=\"{:.17g}\" part=\"0\" file=\"{}\"/>\n", time, file);
  return text + "</Collection>\n</VTKFile>\n";
}

}  // namespace meniscus
