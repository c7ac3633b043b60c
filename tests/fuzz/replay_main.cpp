// SPDX-License-Identifier: GPL-3.0-or-later
#include "fuzz.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

/// Runs every file of the directories named: the seeds, and what fuzzing found. Without libFuzzer. Each
/// seed is also cut short and changed at a few hundred places, so that a find takes no clang to see again.
int main(int argc, char** argv) {
  namespace fs = std::filesystem;
  std::vector<fs::path> files;
  for (int k = 1; k < argc; ++k)
    if (fs::is_directory(argv[k]))
      for (const auto& entry : fs::directory_iterator(argv[k])) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::size_t runs = 0;
  for (const fs::path& file : files) {
    std::printf("%s\n", file.c_str());
    std::fflush(stdout);
    std::ifstream stream(file, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    meniscus::fuzz::run(bytes);
    const std::size_t stride = 1 + bytes.size() / 200;
    for (std::size_t at = 0; at < bytes.size(); at += stride) {
      meniscus::fuzz::run(bytes.substr(0, at));
      for (const char change : {'\x01', '\x80', '\xff'}) {
        std::string changed = bytes;
        changed[at] = static_cast<char>(changed[at] ^ change);
        meniscus::fuzz::run(changed);
      }
      runs += 4;
    }
  }
  std::printf("%zu files, %zu runs\n", files.size(), files.size() + runs);
  return files.empty() ? 1 : 0;
}
