// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace meniscus {

/// The one of `names` that a mistyped word most likely meant, or "" if none is close: the least
/// number of inserted, deleted, replaced or swapped letters (at most a third of the longer word,
/// and always one), else a name that the word abbreviates (three letters or more). The first
/// of equals wins. Letters' case does not count.
std::string nearest_name(std::string_view word, const std::vector<std::string>& names);

}  // namespace meniscus
