// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/io/write_mesh.h"

#include "formats.h"
#include "meniscus/core/error.h"
#include "meniscus/io/write_file_atomically.h"

#include <fmt/format.h>

#include <algorithm>
#include <ostream>

namespace meniscus {
namespace {

std::string write_bytes(MeshFormat format, const MeshData& data, const WriteOptions& options, const std::string& name) {
  io::check_writable(data, name);
  switch (format) {
    case MeshFormat::ply:
      return io::write_ply(data, options.binary, name);
    case MeshFormat::off:
      return io::write_off(data);
    case MeshFormat::obj:
      return io::write_obj(data);
    case MeshFormat::stl:
      break;
  }
  return io::write_stl(data, options.binary, name);
}

}  // namespace

void io::check_writable(const MeshData& data, const std::string& name) {
  for (std::size_t t = 0; t < data.triangles.size(); ++t)
    for (const auto v : data.triangles[t])
      if (v >= data.points.size())
        throw FileError(fmt::format("{}: triangle {} names vertex {}, but there are {} vertices; correct the mesh",
                                    name, t, v, data.points.size()));
}

void write_mesh(const std::filesystem::path& path, const MeshData& data, const WriteOptions& options) {
  write_file_atomically(path, write_bytes(format_of(path), data, options, path.string()));
}

void write_mesh(std::ostream& out, MeshFormat format, const MeshData& data, const WriteOptions& options) {
  const std::string bytes = write_bytes(format, data, options, "output");
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size())).flush();
  if (!out) throw FileError("output: cannot be written; check the space left and that the reader is still there");
}

}  // namespace meniscus
