#include "miniapps/options/parallel/thread_work_queue.hpp"

#include <utility>

namespace drogue::options_app {
namespace {

constexpr std::size_t max_waiting_results = 4;

}  // namespace

bool ThreadWorkQueue::next(Chunk& chunk) {
  std::unique_lock lock(_mutex);
  _changed.wait(lock, [this] { return _is_closed || !_chunks.empty(); });
  if (_is_closed) return false;
  chunk = std::move(_chunks.front());
  _chunks.pop_front();
  return true;
}

void ThreadWorkQueue::submit(ResultBatch batch) {
  std::unique_lock lock(_mutex);
  _changed.wait(lock,
                [&] { return _is_closed || batch.worker_finished || _results.size() < max_waiting_results; });
  _results.push_back(std::move(batch));
}

bool ThreadWorkQueue::is_closed() {
  const std::lock_guard lock(_mutex);
  return _is_closed;
}

void ThreadWorkQueue::assign(Chunk chunk) {
  const std::lock_guard lock(_mutex);
  _chunks.push_back(std::move(chunk));
  _changed.notify_all();
}

std::optional<ResultBatch> ThreadWorkQueue::receive() {
  const std::lock_guard lock(_mutex);
  if (_results.empty()) return std::nullopt;
  std::optional<ResultBatch> batch(std::move(_results.front()));
  _results.pop_front();
  _changed.notify_all();
  return batch;
}

void ThreadWorkQueue::shutdown() {
  const std::lock_guard lock(_mutex);
  _is_closed = true;
  _changed.notify_all();
}

}  // namespace drogue::options_app
