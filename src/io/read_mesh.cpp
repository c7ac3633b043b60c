// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/io/read_mesh.h"

#include "formats.h"
#include "meniscus/core/error.h"

#include <fmt/format.h>

#include <new>
#include <stdexcept>

namespace meniscus {
namespace {

MeshData read_bytes(const io::Source& source, MeshFormat format) {
  if (source.bytes.empty()) throw FileError(fmt::format("{}: the file is empty; give a mesh", source.name));
  switch (format) {
    case MeshFormat::ply:
      return io::read_ply(source);
    case MeshFormat::off:
      return io::read_off(source);
    case MeshFormat::obj:
      return io::read_obj(source);
    case MeshFormat::stl:
      break;
  }
  return io::read_stl(source);
}

/// The mesh in the bytes that `load` returns; lack of memory is an error of the file too.
template <class Load>
MeshData read(const std::string& name, MeshFormat format, Load load) {
  const auto fail = [&] { throw FileError(fmt::format("{}: does not fit into memory; split the mesh", name)); };
  try {
    const std::string bytes = load();
    return read_bytes({name, bytes}, format);
  } catch (const std::bad_alloc&) {
    fail();
  } catch (const std::length_error&) {
    fail();
  }
  return {};
}

}  // namespace

MeshData read_mesh(const std::filesystem::path& path) {
  return read(path.string(), format_of(path), [&] { return read_file(path); });
}

MeshData read_mesh(std::istream& in, MeshFormat format, const std::string& name, std::size_t max_bytes) {
  return read(name, format, [&] { return read_stream(in, name, max_bytes); });
}

}  // namespace meniscus
