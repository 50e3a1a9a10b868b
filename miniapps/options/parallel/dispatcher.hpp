#pragma once

#include <deque>
#include <vector>

#include "common/program/progress.hpp"
#include "miniapps/options/input/chunk_source.hpp"
#include "miniapps/options/output/output_files.hpp"
#include "miniapps/options/parallel/work_queue.hpp"

namespace drogue::options_app {

/// Assigns the chunks of a batch to workers and writes the results in the order of the input.
///
/// Memory is bounded: each worker has at most two chunks, and while many results wait to be written only the
/// worker with the next rows is polled.
class Dispatcher {
 public:
  /// `max_pending_bytes`: results that may wait to be written, beside one message of a worker. Keeps
  /// references to the source, the outputs and the progress line.
  Dispatcher(ChunkSource& source, OutputFiles& outputs, ProgressLine& progress,
             std::vector<WorkerProxy*> workers, std::size_t max_pending_bytes = std::size_t{64} << 20);

  /// Blocks until all workers have finished. Returns true if every row is written; false after a signal on
  /// any rank, and if a worker finished early. Throws `Failure` (io_error) after it shut all workers down.
  bool run();

  /// Sum over all workers, after `run`.
  [[nodiscard]] const WorkerUsage& usage() const { return _usage; }

 private:
  /// Chunk that is assigned but not completely written.
  struct OpenChunk {
    std::size_t worker;
    std::deque<ResultBatch> results;
    std::int64_t rows = 0;
    bool is_complete = false;
  };

  bool dispatch();
  bool assign_chunks();
  bool receive_results();
  void accept(std::size_t worker, ResultBatch batch);
  void write_in_order();
  void note_finished(std::size_t worker, const ResultBatch& batch);
  void shut_down_workers();

  ChunkSource& _source;
  OutputFiles& _outputs;
  ProgressLine& _progress;
  std::vector<WorkerProxy*> _workers;
  std::size_t _max_pending_bytes;
  std::vector<int> _assigned;      ///< unfinished chunks of each worker
  std::vector<bool> _is_finished;  ///< by worker
  std::size_t _finished_workers = 0;
  std::deque<OpenChunk> _open;    ///< in the order of the input
  std::int64_t _first_chunk = 0;  ///< number of the first open chunk
  std::size_t _pending_bytes = 0;
  bool _input_exhausted = false;
  WorkerUsage _usage;
};

}  // namespace drogue::options_app
