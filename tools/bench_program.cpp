// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench_program.h"

#include "meniscus/core/error.h"
#include "meniscus/scene/nearest_name.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <map>

namespace meniscus::tools {
namespace {

namespace fs = std::filesystem;

std::map<std::string, fs::path> bench_programs() {
  const std::string prefix = "bench_";
  std::error_code error;
  const fs::path here = fs::read_symlink("/proc/self/exe", error).parent_path();
  std::map<std::string, fs::path> programs;
  for (fs::directory_iterator file(here / "../bench", error), end; !error && file != end; file.increment(error)) {
    const std::string name = file->path().filename().string();
    if (name.rfind(prefix, 0) == 0 && access(file->path().c_str(), X_OK) == 0 && fs::is_regular_file(file->path()))
      programs.emplace(name.substr(prefix.size()), file->path());
  }
  return programs;
}

}  // namespace

std::vector<std::string> bench_names() {
  std::vector<std::string> names;
  for (const auto& program : bench_programs()) names.push_back(program.first);
  return names;
}

void become_bench(const std::string& name, const std::vector<std::string>& arguments) {
  const auto programs = bench_programs();
  const auto found = programs.find(name);
  if (programs.empty())
    throw UsageError(
        fmt::format("bench {}: the benchmarks were not built; configure with "
                    "-DMENISCUS_BENCH=ON and build the whole tree",
                    name));
  if (found == programs.end()) {
    const std::string nearest = nearest_name(name, bench_names());
    throw UsageError(fmt::format("bench {}: there is no such benchmark{}{} {}", name,
                                 nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", nearest),
                                 nearest.empty() ? "; there are" : " There are", fmt::join(bench_names(), ", ")));
  }
  std::vector<char*> words{const_cast<char*>(found->second.c_str())};
  for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  execv(words[0], words.data());
  throw UsageError(fmt::format("bench {}: cannot run {}: {}", name, found->second.string(), std::strerror(errno)));
}

}  // namespace meniscus::tools
