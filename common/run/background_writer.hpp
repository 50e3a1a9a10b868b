#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace drogue::run {

/// One thread that writes while the simulation takes further steps. Tasks run in the order of submission.
class BackgroundWriter {
 public:
  /// `depth` is the largest number of tasks that wait or run, one per output buffer.
  explicit BackgroundWriter(std::size_t depth = 2);

  /// Finishes all submitted tasks. An exception that was not rethrown before is lost.
  ~BackgroundWriter();
  BackgroundWriter(const BackgroundWriter&) = delete;
  BackgroundWriter& operator=(const BackgroundWriter&) = delete;

  /// Queues `task`. Blocks while `depth` tasks wait or run. Rethrows the exception of an earlier task; the
  /// tasks behind that one are dropped, and the writer is usable again.
  void submit(std::function<void()> task);

  /// Blocks until another task can be submitted without waiting. Rethrows the exception of an earlier task.
  void wait_for_slot();

  /// Blocks until all tasks are done. Rethrows the exception of a task.
  void finish();

 private:
  void work();
  void wait_for_slot(std::unique_lock<std::mutex>& lock);
  void rethrow();

  std::size_t _depth;
  std::mutex _mutex;
  std::condition_variable _changed;
  std::deque<std::function<void()>> _queue;
  bool _busy = false;
  bool _stop = false;
  std::exception_ptr _error;
  std::thread _thread;
};

}  // namespace drogue::run
