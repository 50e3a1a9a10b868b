#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace drogue::run {

/// One thread that writes while the steps go on. Tasks run in the order submitted.
class BackgroundWriter {
 public:
  /// At most `depth` tasks wait or run: one per output buffer.
  explicit BackgroundWriter(std::size_t depth = 2);

  /// Finishes what was submitted; an exception nobody asked for by then is lost.
  ~BackgroundWriter();
  BackgroundWriter(const BackgroundWriter&) = delete;
  BackgroundWriter& operator=(const BackgroundWriter&) = delete;

  /// Queues `task`, waiting if `depth` are under way. Throws what an earlier task threw; after that the tasks
  /// which were waiting behind it are dropped and the writer is usable again.
  void submit(std::function<void()> task);

  /// Waits until all is written. Throws what a task threw.
  void finish();

 private:
  void work();
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
