#pragma once

#include "common/program/communicator.hpp"
#include "common/program/failure.hpp"
#include "miniapps/options/command.hpp"

namespace drogue::options_app {

/// Prices one batch: reads it, prices on all ranks, and writes the outputs. The file of `--result` describes
/// the end of the run, however it ended. Collective. Throws `Failure`; returns `ok` or `interrupted`.
ExitCode run_batch(Communicator& communicator, const Command& command);

}  // namespace drogue::options_app
