// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdlib>
#include <string_view>

/// A reader under attack. Each source of this folder defines `run`; libFuzzer or the replay calls it.
namespace meniscus::fuzz {

/// Reads the input as a file. What the reader throws on purpose is caught; all else is a find.
void run(std::string_view input);

/// A promise of the reader's: ends the program, as any find does.
inline void require(bool holds) {
  if (!holds) std::abort();
}

}  // namespace meniscus::fuzz
