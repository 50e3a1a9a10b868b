#pragma once

#include "common/program/communicator.hpp"
#include "miniapps/options/chunk_pricer.hpp"
#include "miniapps/options/input/chunk_source.hpp"
#include "miniapps/options/output/output_files.hpp"

namespace drogue::options_app {

/// End of the pricing of a batch, on rank 0.
struct PricingResult {
  bool is_complete = false;  ///< false: a signal or the failure of another rank ended it
  WorkerUsage usage;         ///< sum over all ranks
};

/// Prices a batch on all ranks; runs on rank 0 while the others call `run_worker`. Blocks until all ranks
/// have finished. The outputs are written, but not committed. Throws `Failure`.
PricingResult price_on_all_ranks(Communicator& communicator, const Command& command, BatchReader& reader,
                                 OutputFiles& outputs, ChunkPricer& pricer);

/// Prices the chunks that rank 0 assigns to this rank. Blocks until rank 0 shuts the worker down.
void run_worker(Communicator& communicator, ChunkPricer& pricer);

}  // namespace drogue::options_app
