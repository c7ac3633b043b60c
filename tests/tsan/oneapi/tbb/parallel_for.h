// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

/// Stands in for TBB's parallel_for in the build for the thread sanitizer (scripts/sanitize tsan). Debian's libtbb is
/// not built for it, so that the sanitizer cannot see what TBB orders and takes every loop for a race. Here, only
/// starting and joining threads orders anything: the bodies' races show, and nothing else.
namespace tbb {

template <class Index, class Body>
void parallel_for(Index first, Index last, const Body& body) {
  std::atomic<Index> next(first);
  std::mutex mutex;
  std::exception_ptr thrown;
  const auto work = [&] {
    try {
      for (Index k = next.fetch_add(1, std::memory_order_relaxed); k < last;
           k = next.fetch_add(1, std::memory_order_relaxed))
        body(k);
    } catch (...) {
      const std::lock_guard lock(mutex);
      thrown = std::current_exception();
    }
  };
  std::vector<std::thread> threads;
  for (Index k = first; k < std::min(last, first + 4); ++k) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace tbb
