// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <oneapi/tbb/concurrent_queue.h>

#include <atomic>
#include <exception>
#include <functional>
#include <thread>

namespace meniscus::tools {

/// A thread that writes files behind the simulation: tasks run one after another, in the order of their coming.
class WritingThread {
 public:
  WritingThread();
  WritingThread(const WritingThread&) = delete;
  WritingThread& operator=(const WritingThread&) = delete;
  ~WritingThread() { stop(); }

  /// Queues a task; waits while `most_waiting` others do, so that memory is bounded. Once a task has thrown, none
  /// that comes after it runs, and the next call of run() or finish() throws what it threw.
  void run(std::function<void()> task);
  /// Waits until every task has run.
  void finish();
  /// The same, but throws nothing.
  void stop() noexcept;

 private:
  static constexpr int most_waiting = 2;
  void run_tasks();
  void rethrow();

  tbb::concurrent_bounded_queue<std::function<void()>> tasks_;  // an empty one is the last
  std::exception_ptr error_;                                    // written before has_failed_ is set
  std::atomic<bool> has_failed_{false};
  std::thread thread_;
};

}  // namespace meniscus::tools
