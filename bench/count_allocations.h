// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <cstdlib>
#include <new>

/// Counts what this program allocates: operator new, and malloc as the program's own objects call it (Eigen does).
/// Wants the linker option --wrap=malloc,calloc,realloc, as bench/CMakeLists.txt gives it. Include it in one source
/// only.
namespace meniscus::bench {
inline std::atomic<std::size_t> num_allocations{0};
}

extern "C" {
void* __real_malloc(std::size_t size);                     // NOLINT: the linker's names
void* __real_calloc(std::size_t count, std::size_t size);  // NOLINT
void* __real_realloc(void* old, std::size_t size);         // NOLINT
void* __wrap_malloc(std::size_t size) {                    // NOLINT
  meniscus::bench::num_allocations.fetch_add(1, std::memory_order_relaxed);
  return __real_malloc(size);
}
void* __wrap_calloc(std::size_t count, std::size_t size) {  // NOLINT
  meniscus::bench::num_allocations.fetch_add(1, std::memory_order_relaxed);
  return __real_calloc(count, size);
}
void* __wrap_realloc(void* old, std::size_t size) {  // NOLINT
  meniscus::bench::num_allocations.fetch_add(1, std::memory_order_relaxed);
  return __real_realloc(old, size);
}
}

// Through the wrapped malloc, so that each counts once.
void* operator new(std::size_t size) {
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  const auto unit = static_cast<std::size_t>(alignment);
  meniscus::bench::num_allocations.fetch_add(1, std::memory_order_relaxed);
  if (void* memory = std::aligned_alloc(unit, (size + unit - 1) / unit * unit)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
