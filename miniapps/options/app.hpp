#pragma once

#include "common/program/failure.hpp"
#include "miniapps/options/command.hpp"

namespace drogue::options_app {

/// Does what the command line requests. Throws `Failure`, also for invalid or failed rows, after all other
/// rows are priced and written; returns the exit code otherwise, also of an interrupted run.
ExitCode run_command(const Command& command);

}  // namespace drogue::options_app
