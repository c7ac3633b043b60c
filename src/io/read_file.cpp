// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/io/read_file.h"

#include "file_descriptor.h"
#include "meniscus/core/error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <istream>
#include <system_error>

namespace meniscus {
namespace {

constexpr std::size_t kBlock = std::size_t{1} << 16;

[[noreturn]] void fail(const std::string& name, int error) {
  throw FileError(error == ENOENT ? fmt::format("{}: there is no such file; check the name", name)
                                  : fmt::format("{}: cannot be read ({}); check the name and its permissions", name,
                                                std::generic_category().message(error)));
}

[[noreturn]] void fail_too_long(const std::string& name, std::size_t max_bytes) {
  throw FileError(fmt::format("{}: more than {} bytes come from this stream; give a file instead", name, max_bytes));
}

}  // namespace

std::string read_file(const std::filesystem::path& path) {
  const std::string name = path.string();
  const io::FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  struct stat status {};
  if (!file.is_open() || ::fstat(file.number(), &status) != 0) fail(name, errno);
  if (S_ISDIR(status.st_mode)) throw FileError(fmt::format("{}: is a directory; name a file", name));
  const bool is_regular = S_ISREG(status.st_mode);
  std::string bytes(is_regular ? static_cast<std::size_t>(status.st_size) + 1 : kBlock, '\0');
  for (std::size_t length = 0;;) {
    if (length == bytes.size()) bytes.resize(2 * bytes.size());
    const ssize_t got = ::read(file.number(), bytes.data() + length, bytes.size() - length);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(name, errno);
    length += static_cast<std::size_t>(got);
    if (got == 0) {
      bytes.resize(length);
      return bytes;
    }
    if (!is_regular && length > kMaxStreamBytes) fail_too_long(name, kMaxStreamBytes);
  }
}

std::string read_stream(std::istream& in, const std::string& name, std::size_t max_bytes) {
  std::string bytes;
  while (in) {
    const std::size_t length = bytes.size();
    bytes.resize(length + std::clamp(length, kBlock, 256 * kBlock));
    in.read(bytes.data() + length, static_cast<std::streamsize>(bytes.size() - length));
    bytes.resize(length + static_cast<std::size_t>(in.gcount()));
    if (bytes.size() > max_bytes) fail_too_long(name, max_bytes);
  }
  if (in.bad()) throw FileError(fmt::format("{}: the stream broke after {} bytes; try again", name, bytes.size()));
  return bytes;
}

}  // namespace meniscus
