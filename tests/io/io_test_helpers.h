// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/error.h"
#include "meniscus/io/read_mesh.h"
#include "meniscus/io/write_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

namespace meniscus::test {

inline MeshData parse(MeshFormat format, const std::string& bytes) {
  std::istringstream in(bytes);
  return read_mesh(in, format, "in");
}

inline std::string print(MeshFormat format, const MeshData& data, bool binary = true) {
  std::ostringstream out;
  write_mesh(out, format, data, WriteOptions{binary});
  return out.str();
}

/// The message of the FileError that `f` throws; "" and a failure if it throws none.
template <class F>
std::string file_error(F f) {
  try {
    f();
  } catch (const FileError& error) {
    return error.what();
  }
  ADD_FAILURE() << "no FileError";
  return "";
}

inline std::string parse_error(MeshFormat format, const std::string& bytes) {
  return file_error([&] { parse(format, bytes); });
}

inline bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

inline bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

inline bool same_bits(const std::vector<std::array<double, 3>>& a, const std::vector<std::array<double, 3>>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
}

/// A tetrahedron, outward.
inline MeshData tetrahedron() {
  MeshData data;
  data.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  data.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return data;
}

/// An empty directory that is gone after the test.
class TemporaryDirectory {
 public:
  TemporaryDirectory() {
    std::string name = (std::filesystem::temp_directory_path() / "meniscus_test_XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;
  ~TemporaryDirectory() { std::filesystem::remove_all(path_); }

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  /// The names of the files in it, sorted.
  std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(path_)) found.push_back(entry.path().filename());
    std::sort(found.begin(), found.end());
    return found;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace meniscus::test
