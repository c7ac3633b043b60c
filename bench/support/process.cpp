// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/process.h"

#include "meniscus/core/error.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <ctime>
#include <fstream>
#include <sstream>

namespace meniscus::bench {
namespace {

double seconds_of(const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); }

/// What runs in the child: does not return.
[[noreturn]] void become(const std::vector<std::string>& command, const std::filesystem::path& directory,
                         const std::filesystem::path& input, const std::filesystem::path& output) {
  const int in = open(input.c_str(), O_RDONLY), out = open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (in < 0 || out < 0 || chdir(directory.c_str()) != 0) _exit(127);
  dup2(in, 0);
  dup2(out, 1);
  dup2(out, 2);
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  execvp(arguments[0], arguments.data());
  _exit(127);
}

}  // namespace

double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

Finished run_program(const std::vector<std::string>& command, const std::filesystem::path& directory,
                     const std::string& input, double limit_seconds) {
  const TemporaryDirectory temporary;
  const std::filesystem::path in = temporary.path() / "in", out = temporary.path() / "out";
  std::ofstream(in) << input;
  std::vector<std::string> limited{"timeout", std::to_string(limit_seconds)};
  limited.insert(limited.end(), command.begin(), command.end());
  const pid_t child = fork();
  if (child < 0) throw FileError("no further process can be started");
  if (child == 0) become(limited, directory, in, out);
  int status = 0;
  rusage used{};
  wait4(child, &status, 0, &used);
  Finished finished;
  finished.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
  finished.cpu_seconds = seconds_of(used.ru_utime) + seconds_of(used.ru_stime);
  std::stringstream text;
  text << std::ifstream(out).rdbuf();
  finished.output = text.str();
  return finished;
}

bool is_installed(const std::string& program) {
  const char* const path = std::getenv("PATH");
  std::stringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (access((std::filesystem::path(folder) / program).c_str(), X_OK) == 0) return true;
  return false;
}

TemporaryDirectory::TemporaryDirectory() {
  std::string name = (std::filesystem::temp_directory_path() / "meniscus_bench_XXXXXX").string();
  if (!mkdtemp(name.data())) throw FileError("no temporary directory can be made");
  path_ = name;
}

TemporaryDirectory::~TemporaryDirectory() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace meniscus::bench
