// SPDX-License-Identifier: GPL-3.0-or-later
#include "writing_thread.h"

#include <utility>

namespace meniscus::tools {

WritingThread::WritingThread() {
  tasks_.set_capacity(most_waiting);
  thread_ = std::thread([this] { run_tasks(); });
}

void WritingThread::run_tasks() {
  std::function<void()> task;
  for (tasks_.pop(task); task; tasks_.pop(task)) {
    if (has_failed_) continue;
    try {
      task();
    } catch (...) {
      error_ = std::current_exception();
      has_failed_ = true;
    }
  }
}

void WritingThread::rethrow() {
  if (has_failed_ && error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

void WritingThread::run(std::function<void()> task) {
  rethrow();
  tasks_.push(std::move(task));
}

void WritingThread::finish() {
  stop();
  rethrow();
}

void WritingThread::stop() noexcept {
  if (!thread_.joinable()) return;
  tasks_.push({});
  thread_.join();
}

}  // namespace meniscus::tools
