#pragma once

#include "common/program/communicator.hpp"
#include "miniapps/options/parallel/work_queue.hpp"

namespace drogue::options_app {

/// Work queue of a rank other than rank 0: exchanges messages with rank 0.
class RankWorkQueue final : public WorkQueue {
 public:
  explicit RankWorkQueue(Communicator& communicator) : _communicator(communicator) {}

  bool next(Chunk& chunk) override;
  void submit(ResultBatch batch) override;
  bool is_closed() override;

 private:
  void await_shutdown();

  Communicator& _communicator;
};

/// Rank 0's side of the worker on another rank.
class RankWorkerProxy final : public WorkerProxy {
 public:
  RankWorkerProxy(Communicator& communicator, int rank) : _communicator(communicator), _rank(rank) {}

  void assign(Chunk chunk) override;
  std::optional<ResultBatch> receive() override;
  void shutdown() override;

 private:
  Communicator& _communicator;
  int _rank;
};

}  // namespace drogue::options_app
