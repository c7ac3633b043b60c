// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>

#include <string>

/// What the program says to people: everything here goes to stderr.
namespace meniscus::tools {

/// Whether stderr is a terminal; whether it may be coloured too (NO_COLOR is not set).
bool is_terminal();
bool is_coloured();

/// "error: what", in red where colours are welcome. Several lines are several errors.
void say_error(const std::string& what);

/// A line of news, unless -q asked for silence. `verbose` lines are for -v only.
class Console {
 public:
  Console(bool quiet, bool verbose) : quiet_(quiet), verbose_(verbose && !quiet) {}
  void say(const std::string& line) const;
  void say_verbose(const std::string& line) const;
  bool is_quiet() const { return quiet_; }

 private:
  bool quiet_, verbose_;
};

/// Seconds on a clock that never goes back.
double seconds_now();

/// How far a long run is: one line that rewrites itself on a terminal, else a line every 10 seconds.
class Progress {
 public:
  explicit Progress(const Console& console);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress() { clear(); }
  /// Shows `line` if it is time to.
  void show(const std::string& line);
  /// Wipes the line off a terminal, so that something else can be said.
  void clear();

 private:
  bool quiet_, terminal_, shown_ = false;
  double last_;
};

}  // namespace meniscus::tools
