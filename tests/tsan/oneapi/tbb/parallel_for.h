// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

/// Stands in for TBB's parallel_for in the build for the thread sanitizer (scripts/sanitize tsan). Debian's libtbb is
/// not built for it, so that the sanitizer cannot see what TBB orders and takes every loop for a race. Here, only
/// starting and joining tasks orders anything: the bodies' races show, and nothing else.
namespace tbb {

/// A thread that runs one task after another. As TBB's, it lives to the end of the program: what is kept by thread is
/// found by the thread's id, and ids of threads that have ended are given again, behind the sanitizer's back.
class Worker {
 public:
  Worker() : thread_([this] { run(); }) {}
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;
  ~Worker() {
    start(nullptr);
    thread_.join();
  }
  /// Nothing to run ends the thread. Precondition: it waits.
  void start(std::function<void()> task) {
    const std::lock_guard lock(mutex_);
    task_ = std::move(task);
    is_busy_ = true;
    changed_.notify_all();
  }
  void wait() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !is_busy_; });
  }

 private:
  void run() {
    std::unique_lock lock(mutex_);
    for (;;) {
      changed_.wait(lock, [this] { return is_busy_; });
      if (!task_) return;
      lock.unlock();
      task_();
      lock.lock();
      is_busy_ = false;
      changed_.notify_all();
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::function<void()> task_;
  bool is_busy_ = false;
  std::thread thread_;  // the last member: it needs the others
};

/// Workers that wait for a task; more are made when none do, for loops within loops.
class Workers {
 public:
  std::unique_ptr<Worker> take() {
    const std::lock_guard lock(mutex_);
    if (waiting_.empty()) return std::make_unique<Worker>();
    std::unique_ptr<Worker> worker = std::move(waiting_.back());
    waiting_.pop_back();
    return worker;
  }
  void give_back(std::unique_ptr<Worker> worker) {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(std::move(worker));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Worker>> waiting_;
};

inline Workers all_workers;

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
  std::vector<std::unique_ptr<Worker>> workers;
  for (Index k = first; k < std::min(last, first + 4); ++k) {
    workers.push_back(all_workers.take());
    workers.back()->start(work);
  }
  for (const auto& worker : workers) worker->wait();
  for (auto& worker : workers) all_workers.give_back(std::move(worker));
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace tbb
