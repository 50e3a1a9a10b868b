#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>

#include "miniapps/options/parallel/work_queue.hpp"

namespace drogue::options_app {

/// Both sides of a work queue between two threads of one rank. Does not throw.
class ThreadWorkQueue final : public WorkQueue, public WorkerProxy {
 public:
  bool next(Chunk& chunk) override;
  void submit(ResultBatch batch) override;
  bool is_closed() override;

  void assign(Chunk chunk) override;
  std::optional<ResultBatch> receive() override;
  void shutdown() override;

 private:
  std::mutex _mutex;
  std::condition_variable _changed;
  std::deque<Chunk> _chunks;
  std::deque<ResultBatch> _results;
  bool _is_closed = false;
};

}  // namespace drogue::options_app
