#pragma once

#include "common/program/progress.hpp"
#include "miniapps/options/input/chunk_source.hpp"
#include "miniapps/options/output/output_files.hpp"
#include "miniapps/options/parallel/work_queue.hpp"

namespace drogue::options_app {

/// Work queue of a single rank: reads and writes the files inside its calls. Throws `Failure` (io_error).
class LocalWorkQueue final : public WorkQueue {
 public:
  /// Keeps references to all arguments.
  LocalWorkQueue(ChunkSource& source, OutputFiles& outputs, ProgressLine& progress)
      : _source(source), _outputs(outputs), _progress(progress) {}

  bool next(Chunk& chunk) override;
  void submit(ResultBatch batch) override;
  bool is_closed() override { return false; }

  /// True if all rows are written.
  [[nodiscard]] bool is_complete() const { return _is_complete; }
  [[nodiscard]] const WorkerUsage& usage() const { return _usage; }

 private:
  ChunkSource& _source;
  OutputFiles& _outputs;
  ProgressLine& _progress;
  std::int64_t _rows = 0;  ///< rows of the current chunk so far
  bool _is_complete = false;
  WorkerUsage _usage;
};

}  // namespace drogue::options_app
