#include "miniapps/options/parallel/dispatcher.hpp"

#include <utility>

#include "common/program/communicator.hpp"
#include "common/program/signals.hpp"

namespace drogue::options_app {
namespace {

constexpr int chunks_per_worker = 2;  // one in progress and one waiting

std::size_t bytes_of(const ResultBatch& batch) { return batch.prices.size() + batch.boundaries.size(); }

}  // namespace

Dispatcher::Dispatcher(ChunkSource& source, OutputFiles& outputs, ProgressLine& progress,
                       std::vector<WorkerProxy*> workers, std::size_t max_pending_bytes)
    : _source(source),
      _outputs(outputs),
      _progress(progress),
      _workers(std::move(workers)),
      _max_pending_bytes(max_pending_bytes),
      _assigned(_workers.size(), 0),
      _is_finished(_workers.size(), false) {}

bool Dispatcher::run() {
  try {
    const bool is_complete = dispatch();
    // Before the wait for the workers: a launcher that ends all ranks may not wait that long.
    if (!is_complete) _outputs.discard();
    shut_down_workers();
    return is_complete;
  } catch (...) {
    shut_down_workers();
    throw;
  }
}

bool Dispatcher::dispatch() {
  Backoff pause;
  while (!interrupted() && _finished_workers == 0) {
    const bool assigned = assign_chunks();
    const bool received = receive_results();
    if (_input_exhausted && _open.empty()) return true;
    if (assigned || received) {
      pause.reset();
    } else {
      pause.wait();
    }
  }
  return false;
}

bool Dispatcher::assign_chunks() {
  bool assigned = false;
  for (std::size_t i = 0; i < _workers.size(); ++i) {
    if (_input_exhausted || _assigned[i] == chunks_per_worker) continue;
    Chunk chunk;
    if (!_source.next(chunk)) {
      _input_exhausted = true;
      return assigned;
    }
    _workers[i]->assign(std::move(chunk));
    ++_assigned[i];
    _open.push_back({i, {}});
    assigned = true;
  }
  return assigned;
}

bool Dispatcher::receive_results() {
  bool received = false;
  for (std::size_t i = 0; i < _workers.size(); ++i) {
    const bool has_next_rows = !_open.empty() && _open.front().worker == i;
    if (!has_next_rows && _pending_bytes > _max_pending_bytes) continue;
    if (std::optional<ResultBatch> batch = _workers[i]->receive()) {
      accept(i, *std::move(batch));
      received = true;
    }
  }
  return received;
}

void Dispatcher::accept(std::size_t worker, ResultBatch batch) {
  if (batch.worker_finished) return note_finished(worker, batch);
  OpenChunk& open = _open[static_cast<std::size_t>(batch.chunk - _first_chunk)];
  open.rows += batch.counts.rows;
  open.is_complete = batch.ends_chunk;
  if (batch.ends_chunk) {
    --_assigned[worker];
    _source.adapt(open.rows, batch.chunk_seconds);
  }
  _pending_bytes += bytes_of(batch);
  open.results.push_back(std::move(batch));
  write_in_order();
}

/// Writes all results that follow the last written row without a gap.
void Dispatcher::write_in_order() {
  while (!_open.empty()) {
    OpenChunk& open = _open.front();
    for (; !open.results.empty(); open.results.pop_front()) {
      _outputs.write(open.results.front());
      _pending_bytes -= bytes_of(open.results.front());
    }
    if (!open.is_complete) break;
    _open.pop_front();
    ++_first_chunk;
  }
  _progress.update_rows(_outputs.counts().rows, _source.share(_outputs.counts()));
}

void Dispatcher::note_finished(std::size_t worker, const ResultBatch& batch) {
  _is_finished[worker] = true;
  ++_finished_workers;
  _usage.add(batch.usage);
}

/// Requests that all workers stop, and blocks until they have. Drops results that are not written.
void Dispatcher::shut_down_workers() {
  for (WorkerProxy* worker : _workers) worker->shutdown();
  Backoff pause;
  while (_finished_workers < _workers.size()) {
    for (std::size_t i = 0; i < _workers.size(); ++i) {
      const std::optional<ResultBatch> batch = _is_finished[i] ? std::nullopt : _workers[i]->receive();
      if (batch && batch->worker_finished) note_finished(i, *batch);
    }
    pause.wait();
  }
}

}  // namespace drogue::options_app
