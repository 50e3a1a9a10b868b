#include "miniapps/options/parallel/local_work_queue.hpp"

#include <utility>

namespace drogue::options_app {

bool LocalWorkQueue::next(Chunk& chunk) {
  _is_complete = !_source.next(chunk);
  return !_is_complete;
}

void LocalWorkQueue::submit(ResultBatch batch) {
  if (batch.worker_finished) {
    _usage = batch.usage;
    return;
  }
  _outputs.write(batch);
  _rows += batch.counts.rows;
  if (batch.ends_chunk) _source.adapt(std::exchange(_rows, 0), batch.chunk_seconds);
  _progress.update_rows(_outputs.counts().rows, _source.share(_outputs.counts()));
}

}  // namespace drogue::options_app
