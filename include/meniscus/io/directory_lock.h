// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace meniscus {

/// Keeps other programs that ask for the same lock out of a directory for as long as it lives. The system
/// holds it (flock on the directory), so it ends with the program however that ends, and leaves no file.
class DirectoryLock {
 public:
  /// Makes the directory if need be and locks it. Throws FileError if it cannot be made, or if
  /// another program holds it. On file systems without locks it locks nothing.
  explicit DirectoryLock(const std::filesystem::path& directory);
  ~DirectoryLock();
  DirectoryLock(DirectoryLock&& other) noexcept;
  DirectoryLock& operator=(DirectoryLock&&) = delete;

 private:
  int file_;
};

}  // namespace meniscus
