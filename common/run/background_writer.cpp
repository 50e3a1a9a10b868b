#include "common/run/background_writer.hpp"

#include <utility>

namespace drogue::run {

BackgroundWriter::BackgroundWriter(std::size_t depth) : _depth(depth), _thread([this] { work(); }) {}

BackgroundWriter::~BackgroundWriter() {
  {
    const std::lock_guard lock(_mutex);
    _stop = true;
  }
  _changed.notify_all();
  _thread.join();
}

void BackgroundWriter::submit(std::function<void()> task) {
  std::unique_lock lock(_mutex);
  wait_for_slot(lock);
  _queue.push_back(std::move(task));
  _changed.notify_all();
}

void BackgroundWriter::wait_for_slot() {
  std::unique_lock lock(_mutex);
  wait_for_slot(lock);
}

void BackgroundWriter::wait_for_slot(std::unique_lock<std::mutex>& lock) {
  _changed.wait(lock, [this] { return _error || _queue.size() + (_busy ? 1 : 0) < _depth; });
  rethrow();
}

void BackgroundWriter::finish() {
  std::unique_lock lock(_mutex);
  _changed.wait(lock, [this] { return _queue.empty() && !_busy; });
  rethrow();
}

void BackgroundWriter::rethrow() {
  if (_error) std::rethrow_exception(std::exchange(_error, nullptr));
}

void BackgroundWriter::work() {
  std::unique_lock lock(_mutex);
  while (true) {
    _changed.wait(lock, [this] { return _stop || !_queue.empty(); });
    if (_queue.empty()) return;
    const std::function<void()> task = std::move(_queue.front());
    _queue.pop_front();
    _busy = true;
    lock.unlock();
    std::exception_ptr error;
    try {
      task();
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    _busy = false;
    if (error) {
      _error = error;
      _queue.clear();
    }
    _changed.notify_all();
  }
}

}  // namespace drogue::run
