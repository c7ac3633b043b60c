// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <unordered_map>
#include <vector>

namespace meniscus::io {

/// Numbers points by their first occurrence; points of the same bits share a number, and -0 is 0.
class PointWelder {
 public:
  std::uint32_t index_of(std::array<double, 3> point) {
    Bits bits;
    for (double& x : point) x += 0.0;  // -0 + 0 = 0
    std::memcpy(bits.data(), point.data(), sizeof bits);
    const auto [it, is_new] = indices_.try_emplace(bits, static_cast<std::uint32_t>(points_.size()));
    if (is_new) points_.push_back(point);
    return it->second;
  }
  void reserve(std::size_t count) { indices_.reserve(count); }
  std::vector<std::array<double, 3>>& points() { return points_; }

 private:
  using Bits = std::array<std::uint64_t, 3>;
  struct Hash {
    std::size_t operator()(const Bits& bits) const {
      std::uint64_t h = 0;
      for (const auto b : bits) {
        h = (h ^ b) * 0x9E3779B97F4A7C15U;  // 2^64 / golden ratio
        h ^= h >> 32;
      }
      return h;
    }
  };

  std::unordered_map<Bits, std::uint32_t, Hash> indices_;
  std::vector<std::array<double, 3>> points_;
};

}  // namespace meniscus::io
