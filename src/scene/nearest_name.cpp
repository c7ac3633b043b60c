// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/scene/nearest_name.h"

#include <boost/algorithm/string/case_conv.hpp>
#include <boost/algorithm/string/predicate.hpp>

#include <algorithm>
#include <numeric>

namespace meniscus {
namespace {

// Edit distance with swaps of neighbours (optimal string alignment), in three rows.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before.swap(last);
    last.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row[b.size()];
}

}  // namespace

std::string nearest_name(std::string_view word, const std::vector<std::string>& names) {
  constexpr std::size_t longest = 64;  // no key is longer; bounds the work on absurd input
  if (word.empty() || word.size() > longest) return {};
  const std::string typed = boost::to_lower_copy(std::string(word));
  std::string best;
  std::size_t least = longest;
  for (const std::string& name : names) {
    const std::size_t distance = edit_distance(typed, boost::to_lower_copy(name));
    const std::size_t allowed = std::max<std::size_t>(1, std::max(typed.size(), name.size()) / 3);
    if (distance > allowed || distance >= least || distance >= name.size()) continue;
    best = name;
    least = distance;
  }
  if (!best.empty() || typed.size() < 3) return best;
  for (const std::string& name : names) {
    if (boost::istarts_with(name, typed)) return name;
  }
  return {};
}

}  // namespace meniscus
