// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace meniscus::bench {

/// Seconds of processor time that this thread has used.
double cpu_seconds();

/// How another program ended.
struct Finished {
  int code = 0;            ///< its exit code; 124 if it was stopped at the time limit, 127 if it could not start
  std::string output;      ///< stdout and stderr together
  double cpu_seconds = 0;  ///< user and system, with its children
};

/// Runs a program found in PATH, in a directory, with this text on stdin, for at most so long.
Finished run_program(const std::vector<std::string>& command, const std::filesystem::path& directory,
                     const std::string& input = {}, double limit_seconds = 600);

/// Whether PATH has a program of this name.
bool is_installed(const std::string& program);

/// A directory that is removed with everything in it at the end.
class TemporaryDirectory {
 public:
  TemporaryDirectory();
  ~TemporaryDirectory();
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace meniscus::bench
