#include "miniapps/options/parallel/rank_work_queue.hpp"

#include "common/program/signals.hpp"

namespace drogue::options_app {
namespace {

enum Tag { chunk_tag = 1, shutdown_tag, result_tag };

constexpr int root = 0;

}  // namespace

bool RankWorkQueue::next(Chunk& chunk) {
  Backoff pause;
  while (!interrupted() && !is_closed()) {
    if (const auto message = _communicator.receive(root, chunk_tag)) {
      chunk = chunk_from(*message);
      return true;
    }
    pause.wait();
  }
  return false;
}

void RankWorkQueue::submit(ResultBatch batch) {
  _communicator.send(root, result_tag, to_message(batch));
  _communicator.wait_until_sent();
  if (batch.worker_finished) await_shutdown();
}

/// Receives and drops the chunks that rank 0 sends before it receives the end of this worker: MPI waits
/// forever for a message that is not received.
void RankWorkQueue::await_shutdown() {
  Backoff pause;
  bool is_shut_down = false;
  for (;;) {
    is_shut_down = is_shut_down || _communicator.receive(root, shutdown_tag);
    const bool received = _communicator.receive(root, chunk_tag).has_value();
    if (is_shut_down && !received && !_communicator.has_message(root, chunk_tag)) return;
    pause.wait();
  }
}

bool RankWorkQueue::is_closed() { return _communicator.has_message(root, shutdown_tag); }

void RankWorkerProxy::assign(Chunk chunk) { _communicator.send(_rank, chunk_tag, to_message(chunk)); }

std::optional<ResultBatch> RankWorkerProxy::receive() {
  const auto message = _communicator.receive(_rank, result_tag);
  if (!message) return std::nullopt;
  return result_batch_from(*message);
}

void RankWorkerProxy::shutdown() { _communicator.send(_rank, shutdown_tag, ""); }

}  // namespace drogue::options_app
