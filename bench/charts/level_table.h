// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace meniscus::bench {

/// The text of src/simulation/measured_levels.h, from oscillation.csv and
/// sessile.csv in the directory. Throws FileError if one cannot be read.
std::string level_table(const std::filesystem::path& directory);

}  // namespace meniscus::bench
