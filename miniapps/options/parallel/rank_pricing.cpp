#include "miniapps/options/distribution.hpp"

#include <exception>
#include <thread>

#include "miniapps/options/desks.hpp"
#include "miniapps/options/dispatcher.hpp"

namespace drogue::options_app {
namespace {

Distribution price_alone(const Command& command, ChunkSource& source, Outputs& outputs, BatchRun& run) {
  ProgressLine progress(command.quiet);
  OwnDesk desk(source, outputs, progress);
  run.work(desk);
  return {desk.is_complete(), desk.spent()};
}

}  // namespace

Distribution distribute(Communicator& ranks, const Command& command, BatchReader& reader, Outputs& outputs,
                        BatchRun& run) {
  ChunkSource source(command, reader, ranks.size());
  if (ranks.size() == 1) return price_alone(command, source, outputs, run);
  SharedDesk own;
  std::vector<RankHelper> others;
  for (int rank = 1; rank < ranks.size(); ++rank) others.emplace_back(ranks, rank);
  std::vector<Helper*> helpers = {&own};
  for (RankHelper& other : others) helpers.push_back(&other);
  ProgressLine progress(command.quiet);
  Dispatcher dispatcher(source, outputs, progress, std::move(helpers));
  // This rank prices as the others do, by the thread that started Kokkos; another one reads, writes and
  // talks.
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
    run.work(own);
  }
  if (failure) std::rethrow_exception(failure);
  return {is_complete, dispatcher.spent()};
}

void assist(Communicator& ranks, BatchRun& run) {
  RankDesk desk(ranks);
  run.work(desk);
}

}  // namespace drogue::options_app
