#include "miniapps/options/parallel/rank_pricing.hpp"

#include <exception>
#include <thread>

#include "miniapps/options/parallel/dispatcher.hpp"
#include "miniapps/options/parallel/local_work_queue.hpp"
#include "miniapps/options/parallel/rank_work_queue.hpp"
#include "miniapps/options/parallel/thread_work_queue.hpp"

namespace drogue::options_app {
namespace {

PricingResult price_on_one_rank(const Command& command, ChunkSource& source, OutputFiles& outputs,
                                ChunkPricer& pricer) {
  ProgressLine progress(command.quiet);
  LocalWorkQueue queue(source, outputs, progress);
  pricer.run(queue);
  return {queue.is_complete(), queue.usage()};
}

}  // namespace

PricingResult price_on_all_ranks(Communicator& communicator, const Command& command, BatchReader& reader,
                                 OutputFiles& outputs, ChunkPricer& pricer) {
  ChunkSource source(command, reader, communicator.size());
  if (communicator.size() == 1) return price_on_one_rank(command, source, outputs, pricer);
  ThreadWorkQueue own;
  std::vector<RankWorkerProxy> others;
  for (int rank = 1; rank < communicator.size(); ++rank) others.emplace_back(communicator, rank);
  std::vector<WorkerProxy*> workers = {&own};
  for (RankWorkerProxy& other : others) workers.push_back(&other);
  ProgressLine progress(command.quiet);
  Dispatcher dispatcher(source, outputs, progress, std::move(workers));
  // The thread that started Kokkos prices, as on every rank. A second thread does all reading, writing and
  // communication.
  bool is_complete = false;
  std::exception_ptr failure;
  {
    const std::jthread dispatching([&] {
      try {
        is_complete = dispatcher.run();
      } catch (...) {
        failure = std::current_exception();
      }
    });
    pricer.run(own);
  }
  if (failure) std::rethrow_exception(failure);
  return {is_complete, dispatcher.usage()};
}

void run_worker(Communicator& communicator, ChunkPricer& pricer) {
  RankWorkQueue queue(communicator);
  pricer.run(queue);
}

}  // namespace drogue::options_app
