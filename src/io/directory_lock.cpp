// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/io/directory_lock.h"

#include "meniscus/core/error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace meniscus {

DirectoryLock::DirectoryLock(const std::filesystem::path& directory) : file_(-1) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (!error) {
    file_ = ::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (file_ < 0) error = {errno, std::generic_category()};
  }
  if (error)
    throw FileError(fmt::format("{}: cannot be made the directory of the frames ({}); check its name and permissions",
                                directory.string(), error.message()));
  if (::flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    ::close(file_);
    throw FileError(fmt::format("{}: another run is writing there now; wait for its end, or name another directory",
                                directory.string()));
  }
}

DirectoryLock::~DirectoryLock() {
  if (file_ >= 0) ::close(file_);
}

DirectoryLock::DirectoryLock(DirectoryLock&& other) noexcept : file_(std::exchange(other.file_, -1)) {}

}  // namespace meniscus
