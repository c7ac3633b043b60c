// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/io/write_file_atomically.h"

#include "file_descriptor.h"
#include "meniscus/core/error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>
#include <vector>

namespace meniscus {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view temporary_start = ".meniscus-", temporary_end = ".tmp";

[[noreturn]] void fail(const fs::path& path, int error) {
  throw FileError(fmt::format("{}: cannot be written ({}); check the directory, its permissions and the space left",
                              path.string(), std::generic_category().message(error)));
}

/// All of `contents`, or false with errno set.
bool write_all(int file, std::string_view contents) {
  while (!contents.empty()) {
    const ssize_t put = ::write(file, contents.data(), contents.size());
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) return false;
    contents.remove_prefix(static_cast<std::size_t>(put));
  }
  return true;
}

void write_directly(const fs::path& path, std::string_view contents) {
  io::FileDescriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (!file.is_open() || !write_all(file.number(), contents) || !file.close()) fail(path, errno);
}

/// What a link names in the end, whether that exists or not.
fs::path follow_links(fs::path path) {
  constexpr int kMaxLinks = 40;  // as the system's own limit
  std::error_code error;
  for (int i = 0; i < kMaxLinks && fs::is_symlink(path, error); ++i)
    path = path.parent_path() / fs::read_symlink(path, error);
  return path;
}

/// A new file of a name that nobody has in the directory of a target; removed unless it is renamed.
class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& target) : target_(target), file_(create()) {
    if (!file_.is_open()) fail(target_, errno);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (!renamed_) ::unlink(name_.c_str());
  }

  void fill(std::string_view contents, mode_t mode) {
    if ((mode != 0 && ::fchmod(file_.number(), mode) != 0) || !write_all(file_.number(), contents) ||
        ::fsync(file_.number()) != 0 || !file_.close())
      fail(target_, errno);
  }
  void rename_to_target() {
    renamed_ = ::rename(name_.c_str(), target_.c_str()) == 0;
    if (!renamed_) fail(target_, errno);
  }

 private:
  int create() {
    for (int attempt = 0;; ++attempt) {
      name_ = target_.parent_path() / fmt::format("{}{}-{}{}", temporary_start, ::getpid(), attempt, temporary_end);
      const int file = ::open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (file >= 0 || errno != EEXIST) return file;
    }
  }

  fs::path target_, name_;
  io::FileDescriptor file_;
  bool renamed_ = false;
};

}  // namespace

void write_file_atomically(const fs::path& path, std::string_view contents) {
  struct stat status {};
  const bool exists = ::stat(path.c_str(), &status) == 0;
  if (!exists && errno != ENOENT) fail(path, errno);
  if (exists && S_ISDIR(status.st_mode))
    throw FileError(fmt::format("{}: is a directory; name a file to write", path.string()));
  if (exists && !S_ISREG(status.st_mode)) return write_directly(path, contents);
  TemporaryFile file(follow_links(path));
  file.fill(contents, exists ? status.st_mode & 07777 : 0);
  file.rename_to_target();
}

void append_to_file(const fs::path& path, std::string_view contents) {
  io::FileDescriptor file(::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC));
  struct stat status {};
  if (!file.is_open() || ::fstat(file.number(), &status) != 0) fail(path, errno);
  if (write_all(file.number(), contents) && ::fsync(file.number()) == 0) return;
  const int error = errno;
  if (::ftruncate(file.number(), status.st_size) != 0) fail(path, errno);
  fail(path, error);
}

void remove_temporary_files(const fs::path& directory) {
  std::error_code error;
  std::vector<fs::path> left;
  for (fs::directory_iterator entry(directory, error), last; !error && entry != last; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    const auto length = temporary_start.size() + temporary_end.size();
    if (name.size() > length && name.compare(0, temporary_start.size(), temporary_start) == 0 &&
        name.compare(name.size() - temporary_end.size(), std::string::npos, temporary_end) == 0)
      left.push_back(entry->path());
  }
  for (const fs::path& file : left)
    if (!error) fs::remove(file, error);
  if (error)
    throw FileError(fmt::format("{}: cannot be tidied ({}); check the directory and its permissions",
                                directory.string(), error.message()));
}

}  // namespace meniscus
