#pragma once

#include "common/program/communicator.hpp"
#include "miniapps/options/batch_run.hpp"
#include "miniapps/options/chunk_source.hpp"
#include "miniapps/options/outputs.hpp"

namespace drogue::options_app {

/// What became of a batch on the rank that reads and writes.
struct Distribution {
  bool is_complete = false;  ///< else a signal ended it, or another rank gave up
  Spent spent;               ///< by all ranks together
};

/// Prices a batch on the ranks, of which this is the first. The outputs are written, but not committed.
Distribution distribute(Communicator& ranks, const Command& command, BatchReader& reader, Outputs& outputs,
                        BatchRun& run);

/// Prices what the first rank hands out.
void assist(Communicator& ranks, BatchRun& run);

}  // namespace drogue::options_app
