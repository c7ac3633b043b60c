// SPDX-License-Identifier: GPL-3.0-or-later
#include "console.h"

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>

namespace meniscus::tools {
namespace {

constexpr double terminal_pause = 0.1, plain_pause = 10;  // s

void write(const std::string& text) { std::fputs(text.c_str(), stderr); }

}  // namespace

bool is_terminal() {
  static const bool terminal = ::isatty(STDERR_FILENO) == 1;
  return terminal;
}

bool is_coloured() {
  const char* no_color = std::getenv("NO_COLOR");
  const char* term = std::getenv("TERM");
  return is_terminal() && (!no_color || !*no_color) && (!term || std::string(term) != "dumb");
}

void say_error(const std::string& what) {
  const char* mark = is_coloured() ? "\033[1;31merror:\033[0m" : "error:";
  for (std::size_t start = 0; start < what.size();) {
    const std::size_t end = std::min(what.find('\n', start), what.size());
    write(fmt::format("{} {}\n", mark, what.substr(start, end - start)));
    start = end + 1;
  }
}

void Console::say(const std::string& line) const {
  if (!quiet_) write(line + '\n');
}

void Console::say_verbose(const std::string& line) const {
  if (verbose_) write(line + '\n');
}

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Progress::Progress(const Console& console)
    : quiet_(console.is_quiet()), terminal_(is_terminal()), last_(seconds_now()) {}

void Progress::show(const std::string& line) {
  if (quiet_ || seconds_now() - last_ < (terminal_ ? terminal_pause : plain_pause)) return;
  last_ = seconds_now();
  if (!terminal_) return write(line + '\n');
  clear();
  write(is_coloured() ? "\033[36m" + line + "\033[0m" : line);
  std::fflush(stderr);
  shown_ = true;
}

void Progress::clear() {
  if (shown_) write("\r\033[K");
  shown_ = false;
}

}  // namespace meniscus::tools
