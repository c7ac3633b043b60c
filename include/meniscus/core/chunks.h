// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cstddef>

/// Loops over the rows of one large array on several threads. Rows are cut into chunks by their number alone, and
/// sums over chunks are added in the order of the chunks: the same bits come out on any number of threads.
/// Chunks come in fours, which two or four threads share evenly.
/// Up to `least_rows` rows are one chunk and run where they are called; loops with more work a row give fewer.
namespace meniscus {

namespace chunks {
inline constexpr std::size_t least_rows = 8192;
inline constexpr std::size_t most = 32;
inline std::size_t count(std::size_t rows, std::size_t least = least_rows) {
  return rows <= least ? 1 : std::min(most, rows / least * 4);
}
inline std::size_t begin(std::size_t rows, std::size_t chunk, std::size_t count) { return rows * chunk / count; }
}  // namespace chunks

/// Calls body(begin, end) for each chunk of [0, rows).
template <class Body>
void for_each_chunk(std::size_t rows, const Body& body) {
  const std::size_t count = chunks::count(rows);
  if (count == 1) return body(std::size_t{0}, rows);
  // Isolated: a thread that waits here must not begin another drop, whose working arrays it may hold already.
  tbb::this_task_arena::isolate([&] {
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t chunk) {
      body(chunks::begin(rows, chunk, count), chunks::begin(rows, chunk + 1, count));
    });
  });
}

/// The sum of body(begin, end) over the chunks of [0, rows). Allocates nothing but what Sum does.
template <class Sum, class Body>
Sum sum_over_chunks(std::size_t rows, const Sum& zero, const Body& body, std::size_t least = chunks::least_rows) {
  const std::size_t count = chunks::count(rows, least);
  if (count == 1) return body(std::size_t{0}, rows);
  std::array<Sum, chunks::most> parts;
  parts.fill(zero);
  tbb::this_task_arena::isolate([&] {
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t chunk) {
      parts[chunk] = body(chunks::begin(rows, chunk, count), chunks::begin(rows, chunk + 1, count));
    });
  });
  Sum sum = zero;
  for (std::size_t chunk = 0; chunk < count; ++chunk) sum += parts[chunk];
  return sum;
}

}  // namespace meniscus
