#pragma once

#include <optional>

#include "miniapps/options/input/chunk.hpp"
#include "miniapps/options/output/result_batch.hpp"

namespace drogue::options_app {

/// Source of the chunks of one worker and destination of its results.
class WorkQueue {
 public:
  virtual ~WorkQueue() = default;

  /// Blocks until a chunk is available. Returns false if the worker shall price no further chunk.
  virtual bool next(Chunk& chunk) = 0;

  /// Submits the next results of the chunk that `next` returned last. May block until there is room.
  virtual void submit(ResultBatch batch) = 0;

  /// True if the rest of the current chunk need not be priced. Does not block.
  [[nodiscard]] virtual bool is_closed() = 0;
};

/// Dispatcher's side of a worker. No function blocks.
class WorkerProxy {
 public:
  virtual ~WorkerProxy() = default;

  /// Appends a chunk to the worker's queue.
  virtual void assign(Chunk chunk) = 0;

  /// Next results of the worker, if any have arrived.
  virtual std::optional<ResultBatch> receive() = 0;

  /// Requests that the worker stops at once, within a chunk too. Its last results have `worker_finished`.
  virtual void shutdown() = 0;
};

}  // namespace drogue::options_app
